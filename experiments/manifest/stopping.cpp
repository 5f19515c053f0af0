#include "experiments/manifest/stopping.hpp"

#include <fmt/format.h>

#include "experiments/manifest/key_reading.hpp"

namespace zerocount::manifest {
namespace {

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

void read_stop(const yaml::Field& field, Reading& reading) {
  study::Study& study = reading.study;
  study::StoppingRule& rule = study.stop.emplace();
  rule.block = study.trials;
  // If it cannot be read, no other fault follows from that.
  if (yaml::find_field(field, "max_trials")) rule.max_trials = max_study_trials;
  read_key(field, *find_general_key("stop"), reading);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.stop.reset();
  check_order(field, rule, reading.problems);
  if (study.design != study::Design::monte_carlo) {
    reading.problems.add(field, "sequential stopping needs independently drawn trials",
                         "design: monte_carlo");
  }
  study.trials = rule.max_trials;
}

}  // namespace zerocount::manifest
