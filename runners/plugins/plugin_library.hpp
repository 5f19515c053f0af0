#pragma once

#include <filesystem>

#include "experiments/sections/companions.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::plugins {

/// Runs the starts of some trials of a study with a plugin twice, the second time in another order, and then
/// its controller alone, the trials in turns sample by sample, with states that move to other addresses.
/// Equal inputs must give equal bits.
/// @throws Failure (bad_input) if they do not: the controller keeps something outside its state. Nothing
/// happens without a plugin.
void require_no_hidden_state(const study::Study& study);

/// Loads the shared library with a user's controller. It runs code of the library: call it only with a path
/// that the user gave. The library stays loaded until the program ends.
sections::LoadedPlugin load_plugin(const std::filesystem::path& library);

}  // namespace zerocount::plugins
