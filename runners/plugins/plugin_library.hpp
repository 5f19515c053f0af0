#pragma once

#include <filesystem>

#include "experiments/sections/plugin_loader.hpp"

namespace zerocount::plugins {

/// Loads the shared library with a user's controller. It runs code of the library: call it only with a path
/// that the user gave. The library stays loaded until the program ends.
sections::LoadedPlugin load_plugin(const std::filesystem::path& library);

}  // namespace zerocount::plugins
