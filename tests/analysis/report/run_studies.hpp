#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "experiments/study/study.hpp"

namespace zerocount::testing {

/// A study with all that a report can show of a closed loop: two swept gains, a profile of k1, random starts,
/// jerks.
std::string rich_manifest(int trials, const std::string& description = "a test");

/// Runs a study by the plain engine and writes its results file.
study::Study run_study_file(const std::filesystem::path& path, const std::string& manifest);

/// Number of occurrences of `what` in the text.
std::size_t times_in(const std::string& text, const std::string& what);

}  // namespace zerocount::testing
