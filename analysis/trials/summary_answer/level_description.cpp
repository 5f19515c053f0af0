#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary_answer/parts.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using Level = const LevelAtPoint&;

constexpr double micro = 1e6;

/// Number of decimals with which a number shows two significant digits of its uncertainty, between 0 and 9.
int decimals_below(double uncertainty) {
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 9);
}

/// `value` as text with the decimals that its uncertainty justifies; with four significant digits if the
/// uncertainty is unknown or 0.
std::string bounded_number(double value, double uncertainty) {
  if (!(uncertainty > 0.0)) return text::short_number(value);
  return fmt::format("{:.{}f}", value, decimals_below(uncertainty));
}

/// The mean position with its bounds as text, in millionths of its unit (µrad or µm).
std::string position_text(const measures::MeasureStatistics& position) {
  const statistics::ConfidenceInterval& bounds = position.mean_bounds;
  const double uncertainty = 0.5 * micro * (bounds.high - bounds.low);
  std::string text = bounded_number(micro * position.mean, uncertainty);
  if (!std::isnan(bounds.low))
    text += fmt::format(" [{}, {}]", bounded_number(micro * bounds.low, uncertainty),
                        bounded_number(micro * bounds.high, uncertainty));
  return text;
}

template <class Value>
auto statistic(Value trial::MoveOutcome::*member, double (*number)(const measures::MeasureStatistics&)) {
  return [member, number](Level l) { return number(l.statistics().of(member)); };
}

double micro_mean(const measures::MeasureStatistics& s) {
  return micro * s.mean;
}

std::int64_t trials_of(Level l) {
  return l.statistics().of(&trial::MoveOutcome::holding_torque).n;
}

std::string depth_text(Level l) {
  return trials_of(l) == 0
             ? "–"
             : fmt::format("{:.0f}", l.statistics().of(&trial::MoveOutcome::reversal_depth).max);
}

void add_people_columns(document::Description<LevelAtPoint>& level, const summary::StudySummary& summary) {
  using M = trial::MoveOutcome;
  const parameters::AxisKind axis = summary.features.axis;
  const std::string small = parameters::unit_on(axis, "µrad");
  const auto column = [axis](const char* heading, std::string unit, const char* meaning = "") {
    return document::Item{.heading = parameters::text_on(axis, heading),
                          .meaning = parameters::text_on(axis, meaning),
                          .unit = std::move(unit),
                          .numeric = true};
  };
  level
      .value(
          column(
              "$torque", parameters::unit_on(axis, "N m"),
              "All values are those at the end of a level, means over the trials whose motion was not lost."),
          statistic(&M::holding_torque, [](const measures::MeasureStatistics& s) { return s.mean; }))
      .value(column("trials", ""), trials_of)
      .value(
          column(
              "position", small,
              "position: of the $rotor from the start, with bounds of the mean after Student; sd: over trials"),
          [](Level l) { return position_text(l.statistics().of(&M::final_position)); })
      .value(column("sd", small),
             statistic(&M::final_position, [](const measures::MeasureStatistics& s) { return micro * s.sd; }))
      .value(
          column(
              "creep", small,
              "creep: plastic extension; depth: most reversal points on the stack; broke away: proportion of trials"),
          statistic(&M::creep, micro_mean))
      .value(column("depth", ""), depth_text)
      .value(column("broke away", ""), [](Level l) {
        return text::percentage(l.statistics().of(&M::broke_away).trials, trials_of(l));
      });
}

}  // namespace

document::Description<LevelAtPoint> level_description(const summary::StudySummary& summary) {
  const parameters::AxisKind axis = summary.features.axis;
  document::Description<LevelAtPoint> level;
  level
      .value({.key = "point", .meaning = "number of the design point", .shown = Visibility::in_csv},
             [](Level l) { return l.point.point; })
      .value({.key = "label",
              .heading = "point",
              .meaning = "label of the design point",
              .shown = Visibility::not_in_json},
             [](Level l) { return l.point.label(); });
  for (const study::SweepAxis& swept : summary.axes)
    level.value(
        {.key = swept.name, .meaning = swept.meaning, .unit = swept.unit, .shown = Visibility::in_csv},
        [&swept](Level l) { return value_at(swept, l.point); });
  level.value({"level", "level", "number of the torque level"}, &LevelAtPoint::level);
  measures::add_fields(level, measures::level_fields(summary.table()), axis,
                       [](Level l) -> const measures::LevelStatistics& { return l.statistics(); });
  add_people_columns(level, summary);
  return level
      .value({.key = "observed",
              .heading = "observed",
              .meaning = "what was observed on the real machine",
              .shown = Visibility::not_in_json},
             [](Level l) { return summary::observed_at(l.point.summary, l.point.point); })
      .shown_as(
          [](Level l) { return l.level == 0 ? summary::observed_at(l.point.summary, l.point.point) : ""; });
}

}  // namespace zerocount::summary_answer
