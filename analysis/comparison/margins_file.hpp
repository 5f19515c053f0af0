#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "analysis/comparison/gate_rules.hpp"

namespace zerocount::comparison {

/// Reads the YAML file of margins and requirements (its language: README.md of this folder).
/// @param labels of the design points that are compared, which the file may name
/// @throws Failure (bad_input) with every mistake, one a line, as `file:line:column: path: what; expected`;
/// also where there is no such file
GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels);

/// As read_gate_rules, from text; `source` stands for the file's name in messages.
GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels);

}  // namespace zerocount::comparison
