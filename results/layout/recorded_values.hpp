#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"

namespace zerocount::layout {

/// The values of the manifest of a file, with its overrides.
/// @param source the file that the header is of, for messages
/// @throws Failure (bad_data) where the manifest is not YAML that this program accepts.
manifest_text::ManifestValues manifest_values(const FileHeader& header, const std::string& source);

/// The values in which the study of the file `path` differs from this one: those of the manifest with its
/// overrides, the order of keys where it numbers results, and the table of samples. Whoever adds trials to
/// those of a file asks this: nothing but what may differ there (for an extension the number of trials) may
/// be in the answer. The controller is compared by require_same_plugin().
/// @throws Failure (bad_data) as manifest_values() does.
std::vector<manifest_text::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                                 const FileHeader& header,
                                                                 const study::Study& study);

}  // namespace zerocount::layout
