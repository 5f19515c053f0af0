#pragma once

#include "experiments/keys/values.hpp"
#include "experiments/sections/companions.hpp"
#include "experiments/sections/joint_draws.hpp"
#include "experiments/sections/sweep.hpp"
#include "experiments/study/study_fwd.hpp"
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
/// @param study must have its seed, design and rigs @param known profiles to be shared where they are equal
void realise_profiles(const std::vector<keys::ProfileRequest>& requests, const study::Study& study,
                      const std::vector<std::shared_ptr<const study::Rotors>>& known, study::StudyPlan& plan);

/// Completes a study whose manifest has no errors: the random numbers of each slot, the labels of the points,
/// the axes, the input columns, the list of profiles.
void assemble_study(const std::vector<keys::ProfileRequest>& requests,
                    const std::vector<sections::SweptAxis>& axes, study::StudyPlan& plan,
                    study::Study& study);

}  // namespace zerocount::manifest
