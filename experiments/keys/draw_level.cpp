#include "experiments/keys/values.hpp"
#include "experiments/parameters/measured_parameters.hpp"

namespace zerocount::keys {
namespace {

struct Misfit {
  std::string_view what;
  std::string_view expected;
};

constexpr Misfit profile_of_rotor{"a profile belongs to a rotor, which trials share",
                                  "study or machine (for a rotor per trial: as many machines as trials)"};
constexpr Misfit no_worlds{"the study has no worlds",
                           "the key worlds, or study, machine, trial or contact here"};

// The reason if the parameter cannot be drawn this often.
std::optional<Misfit> misfit_of(study::DrawLevel level, const parameters::Parameter& parameter, Drawn drawn,
                                const TrialGroups& groups) {
  if (drawn == Drawn::interval && level != study::DrawLevel::world) {
    return Misfit{"an interval has no distribution to draw from", "world, or uniform in place of interval"};
  }
  switch (level) {
    case study::DrawLevel::study:
      return std::nullopt;
    case study::DrawLevel::world:
      if (drawn == Drawn::profile) return profile_of_rotor;
      return groups.worlds ? std::nullopt : std::optional(no_worlds);
    case study::DrawLevel::machine:
      if (groups.machines) return std::nullopt;
      return Misfit{"the study has no machines", "the key machines, or study, trial or contact here"};
    case study::DrawLevel::trial:
      if (drawn == Drawn::value) return std::nullopt;
      return profile_of_rotor;
    case study::DrawLevel::contact:
      if (drawn == Drawn::profile) {
        return Misfit{"a profile belongs to a rotor; a contact takes the value at its position",
                      "study or machine"};
      }
      if (parameter.profiled != nullptr || parameters::is_measured(parameter.name)) return std::nullopt;
      return Misfit{"only friction can be drawn at each contact", "study, machine or trial"};
  }
  return std::nullopt;
}

}  // namespace

study::DrawLevel usual_level(const parameters::Parameter& parameter, Drawn drawn, const TrialGroups& groups) {
  switch (drawn) {
    case Drawn::interval:
      return study::DrawLevel::world;
    case Drawn::profile:
      return groups.machines && parameter.of_machine ? study::DrawLevel::machine : study::DrawLevel::study;
    case Drawn::value:
      break;
  }
  return groups.machines && parameter.of_machine ? study::DrawLevel::machine : study::DrawLevel::trial;
}

std::optional<study::DrawLevel> read_draw_level(const yaml::Field& field,
                                                const parameters::Parameter& parameter, Drawn drawn,
                                                const TrialGroups& groups, yaml::Problems& problems) {
  if (field.node->kind == yaml::YamlNode::Kind::scalar && field.node->text == "rig") {
    problems.add(field, "it is called machine since 0.2", "machine");
    return std::nullopt;
  }
  const auto label = yaml::read_label(field, draw_level_labels, problems);
  if (!label) return std::nullopt;
  const auto level = static_cast<study::DrawLevel>(*label);
  const auto misfit = misfit_of(level, parameter, drawn, groups);
  if (!misfit) return level;
  problems.add(field, std::string(misfit->what), misfit->expected);
  return std::nullopt;
}

}  // namespace zerocount::keys
