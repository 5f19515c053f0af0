#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::sections {
namespace {

struct Observation {
  std::string text;
  std::optional<study::ObservedCounts> counts;
};

Observation observation_in(const yaml::Field& field, bool open_loop, yaml::Problems& problems) {
  if (field.node->kind == yaml::YamlNode::Kind::scalar) return {field.node->text, std::nullopt};
  if (open_loop) problems.add(field, "an open-loop study has no successes to compare with", "a text");
  const yaml::Field successes = yaml::find_field(field, "successes").value();
  const study::ObservedCounts counts{shapes::whole_of(successes),
                                     shapes::whole_of(yaml::find_field(field, "of").value())};
  if (counts.successes > counts.of)
    problems.add(successes, fmt::format("'{}' is out of range", counts.successes),
                 fmt::format("a whole number from 0 to {}", counts.of));
  std::string text = fmt::format("{} of {} succeeded", counts.successes, counts.of);
  if (const auto more = yaml::find_field(field, "text")) text += "; " + more->node->text;
  return {std::move(text), counts};
}

void record(study::Study& study, const std::string& label, const Observation& observation) {
  study.observed[label] = observation.text;
  if (observation.counts) study.observed_counts[label] = *observation.counts;
}

}  // namespace

void read_observations(const yaml::Field& field, const std::vector<SweptAxis>& axes,
                       keys::StudyDraft& draft) {
  yaml::Problems& problems = draft.problems;
  if (!shapes::read(field, keys::shape_of("observed"), problems)) return;
  const std::vector<std::string> labels = label_points(axes);
  const bool has_cases = !axes.empty() && axes.front().cases;
  const std::vector<std::string> cases = has_cases ? axes.front().labels : std::vector<std::string>{};
  std::vector<std::string> known = cases;
  known.insert(known.end(), labels.begin(), labels.end());
  std::map<std::string, Observation> found;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    found[entry.key] = observation_in(yaml::entry_of(field, entry), draft.plan.open_loop, problems);
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
    if (observation != found.end()) record(draft.study, labels[point], observation->second);
  }
}

}  // namespace zerocount::sections
