#pragma once

#include <cstdint>
#include <string>

#include "experiments/manifest_text/manifest_values.hpp"
#include "results/layout/header.hpp"

namespace zerocount::layout {

/// The values of the manifest of a file, with its overrides.
/// @param source the file that the header is of, for messages
/// @throws Failure (bad_data) where the manifest is not YAML that this program accepts.
manifest_text::ManifestValues manifest_values(const FileHeader& header, const std::string& source);

/// Adds the defaults that changed between the format versions of two files to the manifests that do not set
/// the parameter: with other defaults, equal manifests describe different trials.
void write_changed_defaults(manifest_text::ManifestValues& baseline, std::int64_t baseline_version,
                            manifest_text::ManifestValues& current, std::int64_t current_version);

}  // namespace zerocount::layout
