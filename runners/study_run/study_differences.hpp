#pragma once

#include <filesystem>
#include <vector>

#include "experiments/manifest/manifest_values.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"

namespace zerocount::study_run {

/// Differences between the study of a results file and this one. The final number of trials of a stopping
/// rule is ignored; defaults that changed since the file was written are included.
/// @param path of the file, for messages
std::vector<manifest::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                            layout::FileHeader header,
                                                            const study::Study& study);

}  // namespace zerocount::study_run
