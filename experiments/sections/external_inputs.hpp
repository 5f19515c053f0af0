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

/// Function that loads the user's controller (plugin) from the path in the key `controller.plugin`.
using PluginLoader = std::function<LoadedPlugin(const std::string& path)>;

/// A loader for a study whose plugin (the user's controller) is known already: it returns this plugin for
/// every path.
PluginLoader known_plugin(std::shared_ptr<const plugin::ControllerPlugin> plugin);

/// Reads the key `controller.plugin` into plan.plugin.
/// @param load empty: the command does not load plugins
void read_plugin(const yaml::Field& root, const PluginLoader& load, keys::StudyDraft& draft);

/// Function that reads the text of a table that a manifest names.
/// @param what phrase for the message if the file cannot be read, "a table of samples"
/// @throws Failure if the file cannot be read
using SamplesReader = std::function<std::string(const std::string& path, std::string_view what)>;

/// Access to files and plugins that a manifest names. If a member is empty, the corresponding key is refused.
struct ExternalInputs {
  PluginLoader plugin{};
  SamplesReader samples{};
  /// Drawn friction profiles of a similar study. Profiles that are equal are shared, because realising the
  /// profiles of thousands of machines takes longer than reading a manifest.
  std::vector<std::shared_ptr<const study::Rotors>> rotors{};
};

/// ExternalInputs of a study whose plugin and table of samples are known already.
ExternalInputs known_external_inputs(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                                     std::optional<std::string> samples);

/// The files and plugins for a variant of the study's manifest: the study's plugin, table of samples and
/// drawn friction profiles.
ExternalInputs external_inputs_of(const study::Study& study);

}  // namespace zerocount::sections
