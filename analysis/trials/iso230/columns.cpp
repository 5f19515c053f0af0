#include "analysis/trials/iso230/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::iso230 {
namespace {

using Trial = const SequenceTrial&;
using Point = const PointRepeatability&;
using TrialTable = RepeatabilityTable<SequenceTrial>;
using PointTable = RepeatabilityTable<PointRepeatability>;

/// Adds a column to a table of trials for every quantity of `fields`, computed from every kind of deviation
/// in `sources`. `values(repeatability, target)` returns the struct that has the quantities.
template <typename Values, typename ValuesOf>
void add_values(TrialTable& table, const DeviationSources& sources,
                std::span<const RepeatabilityField<Values>> fields, ValuesOf values) {
  for (const DeviationSource& source : sources) {
    for (const RepeatabilityField<Values>& field : fields) {
      table.add({fmt::format("{}/{}", source.name, field.name), source.unit,
                 fmt::format("{}, {}", field.long_name, source.long_name)},
                [&source, &field, values](Trial trial, std::size_t target) {
                  if (!trial.values) return statistics::unknown;
                  return values((*trial.values).*source.values, target).*field.value;
                });
    }
  }
}

/// Adds a column to a table of design points for every statistic of every quantity of `fields`, computed from
/// every kind of deviation in `sources`. `values(source, target)` returns the statistics, [field].
template <typename Values, typename ValuesOf>
void add_statistics(PointTable& table, const DeviationSources& sources,
                    std::span<const RepeatabilityField<Values>> fields, bool of_targets, ValuesOf values) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const DeviationSource& source = sources[i];
    for (std::size_t field = 0; field < fields.size(); ++field) {
      for (const ValueStatisticField& statistic : value_statistic_fields()) {
        if (of_targets && !statistic.of_targets) continue;
        table.add({fmt::format("{}/{}_{}", source.name, fields[field].name, statistic.name), source.unit,
                   fmt::format("{} {}, {}", statistic.long_name, fields[field].long_name, source.long_name)},
                  [i, field, &statistic, values](Point point, std::size_t target) {
                    return statistic.value(values(point.sources[i], target)[field]);
                  });
      }
    }
  }
}

layout::Column scale(const char* name, const char* long_name) {
  return {name, "1", long_name, hdf5::Element::int64};
}

layout::Column rows_of_trials() {
  return scale("trial", "global row of the trial");
}
layout::Column rows_of_points() {
  return scale("point", "index of the design point");
}
layout::Column targets_of_list() {
  return scale("target", "index of the target in its list");
}

}  // namespace

ValueStatistics statistics_of(std::vector<double> values, double confidence) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  // Sorted before they are summed: the same mean in whatever order the trials come.
  std::sort(values.begin(), values.end());
  ValueStatistics result;
  result.n = std::ssize(values);
  statistics::Histogram<double> histogram;
  for (const double value : values) histogram.add(value);
  result.median = statistics::quantile(histogram, 0.5, confidence);
  result.p95 = statistics::quantile(histogram, 0.95, confidence);
  if (values.empty()) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  result.max = values.back();
  return result;
}

const std::vector<ValueStatisticField>& value_statistic_fields() {
  using enum layout::Statistic;
  static const std::vector<ValueStatisticField> fields = [] {
    std::vector<ValueStatisticField> all;
    for (const layout::Statistic one : {mean, median, median_low, median_high, p95, p95_low, p95_high, max}) {
      const measures::StatisticKind& kind = measures::statistic_kinds()[static_cast<std::size_t>(one)];
      all.push_back({kind.name, measures::meaning_of(kind) + (one == max ? "" : " of the"),
                     one == median || one == p95, kind.value});
    }
    return all;
  }();
  return fields;
}

const std::vector<text::ReportField<PointRepeatability>>& point_repeatability_fields() {
  using P = const PointRepeatability&;
  static const std::vector<text::ReportField<PointRepeatability>> fields{
      {"", "trials", "1", "trials of the point", true, [](P p) { return text::to_double(p.trials); }},
      {"", "evaluated", "1", "trials without a nonfinite move, of which the values are", true,
       [](P p) { return text::to_double(p.evaluated); }},
      {"", "zero_repeatability", "1",
       "trials whose repeatability by the fine encoder is exactly 0, NaN of a single cycle", true,
       [](P p) {
         return p.zero_repeatability ? text::to_double(*p.zero_repeatability) : statistics::unknown;
       }},
      {"", "zero_repeatability_rate", "1",
       "zero_repeatability as a proportion of trials, NaN of a single cycle", false,
       [](P p) { return p.zero_rate; }},
      {"", "zero_repeatability_rate_low", "1",
       "lower 95 % bound of zero_repeatability_rate: Clopper-Pearson, with machines Korn-Graubard", false,
       [](P p) { return p.zero_bounds.low; }},
      {"", "zero_repeatability_rate_high", "1",
       "upper 95 % bound of zero_repeatability_rate: Clopper-Pearson, with machines Korn-Graubard", false,
       [](P p) { return p.zero_bounds.high; }},
  };
  return fields;
}

TrialTable trial_axis_table(const DeviationSources& sources) {
  TrialTable table{{"repeatability/trial", rows_of_trials(), {}, {}}};
  table.add({"evaluated",
             "1",
             "the trial has no nonfinite move, and so has values",
             hdf5::Element::flag,
             {{0, "no"}, {1, "yes"}}},
            [](Trial trial, std::size_t) { return trial.values ? 1.0 : 0.0; });
  add_values(table, sources, axis_fields(), [](const Repeatability& r, std::size_t) { return r.axis; });
  return table;
}

