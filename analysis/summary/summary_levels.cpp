#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "analysis/measures/level_statistics.hpp"
#include "analysis/statistics/mean_bounds.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount {
namespace {

constexpr double micro = 1e6;

/// Decimals that show two digits of an uncertainty; none below 0, at most 9.
int decimals_below(double uncertainty) {
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 9);
}

/// `value` as precisely as its bounds allow; with four digits where they say nothing.
std::string bounded_number(double value, double uncertainty) {
  if (!(uncertainty > 0.0)) return short_number(value);
  return fmt::format("{:.{}f}", value, decimals_below(uncertainty));
}

std::string position_text(const LevelStatistics& level) {
  const ConfidenceInterval bounds = student_t(level.position, level.confidence);
  return bounded_number(micro * level.position.mean, 0.5 * micro * (bounds.high - bounds.low));
}

std::string bounds_text(const LevelStatistics& level) {
  const ConfidenceInterval bounds = student_t(level.position, level.confidence);
  if (std::isnan(bounds.low)) return "–";
  const double uncertainty = 0.5 * micro * (bounds.high - bounds.low);
  return fmt::format("[{}, {}]", bounded_number(micro * bounds.low, uncertainty),
                     bounded_number(micro * bounds.high, uncertainty));
}

}  // namespace

std::vector<TextColumn> level_columns(const StudySummary& summary) {
  const AxisKind axis = summary.features.axis;
  const std::string torque = fmt::format("{} ({})", text_on(axis, "torque"), unit_on(axis, "N m"));
  const std::string small = unit_on(axis, "µrad");
  std::vector<TextColumn> columns{{"point", false, {}},
                                  {"level", true, {}},
                                  {torque, true, {}},
                                  {"trials", true, {}},
                                  {fmt::format("position ({})", small), true, {}},
                                  {bounds_head(summary), true, {}},
                                  {fmt::format("sd ({})", small), true, {}},
                                  {fmt::format("creep ({})", small), true, {}},
                                  {"depth", true, {}},
                                  {"broke away", true, {}}};
  const std::vector<std::string> observed = observations(summary);
  if (!observed.empty()) columns.push_back({"observed", false, {}});
  for (std::size_t point = 0; point < summary.points.size(); ++point) {
    const std::vector<LevelStatistics>& levels = summary.points[point].levels;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const LevelStatistics& level = levels[i];
      const bool empty = level.torque.n == 0;
      std::vector<std::string> cells{printable(summary.labels[point]),
                                     std::to_string(i),
                                     short_number(level.torque.mean),
                                     std::to_string(level.torque.n),
                                     position_text(level),
                                     bounds_text(level),
                                     short_number(micro * level.position.sd()),
                                     short_number(micro * level.creep.mean),
                                     empty ? "–" : std::to_string(level.reversal_depth),
                                     percentage(level.broke_away, level.torque.n)};
      if (!observed.empty()) cells.push_back(i == 0 ? printable(observed[point]) : "");
      for (std::size_t column = 0; column < columns.size(); ++column) {
        columns[column].cells.push_back(cells[column]);
      }
    }
  }
  return columns;
}

std::string level_legend() {
  return "All values are those at the end of a level, means over the trials whose motion was not lost.\n"
         "position: of the rotor from the start, with bounds of the mean after Student; sd: over trials\n"
         "creep: plastic extension; depth: most reversal points on the stack; broke away: proportion of "
         "trials\n";
}

nlohmann::ordered_json levels_json(const PointSummary& point) {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < point.levels.size(); ++i) {
    nlohmann::ordered_json level{{"level", i}};
    add_fields(level, level_fields(), point.levels[i]);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace zerocount
