#pragma once

#include <optional>
#include <span>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/sections/companions.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Converts the manifest `root` to a Study, without its text, overrides and hashes. Errors are added to
/// `problems`; with errors the study must not be used.
/// @param recorded the study has results (Reading::recorded)
/// @param samples inserted in `root` before, or null
study::Study read_manifest(const yaml::YamlNode& root, bool recorded, const sections::Companions& companions,
                           const sections::SamplesTable* samples, yaml::Problems& problems);

/// Realises the requested profiles as plan.profiles, in the order of the requests. All profiles of one
/// parameter use the same random numbers, even with different mean, spread and correlation length.
/// @param study must have its seed, design and machines @param known profiles to be shared where they are
/// equal
void realise_profiles(const std::vector<keys::ProfileRequest>& requests, const study::Study& study,
                      const std::vector<std::shared_ptr<const study::Rotors>>& known, study::StudyPlan& plan);

/// Completes a study whose manifest has no errors: the random numbers of each slot, the labels of the points,
/// the axes, the input columns, the list of profiles.
void assemble_study(const std::vector<keys::ProfileRequest>& requests,
                    const std::vector<sections::SweptAxis>& axes, study::StudyPlan& plan,
                    study::Study& study);

/// Reports keys that a study cannot have together, by the table of them.
void check_exclusions(const yaml::Field& root, yaml::Problems& problems);

/// Checks that involve several parameters, at every design point and for all values that can be drawn: values
/// must be consistent (value_rules.hpp), every given key must have an effect at some point
/// (value_rules.hpp), and required values must be given. A problem is reported at the
/// place of a swept value, if one is involved.
void check_points(const keys::PlanPlaces& places, keys::Reading& reading);

/// Reports values that can leave their range at some age, by the ends of what is drawn.
void check_ages(const keys::PlanPlaces& places, keys::Reading& reading);

/// Whether the manifest gives the slot a value at every point.
bool is_given_everywhere(const keys::PlanPlaces& places, const study::StudyPlan& plan, std::size_t slot);

/// Place in the manifest of the slot's value: outside the sweep, or the first one in it. Nothing if the
/// manifest does not give it.
std::optional<yaml::Place> given_place(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                                       std::size_t slot);

struct FaultPlace {
  yaml::Place place;
  std::size_t slot{0};  ///< whose value is there
};

/// Place in the manifest of one of the values that a fault at a design point involves, or from which they
/// follow: a swept one, otherwise one that the manifest gives, otherwise the first.
FaultPlace place_of_fault(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                          std::span<const std::size_t> involved, std::size_t point);

/// Lets the parameters that follow from measured ones (parameters/measured_parameters.hpp) do so, where the
/// study gives the measured ones. Reports a group that is not complete, and one beside parameters that follow
/// from it. Must come after all values are read.
void let_follow_from_measured(const keys::PlanPlaces& places, keys::Reading& reading);

/// Reports measured values from which nothing allowed follows.
void check_what_follows(const keys::PlanPlaces& places, keys::Reading& reading);

/// Reports draws of measured values that are those of no machine (study/measured_machines.hpp): of each
/// trial, machine or world of the assembled study, and of all values between the ends of `tune`'s ranges.
void check_measured_machines(const study::Study& study, const keys::PlanPlaces& places,
                             keys::Reading& reading);

/// Checks that the encoder sees each commanded motion of the assembled study. The loop does not notice a
/// motion of less than a count, and its move would be perfect: a target in SI units that lies on the same
/// count as the position before it, or a sine reference of less than half a count.
///
/// Such a motion in all trials of a design point is an error (a warning if the study was recorded earlier);
/// in some of them it is a warning with their proportion.
void check_unseen_motions(const study::Study& study, const keys::PlanPlaces& places, keys::Reading& reading);

}  // namespace zerocount::manifest
