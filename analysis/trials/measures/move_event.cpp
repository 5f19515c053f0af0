#include "analysis/trials/measures/move_event.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "core/text/relation.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/yaml/problems.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {
namespace {

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw Failure(
      ExitCode::bad_input,
      fmt::format("option '--event': '{}' {}; expected a measure of a move, one of > >= < <=, and a "
                  "number, such as 'arrival_time > 0.5'",
                  text, what));
}

/// The row of the table of measures with this name.
const layout::Measure& measure_named(const study::Study& study, std::string_view text,
                                     std::string_view name) {
  std::vector<std::string> names;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (!layout::is_in_file(measure, study.features)) continue;
    names.push_back(measure.field.column.name);
    if (names.back() == name) return measure;
  }
  if (const std::string_view meanings = trial::meanings_of_settling_time(name); !meanings.empty())
    fail(text, fmt::format("may mean two measures, {}", meanings));
  const std::string nearest(yaml::nearest_name(name, names));
  fail(text, fmt::format("names no measure of a move of this study: '{}'{}", name,
                         nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest)));
}

/// The limit whose miss is the event.
/// @param event an event about a measure
const MeasureLimit& limit_of(const MoveEvent& event) {
  return event.criteria.front().limits.front();
}

/// Whether the criteria may allow different times for different moves.
bool allow_several_times(const std::vector<MoveCriterion>& criteria) {
  return criteria.size() > 1 || criteria.front().within.after_profile;
}

/// Number that ranks moves by how late they settle. If there is one criterion with the same allowed time for
/// all moves: the settling time, s. Otherwise the settling time divided by the allowed time, the largest over
/// all criteria. NaN if the move does not settle by one of them.
double lateness_of(const std::vector<MoveCriterion>& criteria, const trial::MoveOutcome& move) {
  const bool by_ratio = allow_several_times(criteria);
  double latest = criteria.size() > 1 ? 0.0 : statistics::unknown;
  for (const MoveCriterion& criterion : criteria) {
    if (!asks(criterion, move)) continue;
    const double time = settling_time(criterion, move);
    if (!by_ratio || std::isnan(time)) return time;
    latest = std::fmax(latest, time / allowed_time(criterion, move));
  }
  return latest;
}

/// Value of the limited measure, with the sign that makes larger values nearer to a miss of the limit; NaN if
/// there is nothing to measure.
double nearness_to_miss(const MeasureLimit& limit, const trial::MoveOutcome& move) {
  const double value = ranked_value(*limit.measure, move).value_or(statistics::unknown);
  return text::is_lower_limit(limit.limit.relation) ? -value : value;
}

std::string name_of_settling(const MoveCriterion& criterion) {
  switch (criterion.settling) {
    case Settling::in_band:
      return "settling time in the band";
    case Settling::in_tolerance:
      return "settling time in the tolerance";
    case Settling::not_demanded:
    case Settling::at_zero_counts:
      return "time until arrival";
  }
  return "";
}

}  // namespace

MoveEvent missed_criteria(const study::Study& study) {
  return {.criteria = move_criteria_of(study)};
}

MoveEvent parse_event(const study::Study& study, std::string_view text) {
  using text::Relation;
  const auto comparison = text::parse_comparison(text);
  if (!comparison || comparison->relation == Relation::equal || comparison->relation == Relation::unequal)
    fail(text, "compares nothing");
  const std::optional<text::Limit> event = text::limit_of(*comparison);
  if (!event) fail(text, "has no number behind the sign");
  const layout::Measure& measure = measure_named(study, text, comparison->name);
  if (study.open_loop && measure.values.needs_target)
    fail(text, "needs targets, but torque levels have none");
  if (measure.values.magnitude && event->value < 0.0)
    fail(text, "compares a magnitude with a negative number");
  MoveCriterion kept{.settling = Settling::not_demanded,
                     .limits = {{.measure = &measure, .of_magnitude = false, .limit = negation(*event)}}};
  return {std::string(text::trimmed(text)), {std::move(kept)}};
}

bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move) {
  return std::ranges::any_of(event.criteria,
                             [&](const MoveCriterion& criterion) { return asks(criterion, move); });
}

bool happens(const MoveEvent& event, const trial::MoveOutcome& move) {
  return std::ranges::any_of(event.criteria, [&](const MoveCriterion& criterion) {
    return asks(criterion, move) && !meets(criterion, move);
  });
}

std::string name_of(MoveScore score, const MoveEvent& event) {
  switch (score) {
    case MoveScore::event:
      if (event.is_about_measure()) return limit_of(event).measure->field.column.name;
      if (allow_several_times(event.criteria)) return "settling time as a proportion of what a goal allows";
      return name_of_settling(event.criteria.front());
    case MoveScore::peak_torque:
      return "largest torque";
    case MoveScore::final_error:
      return "true error at the end";
    case MoveScore::restlessness:
      return "time at other counts after arrival";
  }
  return "";
}

double score_of(MoveScore score, const MoveEvent& event, const trial::MoveOutcome& move) {
  switch (score) {
    case MoveScore::event:
      return event.is_about_measure() ? nearness_to_miss(limit_of(event), move)
                                      : lateness_of(event.criteria, move);
    case MoveScore::peak_torque:
      return move.peak_torque;
    case MoveScore::final_error:
      return std::abs(move.true_error);
    case MoveScore::restlessness:
      return 1.0 - move.zero_fraction;
  }
  return statistics::unknown;
}

}  // namespace zerocount::measures
