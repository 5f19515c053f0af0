#include "experiments/manifest/stopping.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/parameters/unknown_key.hpp"

namespace zerocount::manifest {
namespace {

const std::vector<std::string> keys{"success_rate_halfwidth", "confidence", "min_trials", "max_trials"};

void require_key(const yaml::Field& map, const std::string& key, const std::string& expected,
                 yaml::Problems& problems) {
  if (yaml::find_entry(*map.node, key) != nullptr) return;
  problems.add(map.node->place, fmt::format("{}.{}", map.path, key), "the key is missing", expected);
}

void read_key(const yaml::Field& field, const std::string& key, std::int64_t max_trials,
              study::StoppingRule& rule, yaml::Problems& problems) {
  if (key == "success_rate_halfwidth") {
    rule.success_rate_halfwidth = yaml::read_real(field, {.low = 0.0, .high = 0.5}, problems).value_or(0.1);
  } else if (key == "confidence") {
    rule.confidence = yaml::read_real(field, {.low = 0.0, .high = 1.0}, problems).value_or(rule.confidence);
  } else if (key == "min_trials") {
    rule.min_trials = yaml::read_whole(field, 1, max_trials, problems).value_or(1);
  } else {
    rule.max_trials = yaml::read_whole(field, 1, max_trials, problems).value_or(max_trials);
  }
}

void check_order(const yaml::Field& map, const study::StoppingRule& rule, yaml::Problems& problems) {
  const yaml::YamlEntry* max_entry = yaml::find_entry(*map.node, "max_trials");
  const yaml::YamlEntry* min_entry = yaml::find_entry(*map.node, "min_trials");
  if (max_entry != nullptr && rule.max_trials < rule.block) {
    problems.add(max_entry->value->place, yaml::entry_of(map, *max_entry).path,
                 fmt::format("{} trials are fewer than a block, which is the {} of `trials`", rule.max_trials,
                             rule.block),
                 fmt::format("at least {}", rule.block));
  } else if (max_entry != nullptr && min_entry != nullptr && rule.min_trials > rule.max_trials) {
    problems.add(min_entry->value->place, yaml::entry_of(map, *min_entry).path,
                 fmt::format("{} trials are more than max_trials, {}", rule.min_trials, rule.max_trials),
                 fmt::format("at most {}", rule.max_trials));
  }
}

}  // namespace

void read_stop(const yaml::Field& field, std::int64_t max_trials, study::Study& study,
               yaml::Problems& problems) {
  if (!yaml::check_map(field, "stop: {success_rate_halfwidth: 0.005, max_trials: 100000}", problems)) return;
  study::StoppingRule rule;
  rule.block = study.trials;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end()) {
      parameters::add_unknown_key(field, entry, keys, problems);
    } else {
      read_key(yaml::entry_of(field, entry), entry.key, max_trials, rule, problems);
    }
  }
  require_key(field, keys[0], "half the width that the bounds of the success rate may have, 0 to 0.5",
              problems);
  require_key(field, keys[3], "the number of trials at a point at which the study ends in any case",
              problems);
  check_order(field, rule, problems);
  if (study.design != study::Design::monte_carlo) {
    problems.add(field.node->place, field.path,
                 "trials can be added one block after the other only where each is drawn by itself",
                 "design: monte_carlo");
  }
  study.stop = rule;
  study.trials = rule.max_trials;
}

}  // namespace zerocount::manifest
