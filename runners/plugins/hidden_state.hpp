#pragma once

#include "experiments/study/study_fwd.hpp"

namespace zerocount::plugins {

/// Runs the starts of some trials of a study with a plugin twice, the second time in another order, and then
/// its controller alone, the trials in turns sample by sample, with states that move to other addresses.
/// Equal inputs must give equal bits.
/// @throws Failure (bad_input) if they do not: the controller keeps something outside its state. Nothing
/// happens without a plugin.
void require_no_hidden_state(const study::Study& study);

}  // namespace zerocount::plugins
