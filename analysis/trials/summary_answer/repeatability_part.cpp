#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "core/text/text.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using iso230::AxisRepeatability;
using iso230::DeviationSource;
using iso230::PointRepeatability;
using iso230::RepeatabilityField;
using iso230::SequenceShape;
using iso230::TargetRepeatability;
using iso230::ValueStatistics;
using Point = const DescribedPoint&;

const PointRepeatability& repeatability_of(Point p) {
  return p.summary.repeatability->points[p.index()];
}

/// Repeatability values (ISO 230-2) of a design point, and of one of its targets, from one source of
/// positions: an encoder's readings or the true position.
struct SourceValues {
  const DescribedPoint& point;
  std::size_t source;
  std::size_t target{0};

  const DeviationSource& from() const { return (*point.summary.repeatability->sources)[source]; }
  /// The mass (motor or load) to which the positions belong. Empty on an axis with one mass, and if trials of
  /// the point differ in it.
  std::optional<motion::EncoderPlace> mass() const {
    return from().other ? from().other : repeatability_of(point).closing;
  }
  const iso230::SourceRepeatability& values() const { return repeatability_of(point).sources[source]; }
  const statistics::Moments& position() const { return repeatability_of(point).positions[target]; }
};
using Source = const SourceValues&;
using SourceDescription = document::Description<SourceValues>;

std::span<const ValueStatistics> of_axis(Source s) {
  return s.values().axis;
}
std::span<const ValueStatistics> of_target(Source s) {
  return s.values().targets[s.target];
}

/// Adds an output object for each repeatability value, with the statistics of the value over the trials.
template <class Values>
void add_values(SourceDescription& description, std::span<const RepeatabilityField<Values>> fields,
                bool of_targets, std::span<const ValueStatistics> (*statistics)(Source)) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    SourceDescription value;
    for (const iso230::ValueStatisticField& statistic : iso230::value_statistic_fields()) {
      if (of_targets && !statistic.of_targets) continue;
      value.value(document::in_data(std::string(statistic.name),
                                    fmt::format("{} {}", statistic.long_name, fields[i].long_name)),
                  [i, number = statistic.value, statistics](Source s) { return number(statistics(s)[i]); });
    }
    description.object({.key = std::string(fields[i].name), .meaning = std::string(fields[i].long_name)},
                       value, std::identity());
  }
}

std::vector<SourceValues> targets_of(Source s) {
  std::vector<SourceValues> targets;
  for (std::size_t target = 0; target < s.values().targets.size(); ++target)
    targets.push_back({s.point, s.source, target});
  return targets;
}

std::optional<std::string> mass_of(Source s) {
  if (!s.mass()) return std::nullopt;
  return std::string(study::mass_text(*s.mass()));
}

SourceDescription source_object(parameters::AxisKind axis) {
  SourceDescription values, target, source;
  add_values(values, iso230::axis_fields(), false, of_axis);
  target.value(document::in_data("target", "number of the target"), &SourceValues::target)
      .value(document::in_data("position_min", "smallest position in a trial", "count"),
             [](Source s) { return s.position().min; })
      .value(document::in_data("position_max", "largest position in a trial", "count"),
             [](Source s) { return s.position().max; });
  add_values(target, iso230::target_fields(), true, of_target);
  return source
      .value(document::in_data("unit", "of all values"),
             [axis](Source s) { return parameters::unit_on(axis, s.from().unit); })
      .value(document::in_data("of", "mass whose positions these are; null on an axis with one mass"),
             mass_of)
      .object({.key = "axis", .meaning = "values of the axis"}, values, std::identity())
      .table({.key = "targets", .meaning = "values of the targets"}, target, targets_of);
}

PointDescription repeatability_object(const iso230::RepeatabilitySummary& summary) {
  const parameters::AxisKind axis = summary.axis;
  PointDescription object;
  measures::add_fields(object, iso230::point_repeatability_fields(), axis, repeatability_of);
  for (std::size_t source = 0; source < summary.sources->size(); ++source) {
    const DeviationSource& from = (*summary.sources)[source];
    object.object({.key = from.name, .meaning = from.long_name}, source_object(axis), [source](Point p) {
      return SourceValues{p, source};
    });
  }
  return object;
}