TrialTable trial_target_table(const DeviationSources& sources) {
  TrialTable table{{"repeatability/trial_target", rows_of_trials(), targets_of_list(), {}}};
  table.add({"position", "count", "the target, from the start of the trial"},
            [](Trial trial, std::size_t target) { return trial.positions[target]; });
  add_values(table, sources, target_fields(),
             [](const Repeatability& r, std::size_t target) { return r.targets[target]; });
  return table;
}

PointTable point_axis_table(const DeviationSources& sources) {
  PointTable table{{"repeatability/point", rows_of_points(), {}, {}}};
  for (const text::ReportField<PointRepeatability>& field : point_repeatability_fields())
    table.add({field.name, field.unit, field.long_name},
              [&field](Point point, std::size_t) { return field.value(point); });
  add_statistics(table, sources, axis_fields(), false,
                 [](const SourceRepeatability& source, std::size_t) { return std::span(source.axis); });
  return table;
}

PointTable point_target_table(const DeviationSources& sources) {
  PointTable table{{"repeatability/point_target", rows_of_points(), targets_of_list(), {}}};
  table.add({"position_min", "count", "smallest position of the target in a trial"},
            [](Point point, std::size_t target) { return point.positions[target].min; });
  table.add({"position_max", "count", "largest position of the target in a trial"},
            [](Point point, std::size_t target) { return point.positions[target].max; });
  add_statistics(table, sources, target_fields(), true,
                 [](const SourceRepeatability& source, std::size_t target) {
                   return std::span(source.targets[target]);
                 });
  return table;
}

const DeviationSources& deviation_sources(const study::StudyFeatures& features) {
  const auto with = [](bool motor_closes, bool load_closes) {
    using enum motion::EncoderPlace;
    const std::string mass(
        study::of_closing_mass({.motor_closes = motor_closes, .load_closes = load_closes}));
    DeviationSources sources{
        {"true", "rad", "from the true position" + mass, &TrialRepeatability::from_position},
        {"encoder", "count", "from the fine encoder" + mass, &TrialRepeatability::from_encoder}};
    if (motor_closes)
      sources.push_back(
          {"load_true", "rad", "from the true position of the load", &TrialRepeatability::of_load, load});
    if (load_closes)
      sources.push_back(
          {"motor_true", "rad", "from the true position of the motor", &TrialRepeatability::of_motor, motor});
    return sources;
  };
  static const std::array<DeviationSources, 4> all{with(false, false), with(true, false), with(false, true),
                                                   with(true, true)};  // tables refer to them
  return all[(features.motor_closes ? 1U : 0U) + (features.load_closes ? 2U : 0U)];
}

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields() {
  using A = AxisRepeatability;
  static constexpr std::array<RepeatabilityField<A>, 12> fields{{
      {"reversal", "B", "reversal value of the axis", &A::reversal},
      {"mean_reversal", "B̄", "mean reversal value of the axis", &A::mean_reversal},
      {"repeatability_positive", "R↑", "repeatability of the axis, positive approach",
       &A::repeatability_positive},
      {"repeatability_negative", "R↓", "repeatability of the axis, negative approach",
       &A::repeatability_negative},
      {"repeatability", "R", "bidirectional repeatability of the axis", &A::repeatability},
      {"systematic_positive", "E↑", "systematic deviation of the axis, positive approach",
       &A::systematic_positive},
      {"systematic_negative", "E↓", "systematic deviation of the axis, negative approach",
       &A::systematic_negative},
      {"systematic", "E", "bidirectional systematic deviation of the axis", &A::systematic},
      {"mean_bidirectional", "M", "range of the mean bidirectional deviations of the axis",
       &A::mean_bidirectional},
      {"accuracy_positive", "A↑", "accuracy of the axis, positive approach", &A::accuracy_positive},
      {"accuracy_negative", "A↓", "accuracy of the axis, negative approach", &A::accuracy_negative},
      {"accuracy", "A", "bidirectional accuracy of the axis", &A::accuracy},
  }};
  return fields;
}

std::span<const RepeatabilityField<TargetRepeatability>> target_fields() {
  using T = TargetRepeatability;
  static constexpr std::array<RepeatabilityField<T>, 9> fields{{
      {"mean_positive", "x̄↑", "mean deviation at the target, positive approach", &T::mean_positive},
      {"mean_negative", "x̄↓", "mean deviation at the target, negative approach", &T::mean_negative},
      {"mean", "x̄", "mean bidirectional deviation at the target", &T::mean},
      {"reversal", "B", "reversal value at the target", &T::reversal},
      {"uncertainty_positive", "s↑", "standard uncertainty at the target, positive approach",
       &T::uncertainty_positive},
      {"uncertainty_negative", "s↓", "standard uncertainty at the target, negative approach",
       &T::uncertainty_negative},
      {"repeatability_positive", "R↑", "repeatability at the target, positive approach",
       &T::repeatability_positive},
      {"repeatability_negative", "R↓", "repeatability at the target, negative approach",
       &T::repeatability_negative},
      {"repeatability", "R", "bidirectional repeatability at the target", &T::repeatability},
  }};
  return fields;
}

}  // namespace zerocount::iso230
