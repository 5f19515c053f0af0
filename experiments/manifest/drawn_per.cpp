#include "experiments/manifest/drawn_per.hpp"

namespace zerocount::manifest {
namespace {

struct Misfit {
  std::string_view what;
  std::string_view expected;
};

// The reason if the parameter cannot be drawn this often.
std::optional<Misfit> misfit_of(study::Per per, const parameters::Parameter& parameter, Drawn drawn,
                                bool has_rigs) {
  switch (per) {
    case study::Per::study:
      return std::nullopt;
    case study::Per::rig:
      if (has_rigs) return std::nullopt;
      return Misfit{"the study has no rigs", "the key rigs, or study, trial or contact here"};
    case study::Per::trial:
      if (drawn == Drawn::value) return std::nullopt;
      return Misfit{"a profile belongs to a rotor, which trials share",
                    "study or rig (for a rotor per trial: as many rigs as trials)"};
    case study::Per::contact:
      if (drawn == Drawn::profile) {
        return Misfit{"a profile belongs to a rotor; a contact takes the value at its position",
                      "study or rig"};
      }
      if (parameter.profiled != nullptr) return std::nullopt;
      return Misfit{"only friction can be drawn at each contact", "study, rig or trial"};
  }
  return std::nullopt;
}

}  // namespace

study::Per usual_per(const parameters::Parameter& parameter, Drawn drawn, bool has_rigs) {
  if (!has_rigs) return drawn == Drawn::profile ? study::Per::study : study::Per::trial;
  return parameter.of_machine ? study::Per::rig : study::Per::trial;
}

std::optional<study::Per> read_per(const yaml::Field& field, const parameters::Parameter& parameter,
                                   Drawn drawn, bool has_rigs, yaml::Problems& problems) {
  const auto label = yaml::read_label(field, per_labels, problems);
  if (!label) return std::nullopt;
  const auto per = static_cast<study::Per>(*label);
  const auto misfit = misfit_of(per, parameter, drawn, has_rigs);
  if (!misfit) return per;
  problems.add(field, std::string(misfit->what), misfit->expected);
  return std::nullopt;
}

}  // namespace zerocount::manifest
