#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/measures/point_columns.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount::summary {
namespace {

constexpr double micro = 1e6;

/// Decimals that show two digits of an uncertainty; none below 0, at most 9.
int decimals_below(double uncertainty) {
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 9);
}

/// `value` as precisely as its bounds allow; with four digits where they say nothing.
std::string bounded_number(double value, double uncertainty) {
  if (!(uncertainty > 0.0)) return text::short_number(value);
  return fmt::format("{:.{}f}", value, decimals_below(uncertainty));
}

std::string position_text(const measures::MeasureStatistics& position) {
  const statistics::ConfidenceInterval& bounds = position.mean_bounds;
  return bounded_number(micro * position.mean, 0.5 * micro * (bounds.high - bounds.low));
}

std::string bounds_text(const statistics::ConfidenceInterval& bounds) {
  if (std::isnan(bounds.low)) return "–";
  const double uncertainty = 0.5 * micro * (bounds.high - bounds.low);
  return fmt::format("[{}, {}]", bounded_number(micro * bounds.low, uncertainty),
                     bounded_number(micro * bounds.high, uncertainty));
}

}  // namespace

text::PointTable level_table(const StudySummary& summary) {
  const parameters::AxisKind axis = summary.features.axis;
  const std::string torque_head =
      fmt::format("{} ({})", parameters::text_on(axis, "$torque"), parameters::unit_on(axis, "N m"));
  const std::string small = parameters::unit_on(axis, "µrad");
  std::vector<text::TextColumn> columns{{"point", false, {}},
                                        {"level", true, {}},
                                        {torque_head, true, {}},
                                        {"trials", true, {}},
                                        {fmt::format("position ({})", small), true, {}},
                                        {bounds_head(summary), true, {}},
                                        {fmt::format("sd ({})", small), true, {}},
                                        {fmt::format("creep ({})", small), true, {}},
                                        {"depth", true, {}},
                                        {"broke away", true, {}}};
  const std::vector<std::string> observed = observations(summary);
  if (!observed.empty()) columns.push_back({"observed", false, {}});
  std::vector<std::int64_t> points;
  for (std::size_t point = 0; point < summary.points.size(); ++point) {
    const std::vector<measures::LevelStatistics>& levels = summary.points[point].levels;
    points.insert(points.end(), levels.size(), static_cast<std::int64_t>(point));
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const measures::LevelStatistics& level = levels[i];
      const measures::MeasureStatistics& torque = level.of(&trial::MoveOutcome::holding_torque);
      const measures::MeasureStatistics& position = level.of(&trial::MoveOutcome::final_position);
      const double depth = level.of(&trial::MoveOutcome::reversal_depth).max;
      std::vector<std::string> cells{
          text::printable(summary.labels[point]),
          std::to_string(i),
          text::short_number(torque.mean),
          std::to_string(torque.n),
          position_text(position),
          bounds_text(position.mean_bounds),
          text::short_number(micro * position.sd),
          text::short_number(micro * level.of(&trial::MoveOutcome::creep).mean),
          torque.n == 0 ? "–" : fmt::format("{:.0f}", depth),
          text::percentage(level.of(&trial::MoveOutcome::broke_away).trials, torque.n)};
      if (!observed.empty()) cells.push_back(i == 0 ? text::printable(observed[point]) : "");
      for (std::size_t column = 0; column < columns.size(); ++column) {
        columns[column].cells.push_back(cells[column]);
      }
    }
  }
  return {std::move(columns), std::move(points)};
}

std::string level_legend(parameters::AxisKind axis) {
  return parameters::text_on(
      axis,
      "All values are those at the end of a level, means over the trials whose motion was not lost.\n"
      "position: of the $rotor from the start, with bounds of the mean after Student; sd: over trials\n"
      "creep: plastic extension; depth: most reversal points on the stack; broke away: proportion of "
      "trials\n");
}

nlohmann::ordered_json levels_json(const measures::PointSummary& point) {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  const std::vector<measures::LevelField> fields = measures::level_fields(*point.table);
  for (std::size_t i = 0; i < point.levels.size(); ++i) {
    nlohmann::ordered_json level{{"level", i}};
    text::add_fields(level, fields, point.levels[i]);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace zerocount::summary
