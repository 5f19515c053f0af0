#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/study/rotors.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::sections {

using LoadedPlugin = std::variant<std::shared_ptr<const plugin::ControllerPlugin>, plugin::PluginFault>;

/// Finds the user's controller by the value of the key `controller.plugin`.
using PluginLoader = std::function<LoadedPlugin(const std::string& path)>;

/// For a study whose plugin is known already.
PluginLoader known_plugin(std::shared_ptr<const plugin::ControllerPlugin> plugin);

/// Reads the key `controller.plugin`: plan.plugin. @param load empty: the command loads no plugins
void read_plugin(const yaml::Field& root, const PluginLoader& load, keys::Reading& reading);

/// Reads the text of a table that a manifest names.
/// @param what "a table of samples", expected where it cannot be read
/// @throws Failure if it cannot be read
using SamplesReader = std::function<std::string(const std::string& path, std::string_view what)>;

/// Access to what a manifest names and does not contain. A key whose member is empty is refused.
struct Companions {
  PluginLoader plugin{};
  SamplesReader samples{};
  /// Profiles of a similar study. Equal ones are shared, because to realise those of thousands of machines
  /// takes longer than to read a manifest.
  std::vector<std::shared_ptr<const study::Rotors>> rotors{};
};

/// For a study whose companions are known already.
Companions known_companions(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                            std::optional<std::string> samples);

/// For a variant of the study.
Companions companions_of(const study::Study& study);

}  // namespace zerocount::sections
