#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/keys/draw_level.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_fwd.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::keys {

/// A profile in the manifest, to be realised when the seed is known.
struct ProfileRequest {
  std::size_t slot{0};  ///< in the plan
  distributions::ProfileForm form;
  study::DrawLevel level{study::DrawLevel::study};  ///< study or rig
  yaml::Place place;                                ///< in the manifest, for messages
  std::string path;
};

/// The data that reading a manifest produces.
struct Reading {
  yaml::Problems& problems;
  study::StudyPlan& plan;  ///< gets the distributions
  study::Study& study;
  bool recorded{false};       ///< it has results: a target that the encoder does not see is a warning
  TrialGroups groups{};       ///< the study has the keys `rigs`, `worlds`
  bool plugin_failed{false};  ///< the user's controller could not be loaded
  std::vector<ProfileRequest> profiles{};  ///< [index of a value of kind profile]
  std::vector<std::string> warnings{};     ///< allowed but possibly unintended
  /// The value of the slot of its rate, if the value read last changes with age. Whoever takes that value
  /// takes the rate as well, and resets it.
  std::optional<study::Assignment> rate{};
};

/// Places of a plan's values in the manifest.
struct PlanPlaces {
  std::vector<yaml::Place> base;               ///< [slot]; for a default the manifest's first line
  std::vector<bool> written;                   ///< [slot] whether the base value is written in the manifest
  std::vector<std::vector<yaml::Place>> axes;  ///< [axis][assignment]
  yaml::Place record{};                        ///< of command.torque.file or command.reference.file
};

/// Reports realised profiles that leave the range of their parameter somewhere on a rotor.
void check_profiles(const Reading& reading);

/// Represents a value that could not be read: NaN, so that later checks ignore it.
study::Value unreadable_value();

/// The value of the parameter of the slot: a number, a label, a distribution or a profile, checked against
/// the parameter's range. Reports errors and returns unreadable_value() then. Sets or resets Reading::rate.
study::Value read_value(const yaml::Field& field, std::size_t slot, Reading& reading);

/// `number` as a value of the parameter, checked as read_value() does; `field` is its source.
study::Value checked_number(const yaml::Field& field, std::size_t slot, double number, Reading& reading);

}  // namespace zerocount::keys
