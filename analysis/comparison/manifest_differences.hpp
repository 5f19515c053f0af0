#pragma once

#include <cstdint>
#include <string>

#include "experiments/manifest/manifest_values.hpp"
#include "results/layout/header.hpp"

namespace zerocount::comparison {

using manifest::ManifestValues;

/// @param source the file that the header is of, for messages
/// @throws Failure (bad_data) where the manifest is not YAML that this program accepts.
ManifestValues manifest_values(const layout::FileHeader& header, const std::string& source);

/// Adds the defaults that changed between the format versions of two files to the manifests that do not set
/// the parameter: with other defaults, equal manifests describe different trials.
void write_changed_defaults(ManifestValues& baseline, std::int64_t baseline_version, ManifestValues& current,
                            std::int64_t current_version);

}  // namespace zerocount::comparison
