#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "results/layout/header.hpp"

namespace zerocount::comparison {

/// The values of a manifest by their dotted paths, with the overrides applied. Lists are one value, written
/// as YAML on one line.
using ManifestValues = std::map<std::string, std::string>;

/// @param source the file that the header is of, for messages
/// @throws Failure (bad_data) where the manifest is not YAML that this program accepts.
ManifestValues manifest_values(const layout::FileHeader& header, const std::string& source);

/// Adds the defaults that changed between the format versions of two files to the manifests that do not set
/// the parameter: with other defaults, equal manifests describe different trials.
void write_changed_defaults(ManifestValues& baseline, std::int64_t baseline_version, ManifestValues& current,
                            std::int64_t current_version);

/// The value of a key that is a text or a number; `absent` where it is missing.
std::string value_or(const ManifestValues& values, const std::string& key, const std::string& absent);

/// The keys with different values, sorted. Comments, spacing, the order of keys and the notation of a number
/// do not matter.
std::vector<ManifestDifference> manifest_differences(const ManifestValues& baseline,
                                                     const ManifestValues& current);

}  // namespace zerocount::comparison
