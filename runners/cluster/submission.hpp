#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace zerocount::cluster {

/// The jobs submitted for an output: FILE.parts/submission.json.
struct Submission {
  std::int64_t parts{1};
  std::string study_sha256;       ///< of the study that the jobs run
  std::vector<std::string> jobs;  ///< numbers of the jobs
};

std::filesystem::path submission_file(const std::filesystem::path& output);

/// Nothing if nothing was submitted.
/// @throws Failure (bad_data) if the file is not a submission.
std::optional<Submission> read_submission(const std::filesystem::path& output);

/// @throws Failure (machine_failed) if it cannot be written.
void write_submission(const std::filesystem::path& output, const Submission& submission);

}  // namespace zerocount::cluster
