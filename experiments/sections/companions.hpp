#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/sections/plugin_loader.hpp"
#include "experiments/study/rotors.hpp"
#include "experiments/study/study_fwd.hpp"

namespace zerocount::sections {

/// Reads the text of a table that a manifest names.
/// @param what "a table of samples", expected where it cannot be read
/// @throws Failure if it cannot be read
using SamplesReader = std::function<std::string(const std::string& path, std::string_view what)>;

/// Access to what a manifest names and does not contain. A key whose member is empty is refused.
struct Companions {
  PluginLoader plugin{};
  SamplesReader samples{};
  /// Profiles of a similar study. Equal ones are shared, because to realise those of thousands of rigs takes
  /// longer than to read a manifest.
  std::vector<std::shared_ptr<const study::Rotors>> rotors{};
};

/// For a study whose companions are known already.
Companions known_companions(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                            std::optional<std::string> samples);

/// For a variant of the study.
Companions companions_of(const study::Study& study);

}  // namespace zerocount::sections
