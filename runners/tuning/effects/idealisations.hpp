#pragma once

#include <cstdint>
#include <vector>

#include "runners/tuning/effects/effect.hpp"

namespace zerocount::tuning {

/// The causes of failures that a trial of the point can have, each to be switched off.
std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point);

}  // namespace zerocount::tuning
