#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runners/tuning/effects/effect_runs.hpp"

namespace zerocount::tuning {

/// The causes of failures that a trial of the point can have, each to be switched off:
///
///   - each parameter that has not its ideal value (parameters::Ideal)
///   - friction that varies along the track, or from contact to contact; each spectrum of the disturbance
///   - what several values idealise: a rigid axis, no constant disturbance, a finer converter, a wider torque
///     range, a finer encoder, twice the sample rate
std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point);

/// The sections of manifests with parameters that have no ideal value: other values of these are not tried.
std::vector<std::string> sections_with_other_values();

}  // namespace zerocount::tuning
