#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_columns.hpp"
#include "analysis/iso230/repeatability_statistics.hpp"
#include "analysis/measures/summary_section.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/tolerance.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::iso230 {
namespace {

/// Positions are shown as the trade states them: in seconds of arc, or µm.
std::string shown_unit(const DeviationSource& source, parameters::AxisKind axis) {
  return source.unit == "rad" ? parameters::unit_on(axis, "arcsec") : std::string(source.unit);
}
double in_shown_unit(const DeviationSource& source, parameters::AxisKind axis, double value) {
  if (source.unit != "rad") return value;
  constexpr double arcsec = std::numbers::pi / (180.0 * 3600.0);  // rad
  constexpr double micrometre = 1e-6;                             // m
  return value / (axis == parameters::AxisKind::linear ? micrometre : arcsec);
}

/// Three digits, or all of a larger whole part.
std::string three_digits(double value) {
  return std::abs(value) < 999.5 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

std::string median_and_p95(const DeviationSource& source, parameters::AxisKind axis,
                           const ValueStatistics& value) {
  if (value.n == 0) return "–";
  return fmt::format("{} ({})", three_digits(in_shown_unit(source, axis, value.median.value)),
                     three_digits(in_shown_unit(source, axis, value.p95.value)));
}

/// A row of the tables: a point, a target (not used in the table of the axis) and a source.
struct RowOfValues {
  std::int64_t index;  ///< of the point
  std::string label;
  const PointRepeatability& point;
  std::size_t target;
  std::size_t source;
  parameters::AxisKind axis;

  const DeviationSource& from() const { return deviation_sources()[source]; }
};

std::vector<RowOfValues> rows_of(const RepeatabilitySummary& summary, const std::vector<std::string>& labels,
                                 std::size_t targets) {
  std::vector<RowOfValues> rows;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    for (std::size_t target = 0; target < targets; ++target) {
      for (std::size_t source = 0; source < deviation_sources().size(); ++source) {
        rows.push_back({static_cast<std::int64_t>(i), text::printable(labels[i]), summary.points[i], target,
                        source, summary.axis});
      }
    }
  }
  return rows;
}

std::vector<std::int64_t> points_of(std::span<const RowOfValues> rows) {
  std::vector<std::int64_t> points;
  for (const RowOfValues& row : rows) points.push_back(row.index);
  return points;
}

template <typename Cell>
text::TextColumn column_of(std::string_view head, bool numeric, std::span<const RowOfValues> rows,
                           const Cell& cell) {
  text::TextColumn column{std::string(head), numeric, {}};
  for (const RowOfValues& row : rows) column.cells.push_back(cell(row));
  return column;
}

text::TextColumn sources_of(std::span<const RowOfValues> rows) {
  return column_of("from", false, rows, [](const RowOfValues& row) {
    return fmt::format("{} ({})", row.from().name, shown_unit(row.from(), row.axis));
  });
}

/// The values that the directions of the sequence define, the most telling ones of them.
template <typename Values>
struct Shown {
  std::vector<double Values::*> of_both, of_positive, of_negative;

  bool contains(double Values::*value, const SequenceShape& shape) const {
    const bool both = shape.positive && shape.negative;
    const auto& shown = both ? of_both : shape.positive ? of_positive : of_negative;
    return std::find(shown.begin(), shown.end(), value) != shown.end();
  }
};

/// A column for each shown value; `statistics(row)` are those of the fields in the row.
template <typename Values, typename Statistics>
void add_values(std::vector<text::TextColumn>& columns, std::span<const RepeatabilityField<Values>> fields,
                const Shown<Values>& shown, const SequenceShape& shape, std::span<const RowOfValues> rows,
                const Statistics& statistics) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!shown.contains(fields[i].value, shape)) continue;
    columns.push_back(column_of(fields[i].symbol, true, rows, [&](const RowOfValues& row) {
      return median_and_p95(row.from(), row.axis, statistics(row)[i]);
    }));
  }
}

std::string zero_share(const RowOfValues& row) {
  if (row.from().unit != "count") return {};
  if (!row.point.zero_repeatability) return "–";
  return text::percentage(*row.point.zero_repeatability, row.point.trials);
}

std::string zero_bounds(const RowOfValues& row) {
  if (row.from().unit != "count") return {};
  if (!row.point.zero_repeatability) return "–";
  const statistics::ConfidenceInterval& bounds = row.point.zero_bounds;
  return fmt::format("[{}]", text::percent_bounds(bounds.low, bounds.high));
}

