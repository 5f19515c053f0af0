#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace zerocount::comparison {

/// The result of a change of a baseline.
struct BaselineUpdate {
  bool changed{true};      ///< false where it was this file already
  std::string comparison;  ///< with the baseline that was replaced, a sentence; empty where there was none
  std::vector<std::string> warnings;
};

/// Where the reasons for a baseline are recorded: "NAME.h5.log.yaml", a YAML list, oldest entry first.
std::filesystem::path baseline_log(const std::filesystem::path& baseline);

/// Makes a whole results file the baseline `output`, byte by byte, and records the reason first: a baseline
/// without its record is never left behind.
/// @throws Failure where `file` is not a complete results file, or something cannot be written
BaselineUpdate update_baseline(const std::filesystem::path& file, const std::filesystem::path& output,
                               const std::string& reason);

}  // namespace zerocount::comparison
