#pragma once

#include <filesystem>

namespace zerocount::testing {

/// Unpacks into `folder` a results file of format version 1, as the last program wrote it that wrote that
/// version: 2 points with 3 trials of 2 moves, the samples of trial 1 retained.
std::filesystem::path version_1_file(const std::filesystem::path& folder);

}  // namespace zerocount::testing
