#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "results/layout/header.hpp"

namespace zerocount {

/// The values of a manifest by their dotted paths, with the overrides in place: what is no map is one value,
/// as YAML on one line.
using ManifestValues = std::map<std::string, std::string>;

/// @param source the file that the header is of, for messages
/// @throws Failure (bad_data) where the manifest is no YAML that this program accepts.
ManifestValues manifest_values(const FileHeader& header, const std::string& source);

/// The value of a key that is a text or a number; `absent` where it is missing.
std::string value_or(const ManifestValues& values, const std::string& key, const std::string& absent);

/// The keys on which the two disagree, by name.
std::vector<ManifestDifference> manifest_differences(const ManifestValues& baseline,
                                                     const ManifestValues& current);

}  // namespace zerocount
