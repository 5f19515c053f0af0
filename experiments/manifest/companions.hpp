#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "experiments/manifest/plugin_loader.hpp"

namespace zerocount::manifest {

/// Reads the text of the file that the key `samples` names.
/// @throws Failure if it cannot be read
using SamplesReader = std::function<std::string(const std::string& path)>;

/// Access to what a manifest names and does not contain. An empty member: such a key is refused.
struct Companions {
  PluginLoader plugin{};
  SamplesReader samples{};
};

/// For a study whose companions are known already.
Companions known_companions(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                            std::optional<std::string> samples);

}  // namespace zerocount::manifest
