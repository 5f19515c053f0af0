#pragma once

#include "experiments/manifest/companions.hpp"
#include "experiments/manifest/samples.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Newest manifest version that this program supports: the value of the key `zerocount`.
constexpr std::int64_t manifest_version = 1;

/// Minimum number of rigs: differences between rigs need at least two.
constexpr std::int64_t min_rigs = 2;
/// Maximum number of rigs: the rig is a 32-bit counter word of a rotor's random numbers.
constexpr std::int64_t max_rigs = std::int64_t{1} << 32;

/// Numbers of worlds: a goal is judged in each, with a part of the error probability.
constexpr std::int64_t min_worlds = 2;
constexpr std::int64_t max_worlds = 10'000;

/// Converts the manifest `root` to a Study, without its text, overrides and hashes. Errors are added to
/// `problems`; with errors the study must not be used.
/// @param version of the results files whose defaults apply
/// @param samples inserted in `root` before, or null
study::Study read_manifest(const yaml::YamlNode& root, std::int64_t version, const Companions& companions,
                           const SamplesTable* samples, yaml::Problems& problems);

}  // namespace zerocount::manifest
