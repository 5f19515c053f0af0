#include "runners/cluster/slurm.hpp"

#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "runners/child_process/child_process.hpp"

namespace zerocount::cluster {
namespace {

/// The last line tells the consequence of those before.
std::string_view last_line(std::string_view text) {
  text = text.substr(0, text.find_last_not_of(" \n") + 1);
  return text.substr(text.rfind('\n') + 1);
}

/// @returns the output of a command; nothing if it is not installed
std::optional<std::string> output_of(const std::vector<std::string>& words) {
  const std::optional<child_process::ChildResult> result = child_process::run_child(words, "");
  if (!result) return std::nullopt;
  if (result->code == 0) return result->out;
  throw Failure(ExitCode::machine_failed,
                fmt::format("{} has failed with exit code {} (--dry-run shows the scripts): {}",
                            words.front(), result->code, last_line(result->err)));
}

std::string required_output(const std::vector<std::string>& words) {
  if (std::optional<std::string> output = output_of(words)) return std::move(*output);
  throw Failure(
      ExitCode::machine_failed,
      fmt::format("{}: not found; Slurm is not installed here (--dry-run shows the scripts)", words.front()));
}

}  // namespace

std::optional<std::int64_t> max_array_size() {
  const std::optional<std::string> configuration = output_of({"scontrol", "show", "config"});
  if (!configuration) return std::nullopt;
  std::istringstream lines(*configuration);
  for (std::string line; std::getline(lines, line);) {  // "MaxArraySize            = 1001"
    std::istringstream words(line);
    std::string name, equals;
    std::int64_t value = 0;
    if (words >> name >> equals >> value && name == "MaxArraySize") return value;
  }
  return default_max_array_size;
}

std::vector<std::string> queued_jobs() {
  std::istringstream lines(required_output({"squeue", "--noheader", "--format=%F"}));
  std::vector<std::string> jobs;
  for (std::string job; lines >> job;) jobs.push_back(job);
  return jobs;
}

std::string submit(const std::filesystem::path& script, const std::string& after) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  if (!after.empty()) words.push_back("--dependency=afterany:" + after);
  words.push_back(script.string());
  const std::string answer = required_output(words);
  return answer.substr(0, answer.find_first_of(";\n"));  // "12", or "12;cluster"
}

}  // namespace zerocount::cluster
