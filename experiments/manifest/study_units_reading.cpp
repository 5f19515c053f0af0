#include "experiments/manifest/study_units_reading.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace zerocount {
namespace {

// The number of the word in `field`, or 0 once it is reported that there is none of them.
std::size_t read_one_of(const Field& field, std::span<const std::string_view> words, Problems& problems) {
  const auto word = std::find(words.begin(), words.end(), field.node->text);
  if (field.node->kind == YamlNode::Kind::scalar && word != words.end()) {
    return static_cast<std::size_t>(word - words.begin());
  }
  problems.add(field.node->place, field.path,
               fmt::format("{} is none of its words", in_quotes(flow_text(*field.node))),
               fmt::format("one of {}", fmt::join(words, ", ")));
  return 0;
}

std::optional<Field> find_within(const Field& map, std::string_view key) {
  if (map.node->kind != YamlNode::Kind::map) return std::nullopt;
  const YamlEntry* entry = find_entry(*map.node, key);
  if (entry == nullptr) return std::nullopt;
  return entry_of(map, *entry);
}

}  // namespace

void read_study_units(const Field& root, Reading& reading) {
  StudyPlan& plan = reading.plan;
  if (const auto axis = find_within(root, "axis")) {
    plan.units.axis = static_cast<AxisKind>(read_one_of(*axis, axis_labels(), reading.problems));
  }
  const bool linear = plan.units.axis == AxisKind::linear;
  if (linear) plan.period.reset();
  if (const auto travel = find_within(root, "travel")) {
    const auto length = read_real(*travel, above(0), reading.problems);
    if (linear) {
      plan.period = length;
    } else {
      reading.problems.add(travel->node->place, travel->path,
                           "a rotary axis has no travel: what varies along it has the period of a revolution",
                           "axis: linear, or the key left out");
    }
  }
  const auto controller = find_within(root, "controller");
  const auto gains = controller ? find_within(*controller, "units") : std::nullopt;
  if (gains)
    plan.units.gains = static_cast<GainUnits>(read_one_of(*gains, gain_unit_labels(), reading.problems));
}

void check_travel(const Field& root, Reading& reading) {
  const auto travel = find_within(root, "travel");
  if (!travel || !reading.profiles.empty() || reading.plan.units.axis == AxisKind::rotary) return;
  reading.warnings.push_back(at_place(travel->node->place, travel->path,
                                      "it has no effect: no parameter of friction is a profile along it"));
}

}  // namespace zerocount