void add_csv_columns(PointDescription& point, const iso230::RepeatabilitySummary& summary) {
  const auto axis = iso230::point_axis_table(*summary.sources);
  const auto targets = iso230::point_target_table(*summary.sources);
  // @param source with a slash; empty for the columns that are of none
  const auto add = [&](const std::string& prefix, const auto& table, const std::string& source,
                       std::size_t target) {
    for (std::size_t i = 0; i < table.values.size(); ++i) {
      const layout::Column& column = table.table.columns[i];
      const std::size_t name = column.name.find('/') + 1;  // 0 without a slash
      if (column.name.substr(0, name) != source) continue;
      point.value({.key = prefix + column.name.substr(name),
                   .meaning = parameters::text_on(summary.axis, column.long_name),
                   .unit = parameters::unit_on(summary.axis, column.unit),
                   .shown = Visibility::in_csv},
                  [value = table.values[i], target](Point p) { return value(repeatability_of(p), target); });
    }
  };
  add("repeatability_", axis, "", 0);
  for (const DeviationSource& source : *summary.sources) {
    const std::string path = fmt::format("{}/", source.name);
    const std::string prefix = fmt::format("repeatability_{}_", source.name);
    add(prefix, axis, path, 0);
    for (std::size_t target = 0; target < static_cast<std::size_t>(summary.shape.targets); ++target)
      add(fmt::format("{}target_{}_", prefix, target), targets, path, target);
  }
}

/// The unit in which people see positions, as is usual in the trade: seconds of arc for a rotary axis, µm for
/// a linear one.
std::string shown_unit(const DeviationSource& source, parameters::AxisKind axis) {
  return source.unit == "rad" ? parameters::unit_on(axis, "arcsec") : source.unit;
}
double in_shown_unit(const DeviationSource& source, parameters::AxisKind axis, double value) {
  if (source.unit != "rad") return value;
  constexpr double arcsec = std::numbers::pi / (180.0 * 3600.0);  // rad
  constexpr double micrometre = 1e-6;                             // m
  return value / (axis == parameters::AxisKind::linear ? micrometre : arcsec);
}

/// The value as text with three significant digits; larger values as whole numbers.
std::string three_digits(double value) {
  return std::abs(value) < 999.5 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

std::string median_and_p95(const DeviationSource& source, parameters::AxisKind axis,
                           const ValueStatistics& value) {
  if (value.n == 0) return "–";
  return fmt::format("{} ({})", three_digits(in_shown_unit(source, axis, value.median.value)),
                     three_digits(in_shown_unit(source, axis, value.p95.value)));
}

/// Whether the true position of a mass repeats another source of positions at the point, because the encoder
/// on this mass closes the loop or the axis has only one mass.
bool is_repeated(const SourceValues& reading) {
  const std::optional<motion::EncoderPlace> other = reading.from().other;
  const PointRepeatability& point = repeatability_of(reading.point);
  return other && (!point.has_load || point.closing == other);
}

/// Table rows of repeatability values: all design points and sources of positions, for each of the first
/// `targets` targets.
/// @param targets 1 for tables that do not distinguish targets
std::vector<SourceValues> rows_of(const SummaryResults& s, std::size_t targets) {
  std::vector<SourceValues> rows;
  for (const DescribedPoint& point : s.points) {
    for (std::size_t target = 0; target < targets; ++target) {
      for (std::size_t source = 0; source < s.summary.repeatability->sources->size(); ++source)
        if (!is_repeated({point, source, target})) rows.push_back({point, source, target});
    }
  }
  return rows;
}

void add_label(SourceDescription& columns, const summary::StudySummary& summary) {
  columns.value({.heading = "point"}, [label = short_label(summary)](Source s) { return label(s.point); });
}

void add_source(SourceDescription& columns, parameters::AxisKind axis) {
  columns.value({.heading = "from"}, [axis](Source s) {
    const std::string name = s.from().other ? "true" : s.from().name;
    const std::optional<std::string> mass = mass_of(s);
    return fmt::format("{}{} ({})", name, mass ? ", " + *mass : "", shown_unit(s.from(), axis));
  });
}

/// The most informative repeatability values, which depend on the approach directions of the test sequence:
/// both, positive only, or negative only.
template <typename Values>
struct ShownValues {
  std::vector<double Values::*> of_both, of_positive, of_negative;

  bool contains(double Values::*value, const SequenceShape& shape) const {
    const bool both = shape.positive && shape.negative;
    const auto& shown = both ? of_both : shape.positive ? of_positive : of_negative;
    return std::find(shown.begin(), shown.end(), value) != shown.end();
  }
};

/// Adds a column for each shown value, with the median and 95 % quantile of the value over the trials.
template <typename Values>
void add_columns(SourceDescription& columns, std::span<const RepeatabilityField<Values>> fields,
                 const ShownValues<Values>& shown, const iso230::RepeatabilitySummary& summary,
                 std::span<const ValueStatistics> (*statistics)(Source)) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!shown.contains(fields[i].value, summary.shape)) continue;
    columns.value({.heading = std::string(fields[i].symbol), .numeric = true},
                  [i, axis = summary.axis, statistics](Source s) {
                    return median_and_p95(s.from(), axis, statistics(s)[i]);
                  });
  }
}

/// The proportion of trials that repeat exactly (zero deviation), with bounds. Only for readings of the
/// encoder; otherwise empty.
std::optional<document::Bounded> zero_proportion(Source s) {
  const PointRepeatability& point = repeatability_of(s.point);
  if (s.from().unit != "count" || !point.zero_repeatability) return std::nullopt;
  return document::Bounded{point.zero_rate, point.zero_bounds.low, point.zero_bounds.high};
}

