#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::layout {
namespace {

using M = trial::MoveOutcome;
using enum Statistic;

template <double trial::BandOutcome::*Member, std::size_t Band>
double value_of_band(const M& move) {
  return move.bands[Band].*Member;
}

/// Functions, [band], of which each gives the value of this measure in one error band of a move.
template <double trial::BandOutcome::*Member>
constexpr auto values_of_bands() {
  return []<std::size_t... Band>(std::index_sequence<Band...>) {
    return std::array<double (*)(const M&), sizeof...(Band)>{&value_of_band<Member, Band>...};
  }
  (std::make_index_sequence<trial::max_error_bands>());
}

/// Makes the description of a measure of one error band, as a field of the move, from the description of the
/// error band's field.
RecordField<M> field_of_band(const RecordField<trial::BandOutcome>& field, std::int64_t band,
                             double (*value)(const M&)) {
  Column column = field.column;
  column.name = name_of_band(column.name, band);
  column.long_name += fmt::format(" (band of {} count{})", band, band == 1 ? "" : "s");
  return {std::move(column), value, field.valid};
}

template <auto Times, std::size_t Tolerance>
double value_of_tolerance(const M& move) {
  return (move.*Times)[Tolerance];
}

/// Functions, [tolerance], of which each gives the settling time of a move for one tolerance.
template <auto Times>
constexpr auto values_of_tolerances() {
  return []<std::size_t... Tolerance>(std::index_sequence<Tolerance...>) {
    return std::array<double (*)(const M&), sizeof...(Tolerance)>{&value_of_tolerance<Times, Tolerance>...};
  }
  (std::make_index_sequence<trial::max_tolerances>());
}

}  // namespace

std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot) {
  using B = trial::BandOutcome;
  const std::int64_t band = bands.values()[slot];
  const CountedValues times{.needs_target = true, .missing = Missing::late};
  std::vector<Measure> measures;
  measures.push_back(
      {.field = field_of_band(band_fields()[0], band, values_of_bands<&B::entry_time>()[slot]),
       .band = band,
       .values = times,
       .reduction = MoveReduction::largest,
       .point = {
           "entry_time",
           {{{n}, "moves that entered the error band, of which mean, min and max are"},
            {{all}, "moves with a target, of which the quantiles are"},
            {{mean, min, max}, "{0} time of entry into the error band of the moves that entered it"},
            {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
             "{0} of the time of entry into the error band of all moves with a target, NaN if not within the hold"}}}});
  measures.push_back(
      {.field = field_of_band(band_fields()[1], band, values_of_bands<&B::settling_time>()[slot]),
       .band = band,
       .values = times,
       .reduction = MoveReduction::largest,
       .point =
           {"settling_time",
            {{{n}, "moves that ended within the error band, of which mean, min and max are"},
             {{all}, "moves with a target, of which the quantiles are"},
             {{mean, min, max},
              "{0} time until the error is within the band for good, of the moves that ended within it"},
             {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
              "{0} of the time until the error is within the band for good, of all moves with a target, NaN if not within the hold"},
             {{bootstrap_low, bootstrap_high},
              "{1} of the mean settling time: Student and studentised bootstrap"}}},
       .summary = {.columns = {{fmt::format("settled ±{} p95 (s)", band), p95, CellText::settling_time}},
                   .legend =
                       slot > 0
                           ? ""
                           : "settled ±b: the error stays within b counts from then to the end of the move; "
                             "p95 of all moves, those that end outside being later than any time\n"},
       .output = {{name_of_band("band_settling_time", band),
                   "time until the error is within the band for good, the longest of the trial's moves; "
                   "a move that ends outside counts with its duration"}}});
  measures.push_back(
      {.field = field_of_band(band_fields()[2], band, values_of_bands<&B::exits>()[slot]),
       .band = band,
       .values = {.needs_target = true},
       .reduction = MoveReduction::sum,
       .point = {"exits",
                 {{{n}, "trials, of which the numbers of exits are"},
                  {{mean, sd, p95, max}, "{0} of the exits from the error band per trial"},
                  {{total}, "exits from the error band of all trials"},
                  {{bootstrap_low, bootstrap_high},
                   "{1} of the mean number of exits: Student and studentised bootstrap, Garwood for few"}}}});
  return measures;
}

std::vector<Measure> measures_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot) {
  const double tolerance = tolerances.values()[slot];
  const auto measure = [&](const RecordField<ToleranceRecord>& field, std::string_view mass,
                           double (*value)(const M&), bool study::StudyFeatures::*only_with) {
    Column column = field.column;
    const std::string name = name_of_tolerance(column.name, tolerance);
    column.name = name;
    return Measure{
        .field = {std::move(column), value, field.valid},
        .tolerance = tolerance,
        .only_with = only_with,
        .values = {.needs_target = true, .missing = Missing::late},
        .reduction = MoveReduction::largest,
        .point =
            {mass.empty()     ? "settling_time"
             : mass == "load" ? "load_settling_time"
                              : "motor_settling_time",
             {{{n}, "moves that ended within the tolerance, of which mean, min and max are"},
              {{all}, "moves with a target, of which the quantiles are"},
              {{mean, min, max},
               "{0} time until the position error is within the tolerance for good, of the moves that ended within it"},
              {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
               "{0} of the time until the position error is within the tolerance for good, of all moves with a target, NaN if not within the hold"},
              {{bootstrap_low, bootstrap_high},
               "{1} of the mean settling time: Student and studentised bootstrap"}}},
        .summary =
            {.use = only_with,
             .columns = {{fmt::format("{}{}within ±{:g} p95 (s)", mass, mass.empty() ? "" : " ", tolerance),
                          p95, CellText::settling_time}},
             .legend =
                 slot > 0 || !mass.empty()
                     ? ""
                     : "within ±t: the position error stays within the tolerance t from then to the end of the move; p95 of all moves\n"},
        .output = {
            {name,
             "time until the position error is within the tolerance for good, the longest of the trial's moves; "
             "a move that ends outside counts with its duration"}}};
  };
  using F = study::StudyFeatures;
  const auto fields = tolerance_fields({.load_error = true, .motor_error = true});
  const auto of_other = values_of_tolerances<&M::other_tolerance_settling_times>()[slot];
  return {measure(fields[0], "", values_of_tolerances<&M::tolerance_settling_times>()[slot], nullptr),
          measure(fields[1], "load", of_other, &F::load_error),
          measure(fields[2], "motor", of_other, &F::motor_error)};
}

}  // namespace zerocount::layout
