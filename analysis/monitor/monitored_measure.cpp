#include "analysis/monitor/monitored_measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "analysis/statistics/quantile.hpp"
#include "core/text/number_text.hpp"
#include "core/text/unit.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::monitor {
namespace {

/// "band_settling_time" of "band_settling_time[1]", and the number in the brackets.
struct Indexed {
  std::string_view stem;
  std::optional<double> index{};
};

std::string_view without_blanks_around(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

Indexed indexed(std::string_view name) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string_view::npos || !name.ends_with(']')) return {name};
  return {name.substr(0, bracket),
          text::parse_number<double>(name.substr(bracket + 1, name.size() - bracket - 2))};
}

/// A table with error bands and a tolerance, whose rows stand for those of all bands and tolerances.
const layout::MeasureTable& table_with_both() {
  study::StudyFeatures features;
  features.tolerances.limits[0] = 1.0;
  features.tolerances.count = 1;
  return layout::measure_table(features);
}

/// The name of the row's measure of this band or tolerance; nothing if there is none.
std::optional<std::string> name_with_index(const layout::Measure& row, std::string_view stem, double index) {
  constexpr double largest = 1e15;  // below which all whole numbers are exact
  if (!(std::abs(index) < largest)) return std::nullopt;
  if (!row.band) return layout::name_of_tolerance(stem, index);
  if (std::rint(index) != index) return std::nullopt;
  return layout::name_of_band(stem, static_cast<std::int64_t>(index));
}

Scale scale_of(const layout::Measure& row, bool quality) {
  if (quality || row.field.valid.high <= 1.0) return Scale::proportion;
  const layout::ValidValues& valid = row.field.valid;
  const bool is_whole = row.field.column.element == hdf5::Element::int64 && !valid.expected.empty();
  const bool is_count = row.reduction == layout::MoveReduction::sum || (is_whole && valid.low == 0.0);
  return is_count ? Scale::counts : Scale::plain;
}

}  // namespace

std::optional<MonitoredMeasure> measure_named(std::string_view name) {
  const Indexed wanted = indexed(name);
  const bool is_indexed = name.find('[') != std::string_view::npos;
  if (is_indexed && !wanted.index) return std::nullopt;
  for (const layout::Measure& row : table_with_both()) {
    const bool has_index = row.band || row.tolerance;
    if (has_index != is_indexed || indexed(row.field.column.name).stem != wanted.stem) continue;
    const bool quality = layout::is_quality(row);
    const std::optional<std::string> own_name =
        wanted.index ? name_with_index(row, wanted.stem, *wanted.index) : std::string(name);
    if (!own_name) return std::nullopt;
    return MonitoredMeasure{.name = *own_name,
                            .unit = row.field.column.unit,
                            .row = &row,
                            .quality = quality,
                            .scale = scale_of(row, quality),
                            .accumulates = name == "creep" || name == "reversal_depth"};
  }
  return std::nullopt;
}

ColumnHead column_head(std::string_view text) {
  text = without_blanks_around(text);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t bracket = text.rfind(open);
    if (bracket == std::string_view::npos || !text.ends_with(close) || bracket == 0) continue;
    const std::string_view inside = text.substr(bracket + 1, text.size() - bracket - 2);
    const bool is_index = open == '[' && text[bracket - 1] != ' ' && text::parse_number<double>(inside);
    if (is_index) continue;
    return {std::string(without_blanks_around(text.substr(0, bracket))),
            std::string(without_blanks_around(inside))};
  }
  return {std::string(text), {}};
}

double si_factor(std::string_view unit) {
  const std::optional<text::Unit> known = text::unit_named(unit);
  return known ? known->si : 1.0;
}

bool have_same_dimension(std::string_view one, std::string_view other) {
  if (one.empty() || other.empty() || one == other) return true;
  using enum text::Dimension;
  const std::optional<text::Unit> a = text::unit_named(one);
  const std::optional<text::Unit> b = text::unit_named(other);
  if (!a || !b) return false;
  const auto is_number = [](const text::Unit& unit) {
    return unit.dimension == count || unit.dimension == proportion;
  };
  return a->dimension == b->dimension || (is_number(*a) && is_number(*b));
}

std::string linear_unit(const MonitoredMeasure& measure) {
  return parameters::unit_on(parameters::AxisKind::linear, measure.unit);
}

bool can_be_in(const MonitoredMeasure& measure, std::string_view unit) {
  const bool is_counted =
      measure.scale != Scale::proportion && (measure.unit == "count" || measure.unit == "1");
  if (is_counted && si_factor(unit) != 1.0) return false;
  return have_same_dimension(unit, measure.unit) || have_same_dimension(unit, linear_unit(measure));
}

double ranked_value(const MonitoredMeasure& measure, double number) {
  if (std::isnan(number)) return std::numeric_limits<double>::infinity();
  if (measure.name == "outcome") return number == 0.0 ? 1.0 : 0.0;
  if (measure.name == "arrival" && number < 0.0) return std::numeric_limits<double>::infinity();
  return measure.row->values.magnitude ? std::abs(number) : number;
}

double serial_correlation(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const double middle = 0.5 * static_cast<double>(values.size());
  std::vector<double> ranks;  // of the values, those of equal ones alike, minus their mean
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    ranks.push_back(0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin())) - middle);
  }
  double squares = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    squares += ranks[i] * ranks[i];
    if (i > 0) steps += (ranks[i] - ranks[i - 1]) * (ranks[i] - ranks[i - 1]);
  }
  return squares > 0.0 ? 1.0 - 0.5 * steps / squares : 0.0;
}

double block_value(const MonitoredMeasure& measure, std::span<const double> moves) {
  if (moves.size() == 1) return moves.front();
  if (measure.quality)
    return std::accumulate(moves.begin(), moves.end(), 0.0) / static_cast<double>(moves.size());
  return statistics::upper_median({moves.begin(), moves.end()});
}

}  // namespace zerocount::monitor