SourceDescription columns_of_axis(const summary::StudySummary& summary) {
  using A = AxisRepeatability;
  static const ShownValues<A> shown{
      {&A::reversal, &A::repeatability_positive, &A::repeatability_negative, &A::repeatability,
       &A::systematic, &A::mean_bidirectional, &A::accuracy},
      {&A::repeatability_positive, &A::systematic_positive, &A::accuracy_positive},
      {&A::repeatability_negative, &A::systematic_negative, &A::accuracy_negative}};
  SourceDescription columns;
  add_label(columns, summary);
  add_source(columns, summary.repeatability->axis);
  columns.value({.heading = "trials"}, [](Source s) { return repeatability_of(s.point).evaluated; });
  add_columns(columns, iso230::axis_fields(), shown, *summary.repeatability, of_axis);
  return columns.value({.heading = fmt::format("zero [{}]", bounds_head(summary)),
                        .unit = "1",
                        .notation = document::Notation::percent},
                       zero_proportion);
}

std::string position_text(const statistics::Moments& position) {
  if (position.min == position.max) return fmt::format("{:.0f}", position.min);
  return fmt::format("{:.0f} to {:.0f}", position.min, position.max);
}

SourceDescription columns_of_targets(const summary::StudySummary& summary) {
  using T = TargetRepeatability;
  static const ShownValues<T> shown{
      {&T::mean_positive, &T::mean_negative, &T::reversal, &T::repeatability_positive,
       &T::repeatability_negative, &T::repeatability},
      {&T::mean_positive, &T::repeatability_positive},
      {&T::mean_negative, &T::repeatability_negative}};
  SourceDescription columns;
  add_label(columns, summary);
  columns.value({.heading = "target", .numeric = true}, [](Source s) { return position_text(s.position()); });
  add_source(columns, summary.repeatability->axis);
  add_columns(columns, iso230::target_fields(), shown, *summary.repeatability, of_target);
  return columns;
}

std::string title_of_repeatability(const SequenceShape& shape) {
  const std::string_view from = shape.positive && shape.negative ? "both sides"
                                : shape.positive                 ? "below"
                                                                 : "above";
  return fmt::format("repeatability after ISO 230-2: {} approached from {} in {}",
                     text::counted(shape.targets, "target"), from, text::counted(shape.cycles, "cycle"));
}

/// Text with a line for each design point at which all trials repeat exactly, with the bound of the failure
/// proportion that this demonstrates.
std::string exact_points(const SummaryResults& s) {
  const auto label = short_label(s.summary);
  const double confidence = s.summary.repeatability->confidence;
  std::string lines;
  for (const DescribedPoint& p : s.points) {
    const PointRepeatability& point = repeatability_of(p);
    if (point.zero_repeatability != point.trials) continue;
    lines += fmt::format(
        "{}: all {} trials repeat exactly{}: not 100 %, but at most {} of axes do not, with {:.6g} % "
        "confidence\n",
        label(p), point.trials,
        point.closing ? fmt::format(" by the encoder of the {}", study::mass_text(*point.closing)) : "",
        text::percent_at_most(statistics::proportion_at_most(0, point.trials, confidence)),
        100.0 * confidence);
  }
  return lines;
}

constexpr std::string_view repeatability_legend =
    "median (95 % quantile) over the trials without a nonfinite move; deviations by the true position are "
    "from the middle of the target's count, those by the encoder, the fine one, from the target\n"
    "R: repeatability; B: reversal value; E: systematic deviation; M: mean bidirectional deviation; "
    "A: accuracy; x̄: mean deviation; ↑: approached from below; ↓: from above\n"
    "zero: proportion of all trials whose repeatability by the encoder is exactly 0, the paper's 100 %; "
    "bounds after Clopper and Pearson, in %\n";

}  // namespace

void add_repeatability(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.repeatability) return;
  point.object(in_json("repeatability", "values of ISO 230-2"), repeatability_object(*summary.repeatability),
               std::identity());
  add_csv_columns(point, *summary.repeatability);
}

void add_repeatability(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!summary.repeatability) return;
  answer
      .table(
          {.heading = title_of_repeatability(summary.repeatability->shape), .shown = Visibility::to_people},
          columns_of_axis(summary), [](const SummaryResults& s) { return rows_of(s, 1); })
      .table({.heading = "repeatability at the targets", .shown = Visibility::to_people},
             columns_of_targets(summary),
             [](const SummaryResults& s) {
               return rows_of(s, static_cast<std::size_t>(s.summary.repeatability->shape.targets));
             })
      .sentence([](const SummaryResults& s) { return exact_points(s) + std::string(repeatability_legend); });
}

}  // namespace zerocount::summary_answer
