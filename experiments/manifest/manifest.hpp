#pragma once

#include <optional>
#include <span>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/sections/external_inputs.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Converts the manifest `root` to a Study, without its text, overrides and hashes. Errors are added to
/// `problems`; with errors the study must not be used.
/// @param recorded the study has results (StudyDraft::recorded)
/// @param samples table of samples that was inserted in `root` before; null if there is none
study::Study read_manifest(const yaml::YamlNode& root, bool recorded,
                           const sections::ExternalInputs& external, const sections::SamplesTable* samples,
                           yaml::Problems& problems);

/// Draws the friction parameters that vary along the axis, as `requests` describe them, and stores them as
/// plan.profiles in the same order. All profiles of one parameter use the same random numbers, even with
/// different mean, spread and correlation length.
/// @param study study whose seed, design and machines are set
/// @param known profiles of another study, which are shared if they are equal
void realise_profiles(const std::vector<keys::ProfileRequest>& requests, const study::Study& study,
                      const std::vector<std::shared_ptr<const study::Rotors>>& known, study::StudyPlan& plan);

/// Completes a study whose manifest has no errors: the random numbers of each slot (one value of a trial),
/// the labels of the design points, the axes of the sweep, the columns of the inputs, the list of profiles.
void assemble_study(const std::vector<keys::ProfileRequest>& requests,
                    const std::vector<sections::SweptAxis>& axes, study::StudyPlan& plan,
                    study::Study& study);

/// Reports pairs of keys that a study cannot have together, as the table of exclusions lists them.
void check_exclusions(const yaml::Field& root, yaml::Problems& problems);

/// Checks that involve several parameters, at every design point and for all values that can be drawn: values
/// must be consistent (value_rules.hpp), every given key must have an effect at some point (value_rules.hpp),
/// and required values must be given. A problem is reported at the place of a swept value, if one is
/// involved.
void check_points(const keys::PlanPlaces& places, keys::StudyDraft& draft);

/// Reports values that can leave the range of their parameter at some age of the study. Only the extremes of
/// what can be drawn are checked.
void check_ages(const keys::PlanPlaces& places, keys::StudyDraft& draft);

/// Whether the manifest gives a value for the slot (one parameter of the plan) at every design point.
bool is_given_everywhere(const keys::PlanPlaces& places, const study::StudyPlan& plan, std::size_t slot);

/// Place in the manifest of the value of the slot (one parameter of the plan): outside the sweep, or else the
/// first one in the sweep. Empty if the manifest does not give the value.
std::optional<yaml::Place> given_place(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                                       std::size_t slot);

/// A place in the manifest to which a fault is attributed.
struct FaultPlace {
  yaml::Place place;
  std::size_t slot{0};  ///< slot (index in the plan) of the value at this place
};

/// Place in the manifest of one of the values that a fault at a design point involves, or of a source from
/// which one of them follows. A swept value is preferred, then a value that the manifest gives, then the
/// first value.
FaultPlace place_of_fault(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                          std::span<const std::size_t> involved, std::size_t point);

/// If the study gives measured parameters, such as a measured stiffness, makes the friction parameters that
/// follow from them derived values (parameters/measured_parameters.hpp). Reports an incomplete group of
/// measured parameters, and a group given together with parameters that follow from it. All values must be
/// read already.
void let_follow_from_measured(const keys::PlanPlaces& places, keys::StudyDraft& draft);

/// Reports measured values from which no allowed value of the friction parameters follows.
void check_what_follows(const keys::PlanPlaces& places, keys::StudyDraft& draft);

/// Reports measured values that no machine can have (study/measured_machines.hpp). Checks the draws of each
/// trial, machine or world of the assembled study, and all values between the ends of the ranges of `tune`.
void check_measured_machines(const study::Study& study, const keys::PlanPlaces& places,
                             keys::StudyDraft& draft);

/// Checks that the encoder sees each commanded motion of the assembled study. The loop does not notice a
/// motion of less than a count, and its move would be perfect: a target in SI units that lies on the same
/// count as the position before it, or a sine reference of less than half a count.
///
/// Such a motion in all trials of a design point is an error (a warning if the study was recorded earlier);
/// in some of them it is a warning with their proportion.
void check_unseen_motions(const study::Study& study, const keys::PlanPlaces& places, keys::StudyDraft& draft);

}  // namespace zerocount::manifest
