#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/sections/external_inputs.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// Reads and checks a manifest.
/// @throws Failure (bad_input) whose message lists every error, one per line, as
///         `file:line:column: path: what; expected`; Failure (bad_input) if the file does not exist, is a
///         directory or is too large; Failure (machine_failed) if an existing file cannot be read
/// @param external access to the files of the keys `controller.plugin` and `samples`
study::Study load_study(const std::filesystem::path& manifest, const std::vector<std::string>& overrides = {},
                        const sections::ExternalInputs& external = {});

/// Checks a manifest given as text, as load_study() does.
/// @param source name of the text in messages
study::Study new_study(std::string text, std::string_view source, const std::vector<std::string>& overrides,
                       const sections::ExternalInputs& external = {});

/// Checks the manifest of a study that exists already. Unlike in new_study(), overrides without effect are
/// allowed.
study::Study parse_study(std::string text, std::string_view source,
                         const std::vector<std::string>& overrides = {},
                         const sections::ExternalInputs& external = {});

/// Checks the manifest of a study that has results. Unlike in parse_study(), a target that the encoder does
/// not see is only a warning.
study::Study recorded_study(std::string text, std::string_view source,
                            const std::vector<std::string>& overrides,
                            const sections::ExternalInputs& external = {});

}  // namespace zerocount::manifest
