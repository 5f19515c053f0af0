#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/manifest/plugin_loader.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// Reads and checks a manifest.
/// @throws Failure (bad_input) whose message lists every error, one a line, as
///         `file:line:column: path: what; expected`; likewise if the file does not exist, is a directory or
///         is too large; Failure (machine_failed) if an existing file cannot be read.
/// @param load finds the user's controller by the key `controller.plugin`; empty: such a key is refused
study::Study load_study(const std::filesystem::path& manifest, const std::vector<std::string>& overrides = {},
                        const PluginLoader& load = {});

/// As load_study, from text; `source` stands for the file's name in messages.
study::Study parse_study(std::string text, std::string_view source,
                         const std::vector<std::string>& overrides = {}, const PluginLoader& load = {});

/// As above, with the defaults of the programs that wrote results files of `version`
/// (parameters/earlier_defaults.hpp).
study::Study parse_study(std::string text, std::string_view source, const std::vector<std::string>& overrides,
                         std::int64_t version, const PluginLoader& load = {});

}  // namespace zerocount::manifest
