#include "runners/cluster/slurm.hpp"

#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "runners/child_process/child_process.hpp"

namespace zerocount::cluster {
namespace {

/// ": " and the lines of a message as one.
std::string as_one_line(std::string_view text) {
  std::string line;
  std::istringstream lines{std::string(text)};
  for (std::string part; std::getline(lines, part);) {
    if (!part.empty()) line += (line.empty() ? ": " : "; ") + part;
  }
  return line;
}

/// The output of a command.
std::string output_of(const std::vector<std::string>& words) {
  std::optional<child_process::ChildResult> result = child_process::run_child(words, "");
  if (!result) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: not found; Slurm is not installed here (--dry-run shows the scripts)",
                              words.front()));
  }
  if (result->code == 0) return std::move(result->out);
  throw Failure(ExitCode::machine_failed,
                fmt::format("{} has failed with exit code {} (--dry-run shows the scripts){}", words.front(),
                            result->code, as_one_line(result->err)));
}

}  // namespace

std::int64_t max_array_size() {
  std::istringstream lines(output_of({"scontrol", "show", "config"}));
  for (std::string line; std::getline(lines, line);) {  // "MaxArraySize            = 1001"
    std::istringstream words(line);
    std::string name, equals;
    std::int64_t value = 0;
    if (words >> name >> equals >> value && name == "MaxArraySize") return value;
  }
  return default_max_array_size;
}

std::vector<std::string> queued_jobs() {
  std::istringstream lines(output_of({"squeue", "--noheader", "--format=%F"}));
  std::vector<std::string> jobs;
  for (std::string job; lines >> job;) jobs.push_back(job);
  return jobs;
}

std::string submit(const std::filesystem::path& script, const std::string& after) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  if (!after.empty()) words.push_back("--dependency=afterany:" + after);
  words.push_back(script.string());
  const std::string answer = output_of(words);
  return answer.substr(0, answer.find_first_of(";\n"));  // "12", or "12;cluster"
}

}  // namespace zerocount::cluster
