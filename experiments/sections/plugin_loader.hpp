#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/keys/values.hpp"

namespace zerocount::sections {

using LoadedPlugin = std::variant<std::shared_ptr<const plugin::ControllerPlugin>, plugin::PluginFault>;

/// Finds the user's controller by the value of the key `controller.plugin`.
using PluginLoader = std::function<LoadedPlugin(const std::string& path)>;

/// For a study whose plugin is known already.
PluginLoader known_plugin(std::shared_ptr<const plugin::ControllerPlugin> plugin);

/// Reads the key `controller.plugin`: plan.plugin. @param load empty: the command loads no plugins
void read_plugin(const yaml::Field& root, const PluginLoader& load, keys::Reading& reading);

}  // namespace zerocount::sections
