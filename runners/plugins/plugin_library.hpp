#pragma once

#include <filesystem>

#include "experiments/sections/external_inputs.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::plugins {

/// Checks that the controller plugin of a study keeps nothing between samples outside the state that the
/// program gives it. Does nothing without a plugin.
///
/// The beginnings of some trials run twice, the second time in another order. Then the controller runs alone:
/// the trials take turns sample by sample, and their states move to other addresses. Equal inputs must give
/// equal bits.
/// @throws Failure (bad_input) if they do not
void require_no_hidden_state(const study::Study& study);

/// Loads a shared library with a user's controller. Loading runs code of the library, so this must be called
/// only with a path that the user gave. The library stays loaded until the program ends.
sections::LoadedPlugin load_plugin(const std::filesystem::path& library);

}  // namespace zerocount::plugins
