// Keys that a study cannot have together, or cannot have alone.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "experiments/manifest/manifest.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::manifest {
namespace {

/// Two keys that a study cannot have together. Notation of a key: "stop" if it is given; "design: sobol
/// saltelli" if it has one of these values; "!machines" if it is not given; "goal*" for each goal. An empty
/// list counts as not given.
struct Exclusion {
  /// The key (in the notation of the table) at whose place in the manifest the error is reported.
  std::string_view key;
  std::string_view other;
  std::string_view what;
  std::string_view expected;
};

constexpr Exclusion exclusions[]{
    {"goals", "goal", "`goal` is there too", "one of them"},
    {"goal*.band", "goal*.tolerance", "the goal has a tolerance too", "one of them"},
    {"goal*.after_profile", "goal*.within", "the goal has the time from the start of a move too",
     "one of them"},
    {"goal*.after_profile", "command.reference", "a recorded reference has no profile", "within"},
    {"goal*.machines", "!machines", "without machines no trials share a machine",
     "`machines`, the number of machines, or the key left out"},
    {"goal*", "stop", "its bounds need a number of trials that does not depend on the outcomes",
     "no `stop`, or no goal"},
    {"goal*", "design: saltelli", "its bounds need trials that share no numbers",
     "another design, or no goal"},
    {"goal*", "command.torque", "torque levels have no target", "command.targets, or no goal"},
    {"stop", "design: latin_hypercube sobol saltelli", "sequential stopping needs independently drawn trials",
     "design: monte_carlo"},
    {"stop", "conditions", "sequential stopping does not distinguish conditions",
     "a fixed number of trials, or a study without conditions"},
    {"stop", "ages", "sequential stopping does not distinguish ages",
     "a fixed number of trials, or a study without ages"},
    {"command.sequence", "conditions", "the values of ISO 230-2 do not distinguish conditions",
     "command.targets, or a study without conditions"},
    {"command.sequence", "ages", "the values of ISO 230-2 do not distinguish ages",
     "command.targets, or a study without ages"},
    {"design: saltelli", "conditions",
     "this design changes one factor at a time, but the trials of all conditions share factors",
     "monte_carlo, latin_hypercube or sobol with conditions"},
    {"design: saltelli", "ages",
     "this design changes one factor at a time, but the trials of all ages share factors",
     "monte_carlo, latin_hypercube or sobol with ages"},
    {"design: saltelli", "machines",
     "this design changes one factor at a time, but the trials of a machine share factors",
     "monte_carlo, latin_hypercube or sobol with machines"},
    {"design: saltelli", "worlds",
     "this design changes one factor at a time, but the trials of a world share factors",
     "monte_carlo, latin_hypercube or sobol with worlds"},
    {"correlation", "design: saltelli", "the design saltelli needs independent parameters", "another design"},
    {"samples", "design: saltelli", "the design saltelli needs independent parameters", "another design"},
    {"ages", "!machines", "only machines have ages: the study has none",
     "the key machines, such as machines: 100"},
    {"keep: failures statistics", "retain.trials", "retain needs every trial", "keep: trials"},
    {"keep: failures statistics", "stop", "stop needs every trial", "keep: trials"},
    {"keep: failures statistics", "command.sequence", "command.sequence needs every trial", "keep: trials"},
    {"keep: failures statistics", "design: saltelli", "design: saltelli needs every trial", "keep: trials"},
    {"keep: failures", "command.torque", "trials of torque levels have no verdict, so none fails",
     "keep: statistics or trials"},
    {"controller.plugin", "command.torque", "it has no effect: the loop is open with command.torque",
     "command.targets, reference or sequence, or the key left out"},
    {"command.units", "command.torque", "it has no effect: the loop is open with command.torque",
     "command.targets, reference or sequence, or the key left out"},
    {"command.units", "command.reference",
     "it has no effect: the record of command.reference has its own unit", "command.targets, or no units"},
    {"command.profile", "command.reference", "command.reference defines the path of the reference",
     "one of them"},
    {parameter::command::torque::levels, "command.torque.file",
     "it has no effect: command.torque.file defines the torque",
     "command.torque.file, or levels with their rate"},
    {"travel", "!axis: linear", "a rotary axis has no travel: the period of its profiles is a revolution",
     "axis: linear, or the key left out"},
};

/// The manifest, in which the two keys of an exclusion are looked up.
struct Keys {
  yaml::Field root;
  yaml::Field goal;  ///< the goal to which the key "goal*" of the table of exclusions refers

  /// The field of a key in the notation of the table of exclusions ("stop", "design: sobol", "!machines",
  /// "goal*"); empty if the manifest does not match the condition of the key.
  std::optional<yaml::Field> find(std::string_view key) const {
    const bool is_absent = key.starts_with('!');
    if (is_absent) key.remove_prefix(1);
    const std::size_t colon = std::min(key.find(": "), key.size());
    std::string_view path = key.substr(0, colon);
    constexpr std::string_view any_goal = "goal*";
    std::optional<yaml::Field> field = root;
    if (path.starts_with(any_goal)) {
      field = goal;
      path.remove_prefix(std::min(any_goal.size() + 1, path.size()));
    }
    while (field && !path.empty()) {
      const std::size_t dot = std::min(path.find('.'), path.size());
      field = yaml::find_field(*field, path.substr(0, dot));
      path.remove_prefix(std::min(dot + 1, path.size()));
    }
    const bool is_given =
        field && !(field->node->kind == yaml::YamlNode::Kind::list && field->node->items.empty()) &&
        (colon == key.size() ||
         fmt::format("{} ", key.substr(colon + 1)).find(fmt::format(" {} ", field->node->text)) !=
             std::string::npos);
    if (is_absent) return is_given ? std::nullopt : std::optional(root);
    return is_given ? field : std::nullopt;
  }
};

}  // namespace

void check_exclusions(const yaml::Field& root, yaml::Problems& problems) {
  std::vector<yaml::Field> goals;
  if (const auto goal = yaml::find_field(root, "goal")) goals.push_back(*goal);
  if (const auto several = yaml::find_field(root, "goals")) {
    for (const yaml::YamlEntry& entry : several->node->entries)
      goals.push_back(yaml::entry_of(*several, entry));
  }
  for (const Exclusion& exclusion : exclusions) {
    const bool of_goal = exclusion.key.starts_with("goal*");
    for (const yaml::Field& goal : of_goal ? goals : std::vector<yaml::Field>{root}) {
      const Keys keys{root, goal};
      const auto field = keys.find(exclusion.key);
      if (field && keys.find(exclusion.other)) problems.add(*field, exclusion.what, exclusion.expected);
    }
  }
}

}  // namespace zerocount::manifest
