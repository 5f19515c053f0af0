#pragma once

#include <optional>
#include <string>

#include "core/plugin/controller_plugin.hpp"

namespace zerocount::layout {

/// Record of the user's controller in a results file: {"name", "version", "sha256", "parameters":
/// [{"name", "unit", "meaning", "default", "lowest", "highest"}]}; null is a missing limit.
std::string plugin_as_json(const plugin::PluginDescription& plugin);

/// Nothing if the text does not describe a plugin.
std::optional<plugin::PluginDescription> plugin_from_json(const std::string& text);

}  // namespace zerocount::layout
