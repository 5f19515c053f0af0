#include "experiments/sections/observations.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "experiments/parameters/unknown_key.hpp"
#include "experiments/yaml/nearest_name.hpp"

namespace zerocount::sections {
namespace {

constexpr const char* counts_form = "a text, or counts: {successes: 9, of: 10}";

struct Observation {
  std::string text;
  std::optional<study::ObservedCounts> counts;
};

std::optional<std::int64_t> read_count(const yaml::Field& counts, std::string_view key, std::int64_t low,
                                       std::int64_t high, yaml::Problems& problems) {
  const auto field = yaml::find_field(counts, key);
  if (field) return yaml::read_whole(*field, low, high, problems);
  problems.add(counts, fmt::format("the key '{}' is missing", key), counts_form);
  return std::nullopt;
}

Observation read_counts(const yaml::Field& field, bool open_loop, yaml::Problems& problems) {
  parameters::check_keys(field, std::vector<std::string>{"successes", "of", "text"}, problems);
  if (open_loop) problems.add(field, "an open-loop study has no successes to compare with", "a text");
  const auto of = read_count(field, "of", 1, max_observed_trials, problems);
  const auto successes = read_count(field, "successes", 0, of.value_or(max_observed_trials), problems);
  if (!of || !successes) return {};
  Observation observation{fmt::format("{} of {} succeeded", *successes, *of),
                          study::ObservedCounts{*successes, *of}};
  if (const auto text = yaml::find_field(field, "text"))
    observation.text += "; " + yaml::read_text(*text, problems).value_or("");
  return observation;
}

Observation read_observation(const yaml::Field& field, bool open_loop, yaml::Problems& problems) {
  if (field.node->kind == yaml::YamlNode::Kind::map) return read_counts(field, open_loop, problems);
  return {yaml::read_text(field, problems).value_or(""), std::nullopt};
}

void record(study::Study& study, const std::string& label, const Observation& observation) {
  study.observed[label] = observation.text;
  if (observation.counts) study.observed_counts[label] = *observation.counts;
}

}  // namespace

void read_observations(const yaml::Field& field, const std::vector<SweptAxis>& axes, keys::Reading& reading) {
  yaml::Problems& problems = reading.problems;
  if (!yaml::check_map(field, "a map from cases or point labels to observations", problems)) return;
  const std::vector<std::string> labels = label_points(axes);
  const bool has_cases = !axes.empty() && axes.front().cases;
  const std::vector<std::string> cases = has_cases ? axes.front().labels : std::vector<std::string>{};
  std::vector<std::string> known = cases;
  known.insert(known.end(), labels.begin(), labels.end());
  std::map<std::string, Observation> found;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    found[entry.key] = read_observation(yaml::entry_of(field, entry), reading.plan.open_loop, problems);
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    problems.add(
        entry.place, yaml::entry_of(field, entry).path,
        fmt::format("unknown case or point label, nearest known: {}", yaml::nearest_name(entry.key, known)),
        "the name of a case or the label of a point");
  }
  for (std::size_t point = 0; point < labels.size(); ++point) {
    auto observation = found.find(labels[point]);
    if (observation == found.end() && !cases.empty())
      observation = found.find(cases[point / (labels.size() / cases.size())]);
    if (observation != found.end()) record(reading.study, labels[point], observation->second);
  }
}

}  // namespace zerocount::sections
