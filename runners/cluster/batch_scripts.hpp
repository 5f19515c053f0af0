#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runners/cluster/array_job.hpp"

namespace zerocount::cluster {

/// Contents of the scripts of a study.
struct BatchRequest {
  std::string name;               ///< of the study
  std::string study_sha256;       ///< the jobs refuse a study with another hash
  std::filesystem::path program;  ///< absolute
  std::filesystem::path folder;   ///< absolute; other paths may be relative to it
  std::string manifest;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::filesystem::path output;
  ArrayJob job;
  std::vector<std::int64_t> elements;   ///< of the array, to be run
  std::optional<std::int64_t> at_once;  ///< maximum number of elements that run at the same time
  std::int64_t cpus{1};                 ///< of each job
  std::optional<std::string> time;      ///< limit of each job, in the format of Slurm
  std::vector<std::string>
      sbatch_options;    ///< further options of sbatch, one per line, which override the others
  bool replaces{false};  ///< the results file replaces an existing one
};

/// The script of the array job: each element runs its parts, one after the other. Complete parts cost
/// nothing, and interrupted ones continue.
std::string array_script(const BatchRequest& request);

/// The script of one job that runs the study as a whole.
std::string single_script(const BatchRequest& request);

/// The script of the job that merges the parts.
std::string merge_script(const BatchRequest& request);

/// `path` as the pattern of a file name in a line "#SBATCH --output=…", which Slurm reads like a shell:
/// in double quotes, with % doubled. `path` has no backslash, and no control character.
std::string sbatch_path(const std::string& path);

}  // namespace zerocount::cluster
