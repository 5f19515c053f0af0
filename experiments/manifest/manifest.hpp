#pragma once

#include "experiments/manifest/companions.hpp"
#include "experiments/manifest/samples.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Converts the manifest `root` to a Study, without its text, overrides and hashes. Errors are added to
/// `problems`; with errors the study must not be used.
/// @param version of the results files whose defaults apply
/// @param samples inserted in `root` before, or null
study::Study read_manifest(const yaml::YamlNode& root, std::int64_t version, const Companions& companions,
                           const SamplesTable* samples, yaml::Problems& problems);

}  // namespace zerocount::manifest
