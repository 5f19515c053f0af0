#include "experiments/manifest/goal.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::manifest {
namespace {

constexpr std::int64_t max_band = static_cast<std::int64_t>(parameters::max_count);

const std::vector<std::string> goal_keys{"band", "within", "moves", "machines", "confidence"};

/// Proportions and the confidence of a goal.
constexpr numerics::Interval open_unit{.low = 0.0, .high = 1.0};

// Adds the band where it belongs, unless it is there already. False if there are too many.
bool add_band(trial::ErrorBands& bands, std::int64_t band) {
  const auto begin = bands.limits.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(bands.count);
  const auto place = std::lower_bound(begin, end, band);
  if (place != end && *place == band) return true;
  if (bands.count == bands.limits.size()) return false;
  std::move_backward(place, end, end + 1);
  *place = band;
  ++bands.count;
  return true;
}

// A longer time could never be reached.
void check_within(const yaml::Field& field, double within, const study::StudyPlan& plan,
                  yaml::Problems& problems) {
  double shortest = within;
  study::holds_somewhere(plan, "command.hold", [&shortest](const study::ValueLimits& hold) {
    if (hold.low < shortest) shortest = hold.low;
    return false;
  });
  if (shortest < within)
    problems.add(field, fmt::format("{} s is longer than the hold of a move, {} s", within, shortest),
                 "a time in s, at most command.hold");
}

}  // namespace

void read_bands(const yaml::Field& field, trial::ErrorBands& bands, yaml::Problems& problems) {
  const std::string expected =
      fmt::format("a list of 1 to {} increasing numbers of counts, such as [0, 1]", bands.limits.size());
  if (!yaml::check_list(field, expected, problems)) return;
  const std::size_t count = field.node->items.size();
  if (count < 1 || count > bands.limits.size()) {
    problems.add(field, fmt::format("found a list of {}", count), expected);
    return;
  }
  trial::ErrorBands read{.count = count};
  for (std::size_t i = 0; i < count; ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const auto limit = yaml::read_whole(item, 0, max_band, problems);
    if (!limit) return;
    if (i > 0 && *limit <= read.limits[i - 1]) {
      problems.add(item, fmt::format("{} is not above {}", *limit, read.limits[i - 1]), expected);
      return;
    }
    read.limits[i] = *limit;
  }
  bands = read;
}

void read_goal(const yaml::Field& field, study::StudyPlan& plan, study::Study& study,
               yaml::Problems& problems) {
  if (!yaml::check_map(field, "goal: {band: 1, within: 0.05, moves: 0.99}", problems)) return;
  parameters::check_keys(field, goal_keys, problems);
  yaml::require_key(field, "within", "the time, s, after which the error stays within the band", problems);
  yaml::require_key(field, "moves", "the proportion of the moves that meet it, between 0 and 1", problems);
  study::Goal goal;
  if (const auto band = yaml::find_field(field, "band")) {
    goal.band = yaml::read_whole(*band, 0, max_band, problems).value_or(goal.band);
  }
  if (const auto within = yaml::find_field(field, "within")) {
    goal.within = yaml::read_real(*within, numerics::above(0), problems).value_or(goal.within);
    check_within(*within, goal.within, plan, problems);
  }
  if (const auto moves = yaml::find_field(field, "moves"))
    goal.moves = yaml::read_real(*moves, open_unit, problems).value_or(goal.moves);
  if (const auto machines = yaml::find_field(field, "machines")) {
    goal.machines = yaml::read_real(*machines, open_unit, problems);
    if (study.rigs == 0)
      problems.add(*machines, "without rigs no trials share a machine",
                   "`rigs`, the number of machines, or the key left out");
  }
  if (const auto confidence = yaml::find_field(field, "confidence"))
    goal.confidence = yaml::read_real(*confidence, open_unit, problems).value_or(goal.confidence);
  if (study.stop)
    problems.add(field, "its bounds need a number of trials that does not depend on the outcomes",
                 "no `stop`, or no goal");
  if (study.design == study::Design::saltelli)
    problems.add(field, "its bounds need trials that share no numbers", "another design, or no goal");
  if (plan.open_loop) problems.add(field, "torque levels have no target", "command.targets, or no goal");
  if (!add_band(plan.common.verdict.bands, goal.band)) {
    problems.add(
        field, fmt::format("the band of {} counts is one too many", goal.band),
        fmt::format("at most {} error bands with that of the goal", plan.common.verdict.bands.limits.size()));
  }
  study.goal = goal;
}

}  // namespace zerocount::manifest
