#pragma once

#include <string>

#include "core/theory/sampled_stability.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::commands {

/// The lines of `check` on the hunting that theory predicts of this trial; empty where it says nothing.
std::string hunting_lines(const trial::TrialParameters& trial, const theory::LinearDrive& drive);

}  // namespace zerocount::commands
