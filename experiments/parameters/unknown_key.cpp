#include "experiments/parameters/unknown_key.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::parameters {
namespace {

// The last name of a dotted path.
std::string_view last_name(std::string_view path) {
  return path.substr(path.rfind('.') + 1);
}

// The parameter or section whose last name is `key`; empty if there is none.
std::string_view same_name_elsewhere(std::string_view key) {
  for (const Parameter& parameter : parameter_table()) {
    if (last_name(parameter.name) == key) return parameter.name;
  }
  for (const Parameter& parameter : parameter_table()) {
    const std::string_view map = parameter.name.substr(0, parameter.name.rfind('.'));
    if (last_name(map) == key) return map;
  }
  return {};
}

// Other usual names, as data sheets and drives have them: of a key anywhere, or of a path.
constexpr std::array<std::pair<std::string_view, std::string_view>, 25> synonyms{
    {{"mass", "plant.inertia"},
     {"moment_of_inertia", "plant.inertia"},
     {"full_scale", "dac.range"},
     {"torque_limit", "amplifier.limit"},
     {"force_limit", "amplifier.limit"},
     {"current_limit", "amplifier.limit"},
     {"dac.limit", "amplifier.limit"},
     {"viscous", "plant.sliding_damping"},
     {"plant.damping", "plant.sliding_damping"},
     {"stiction", "friction.breakaway"},
     {"dead_time", "controller.delay"},
     {"latency", "controller.delay"},
     {"notch", "controller.filters"},
     {"lowpass", "controller.filters"},
     {"gear", "plant.load"},
     {"backlash", "plant.load.gap"},
     {"gravity", "disturbance.load.ripple"},
     {"lsb", "encoder.fine"},
     {"inc", "encoder.fine"},
     {"encoder.motor", "encoder.fine"},
     {"controller.position", "controller.cascade"},
     {"controller.velocity", "controller.cascade"},
     {"Tn", "controller.cascade.ki"},
     {"goal.overshoot", "goal.limits"},
     {"settle_after_profile", "goal.after_profile"}}};

std::string_view named_otherwise(std::string_view key, std::string_view path) {
  const auto found = std::find_if(synonyms.begin(), synonyms.end(),
                                  [&](const auto& pair) { return pair.first == key || pair.first == path; });
  return found == synonyms.end() ? std::string_view{} : found->second;
}

// Keys that had another name before version 0.2, by their path.
constexpr std::array<std::pair<std::string_view, std::string_view>, 1> renamed_keys{{{"rigs", "machines"}}};

// A typing error in this map is more likely than a key of another map.
std::string_view nearest_key(std::string_view key, std::string_view path,
                             std::span<const std::string> known) {
  if (const std::string_view name = named_otherwise(key, path); !name.empty()) return name;
  const std::string_view here = yaml::nearest_name(key, known);
  const std::string_view elsewhere = same_name_elsewhere(key);
  return elsewhere.empty() || yaml::is_near(key, here) ? here : elsewhere;
}

}  // namespace

void check_keys(const yaml::Field& map, std::span<const std::string> known, yaml::Problems& problems) {
  for (const yaml::YamlEntry& entry : map.node->entries) {
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      add_unknown_key(map, entry, known, problems);
  }
}

void add_unknown_key(const yaml::Field& map, const yaml::YamlEntry& entry, std::span<const std::string> known,
                     yaml::Problems& problems) {
  const std::string path = yaml::entry_of(map, entry).path;
  if (entry.key.find('.') != std::string::npos && find_parameter(path)) {
    problems.add(entry.place, path, "found a dotted path instead of a key",
                 fmt::format("nested maps, as in {}: {{{}: ...}}", entry.key.substr(0, entry.key.find('.')),
                             entry.key.substr(entry.key.find('.') + 1)));
    return;
  }
  const auto renamed =
      std::ranges::find(renamed_keys, path, &std::pair<std::string_view, std::string_view>::first);
  if (renamed != renamed_keys.end()) {
    problems.add(entry.place, path, fmt::format("it is called {} since 0.2", renamed->second),
                 fmt::format("{}: …", renamed->second));
    return;
  }
  const std::string_view nearest = nearest_key(entry.key, path, known);
  const std::string what =
      nearest.empty() ? "unknown key" : fmt::format("unknown key, nearest known: {}", nearest);
  constexpr std::size_t max_listed = 32;
  const std::string expected =
      known.size() <= max_listed
          ? fmt::format("one of {}", fmt::join(known, ", "))
          : std::string("a dotted path of the table of parameters, such as controller.ki");
  problems.add(entry.place, path, what, expected);
}

}  // namespace zerocount::parameters
