#include "experiments/sections/goal.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "experiments/keys/key_reading.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::sections {
namespace {

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

void check_order(const yaml::Field& map, const study::StoppingRule& rule, yaml::Problems& problems) {
  const auto max_trials = yaml::find_field(map, "max_trials");
  const auto min_trials = yaml::find_field(map, "min_trials");
  if (max_trials && rule.max_trials < rule.block) {
    problems.add(
        *max_trials,
        fmt::format("{} trials are fewer than a block of {} (`trials`)", rule.max_trials, rule.block),
        fmt::format("at least {}", rule.block));
  } else if (max_trials && min_trials && rule.min_trials > rule.max_trials) {
    problems.add(*min_trials,
                 fmt::format("{} trials exceed max_trials, {}", rule.min_trials, rule.max_trials),
                 fmt::format("at most {}", rule.max_trials));
  }
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
    const auto limit = yaml::read_whole(item, 0, keys::max_band, problems);
    if (!limit) return;
    if (i > 0 && *limit <= read.limits[i - 1]) {
      problems.add(item, fmt::format("{} is not above {}", *limit, read.limits[i - 1]), expected);
      return;
    }
    read.limits[i] = *limit;
  }
  bands = read;
}

void read_goal(const yaml::Field& field, keys::Reading& reading) {
  study::Study& study = reading.study;
  trial::ErrorBands& bands = reading.plan.common.verdict.bands;
  yaml::Problems& problems = reading.problems;
  const study::Goal& goal = study.goal.emplace();
  keys::read_key(field, *keys::find_general_key("goal"), reading);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.goal.reset();
  if (const auto within = yaml::find_field(field, "within"))
    check_within(*within, goal.within, reading.plan, problems);
  const auto machines = yaml::find_field(field, "machines");
  if (machines && study.rigs == 0)
    problems.add(*machines, "without rigs no trials share a machine",
                 "`rigs`, the number of machines, or the key left out");
  if (study.stop)
    problems.add(field, "its bounds need a number of trials that does not depend on the outcomes",
                 "no `stop`, or no goal");
  if (study.design == study::Design::saltelli)
    problems.add(field, "its bounds need trials that share no numbers", "another design, or no goal");
  if (reading.plan.open_loop)
    problems.add(field, "torque levels have no target", "command.targets, or no goal");
  if (!add_band(bands, goal.band))
    problems.add(field, fmt::format("the band of {} counts is one too many", goal.band),
                 fmt::format("at most {} error bands with that of the goal", bands.limits.size()));
}

void read_stop(const yaml::Field& field, keys::Reading& reading) {
  study::Study& study = reading.study;
  study::StoppingRule& rule = study.stop.emplace();
  rule.block = study.trials;
  // If it cannot be read, no other fault follows from that.
  if (yaml::find_field(field, "max_trials")) rule.max_trials = keys::max_study_trials;
  keys::read_key(field, *keys::find_general_key("stop"), reading);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.stop.reset();
  check_order(field, rule, reading.problems);
  if (study.design != study::Design::monte_carlo) {
    reading.problems.add(field, "sequential stopping needs independently drawn trials",
                         "design: monte_carlo");
  }
  study.trials = rule.max_trials;
}

}  // namespace zerocount::sections