text::PointTable table_of_axis(const RepeatabilitySummary& summary, const std::vector<std::string>& labels) {
  using A = AxisRepeatability;
  static const Shown<A> shown{{&A::reversal, &A::repeatability_positive, &A::repeatability_negative,
                               &A::repeatability, &A::systematic, &A::mean_bidirectional, &A::accuracy},
                              {&A::repeatability_positive, &A::systematic_positive, &A::accuracy_positive},
                              {&A::repeatability_negative, &A::systematic_negative, &A::accuracy_negative}};
  using Row = const RowOfValues&;
  const std::vector<RowOfValues> rows = rows_of(summary, labels, 1);
  std::vector<text::TextColumn> columns{column_of("point", false, rows, [](Row row) { return row.label; }),
                                        sources_of(rows)};
  columns.push_back(
      column_of("trials", true, rows, [](Row row) { return fmt::format("{}", row.point.evaluated); }));
  add_values(columns, axis_fields(), shown, summary.shape, rows,
             [](Row row) { return std::span(row.point.sources[row.source].axis); });
  columns.push_back(column_of("zero", true, rows, zero_share));
  columns.push_back(column_of(text::percent(summary.confidence) + " bounds", true, rows, zero_bounds));
  return {std::move(columns), points_of(rows)};
}

std::string position_text(const statistics::Moments& position) {
  if (position.min == position.max) return fmt::format("{:.0f}", position.min);
  return fmt::format("{:.0f} to {:.0f}", position.min, position.max);
}

text::PointTable table_of_targets(const RepeatabilitySummary& summary,
                                  const std::vector<std::string>& labels) {
  using T = TargetRepeatability;
  static const Shown<T> shown{{&T::mean_positive, &T::mean_negative, &T::reversal, &T::repeatability_positive,
                               &T::repeatability_negative, &T::repeatability},
                              {&T::mean_positive, &T::repeatability_positive},
                              {&T::mean_negative, &T::repeatability_negative}};
  using Row = const RowOfValues&;
  const auto targets = static_cast<std::size_t>(summary.shape.targets);
  const std::vector<RowOfValues> rows = rows_of(summary, labels, targets);
  std::vector<text::TextColumn> columns{column_of("point", false, rows, [](Row row) { return row.label; })};
  columns.push_back(column_of("target", true, rows,
                              [](Row row) { return position_text(row.point.positions[row.target]); }));
  columns.push_back(sources_of(rows));
  add_values(columns, target_fields(), shown, summary.shape, rows,
             [](Row row) { return std::span(row.point.sources[row.source].targets[row.target]); });
  return {std::move(columns), points_of(rows)};
}

std::string title(const SequenceShape& shape) {
  const std::string_view from = shape.positive && shape.negative ? "both sides"
                                : shape.positive                 ? "below"
                                                                 : "above";
  return fmt::format("repeatability after ISO 230-2: {} {} approached from {} in {} {}", shape.targets,
                     shape.targets == 1 ? "target" : "targets", from, shape.cycles,
                     shape.cycles == 1 ? "cycle" : "cycles");
}

/// A line for each point at which all trials repeat exactly: what 100 % is worth.
std::string exact_points(const RepeatabilitySummary& summary, const std::vector<std::string>& labels) {
  std::string lines;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const PointRepeatability& point = summary.points[i];
    if (point.zero_repeatability != point.trials) continue;
    lines += fmt::format(
        "{}: all {} trials repeat exactly: not 100 %, but at most {} of axes do not, with {:.6g} % "
        "confidence\n",
        text::printable(labels[i]), point.trials,
        text::percent_at_most(statistics::proportion_at_most(0, point.trials, summary.confidence)),
        100.0 * summary.confidence);
  }
  return lines;
}

constexpr std::string_view legend =
    "median (95 % quantile) over the trials without a nonfinite move; deviations by the true position are "
    "from the middle of the target's count, those by the encoder, the fine one, from the target\n"
    "R: repeatability; B: reversal value; E: systematic deviation; M: mean bidirectional deviation; "
    "A: accuracy; x̄: mean deviation; ↑: approached from below; ↓: from above\n"
    "zero: proportion of all trials whose repeatability by the encoder is exactly 0, the paper's 100 %; "
    "bounds after Clopper and Pearson, in %\n";

}  // namespace

void add_tables(measures::SummarySection& section, const RepeatabilitySummary& summary,
                const std::vector<std::string>& labels) {
  section.title = title(summary.shape);
  section.tables = {table_of_axis(summary, labels), table_of_targets(summary, labels)};
  section.note = exact_points(summary, labels) + std::string(legend);
}

}  // namespace zerocount::iso230
