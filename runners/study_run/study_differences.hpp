#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"

namespace zerocount::study_run {

/// Differences between the study of a results file and this one. The final number of trials of a stopping
/// rule is ignored; defaults that changed since the file was written are included.
/// @param path of the file, for messages
std::vector<comparison::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                              layout::FileHeader header,
                                                              const study::Study& study);

/// "seed is 42 there and 43 here, …": the first five differences, and the number of others.
std::string differences_text(const std::vector<comparison::ManifestDifference>& differences);

}  // namespace zerocount::study_run
