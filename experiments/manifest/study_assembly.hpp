#pragma once

#include <vector>

#include "experiments/manifest/sweep.hpp"
#include "experiments/manifest/values.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// Realises the requested profiles as plan.profiles, in the order of the requests. All profiles of one
/// parameter use the same random numbers, even with different mean, spread and correlation length.
/// @param study must have its seed, design and rigs @param known profiles to be shared where they are equal
void realise_profiles(const std::vector<ProfileRequest>& requests, const study::Study& study,
                      const std::vector<std::shared_ptr<const study::Rotors>>& known, study::StudyPlan& plan);

/// Completes a study whose manifest has no errors: the random numbers of each slot, the labels of the points,
/// the axes, the input columns, the list of profiles.
void assemble_study(const std::vector<ProfileRequest>& requests, const std::vector<SweptAxis>& axes,
                    study::StudyPlan& plan, study::Study& study);

}  // namespace zerocount::manifest
