#pragma once

#include "experiments/study/study.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount {

/// Newest manifest version that this program understands: the value of the key `zerocount`.
constexpr std::int64_t manifest_version = 1;

/// Fewest rigs of a study that has rigs: between one and itself nothing differs.
constexpr std::int64_t min_rigs = 2;
/// Most rigs: a rotor's random numbers have its rig as a 32-bit counter word.
constexpr std::int64_t max_rigs = std::int64_t{1} << 32;

/// Understands the manifest `root`: everything of a Study but its text, overrides and hashes. What is wrong
/// goes to `problems`; where there is any, the study is not to be used.
/// @param version of the results files whose defaults stand for what the manifest leaves out.
Study read_manifest(const YamlNode& root, std::int64_t version, Problems& problems);

}  // namespace zerocount
