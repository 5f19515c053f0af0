#include "analysis/measures/move_event.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/divergence.hpp"
#include "experiments/yaml/nearest_name.hpp"

namespace zerocount::measures {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw Failure(
      ExitCode::bad_input,
      fmt::format("option '--event': '{}' {}; expected a measure of a move, one of > >= < <=, and a "
                  "number, such as 'settling_time > 0.5'",
                  text, what));
}

double value_of(const layout::Measure& measure, const trial::MoveOutcome& move) {
  const double value = counted_value(measure, move);
  return std::isnan(value) && measure.values.nan_is_late ? std::numeric_limits<double>::infinity() : value;
}

/// The settling time of a goal; of several the largest, as a proportion of the time allowed.
double lateness_of(const MoveEvent& event, const trial::MoveOutcome& move) {
  double latest = event.goals.size() > 1 ? 0.0 : statistics::unknown;
  for (const CountedGoal& goal : event.goals) {
    if (!asks(goal, move)) continue;
    if (event.goals.size() == 1) return settling_time(goal, move);
    const double time = settling_time(goal, move);
    if (std::isnan(time)) return time;
    latest = std::max(latest, time / goal.within);
  }
  return latest;
}

layout::Measure measure_named(const study::Study& study, std::string_view text, std::string_view name) {
  std::vector<std::string> names;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (!layout::is_in_file(measure, layout::format_version, study.features)) continue;
    names.push_back(measure.field.column.name);
    if (names.back() == name) return measure;
  }
  const std::string nearest(yaml::nearest_name(name, names));
  fail(text, fmt::format("names no measure of a move of this study: '{}'{}", name,
                         nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest)));
}

}  // namespace

MoveEvent missed_question(const study::Study& study) {
  MoveEvent event;
  event.goals = asked_of_moves(study);
  return event;
}

MoveEvent parse_event(const study::Study& study, std::string_view text) {
  const auto sign = text.find_first_of("<>");
  if (sign == std::string_view::npos) fail(text, "compares nothing");
  MoveEvent event;
  event.text = trimmed(text);
  event.above = text[sign] == '>';
  event.inclusive = sign + 1 < text.size() && text[sign + 1] == '=';
  const std::string_view number = trimmed(text.substr(sign + (event.inclusive ? 2 : 1)));
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), event.limit);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(event.limit))
    fail(text, "has no number behind the sign");
  event.measure = measure_named(study, text, trimmed(text.substr(0, sign)));
  if (study.open_loop && event.measure.values.needs_target)
    fail(text, "needs targets, which torque levels have not");
  if (event.measure.values.magnitude && event.limit < 0.0)
    fail(text, "compares a magnitude with a negative number");
  return event;
}

bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move) {
  return !event.text.empty() ||
         std::ranges::any_of(event.goals, [&](const CountedGoal& goal) { return asks(goal, move); });
}

bool happens(const MoveEvent& event, const trial::MoveOutcome& move) {
  if (event.text.empty())
    return std::ranges::any_of(
        event.goals, [&](const CountedGoal& goal) { return asks(goal, move) && !meets(goal, move); });
  const double value = value_of(event.measure, move);
  if (std::isnan(value) && trial::was_run(move) && move.outcome == trial::Outcome::nonfinite)
    return event.above;
  if (value == event.limit) return event.inclusive;
  return event.above ? value > event.limit : value < event.limit;
}

std::string name_of(MoveScore score, const MoveEvent& event) {
  switch (score) {
    case MoveScore::event:
      if (!event.text.empty()) return event.measure.field.column.name;
      if (event.goals.size() > 1) return "settling time as a proportion of what a goal allows";
      return event.goals.front().tolerance ? "settling time in the tolerance"
             : event.goals.front().slot    ? "settling time in the band"
                                           : "time until arrival";
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
      if (event.text.empty()) return lateness_of(event, move);
      return event.above ? value_of(event.measure, move) : -value_of(event.measure, move);
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
