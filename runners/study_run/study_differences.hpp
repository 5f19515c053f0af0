#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"

namespace zerocount {

/// What differs between the study of a results file and this one, both as they were given: without the number
/// of trials that a stopping rule came to, and with the defaults that have changed since the file was made.
/// @param path of the file, for messages
std::vector<ManifestDifference> study_differences(const std::filesystem::path& path, FileHeader header,
                                                  const Study& study);

/// "seed is 42 there and 43 here, …": the first five, and how many more there are.
std::string differences_text(const std::vector<ManifestDifference>& differences);

}  // namespace zerocount
