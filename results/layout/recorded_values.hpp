#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"

namespace zerocount::layout {

/// The values of the manifest (the study's input file) that a results file contains, with its overrides
/// applied.
/// @param source name of the results file, for messages.
/// @throws Failure (bad_data) where the manifest is not YAML that this program accepts.
manifest_text::ManifestValues manifest_values(const FileHeader& header, const std::string& source);

/// The values in which the study of the file `path` differs from `study`. The function compares the values of
/// the manifest with its overrides, the table of samples, and the order of keys where results are numbered by
/// that order. Code that adds trials to a file must call this and accept only differences that are allowed
/// there, such as the number of trials for an extension. The controller is compared by require_same_plugin().
/// @throws Failure (bad_data) as manifest_values() does.
std::vector<manifest_text::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                                 const FileHeader& header,
                                                                 const study::Study& study);

}  // namespace zerocount::layout
