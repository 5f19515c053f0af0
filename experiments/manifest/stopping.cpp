#include "experiments/manifest/stopping.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/unknown_key.hpp"

namespace zerocount::manifest {
namespace {

const std::vector<std::string> keys{"success_rate_halfwidth", "confidence", "min_trials", "max_trials"};

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

}  // namespace

void read_stop(const yaml::Field& field, std::int64_t max_trials, study::Study& study,
               yaml::Problems& problems) {
  if (!yaml::check_map(field, "stop: {success_rate_halfwidth: 0.005, max_trials: 100000}", problems)) return;
  study::StoppingRule rule;
  rule.block = study.trials;
  parameters::check_keys(field, keys, problems);
  if (const auto halfwidth = yaml::find_field(field, "success_rate_halfwidth"))
    rule.success_rate_halfwidth =
        yaml::read_real(*halfwidth, {.low = 0.0, .high = 0.5}, problems).value_or(0.1);
  if (const auto confidence = yaml::find_field(field, "confidence"))
    rule.confidence =
        yaml::read_real(*confidence, {.low = 0.0, .high = 1.0}, problems).value_or(rule.confidence);
  if (const auto min = yaml::find_field(field, "min_trials"))
    rule.min_trials = yaml::read_whole(*min, 1, max_trials, problems).value_or(1);
  if (const auto max = yaml::find_field(field, "max_trials"))
    rule.max_trials = yaml::read_whole(*max, 1, max_trials, problems).value_or(max_trials);
  yaml::require_key(field, keys[0],
                    "the half-width of the bounds of the success rate at which the study ends, 0 to 0.5",
                    problems);
  yaml::require_key(field, keys[3], "the maximum number of trials at a point", problems);
  check_order(field, rule, problems);
  if (study.design != study::Design::monte_carlo) {
    problems.add(field, "sequential stopping needs independently drawn trials", "design: monte_carlo");
  }
  study.stop = rule;
  study.trials = rule.max_trials;
}

}  // namespace zerocount::manifest
