#include "runners/cluster/submission.hpp"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "results/shards/pieces.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::cluster {

std::filesystem::path submission_file(const std::filesystem::path& output) {
  return shards::parts_directory(output) / "submission.json";
}

std::optional<Submission> read_submission(const std::filesystem::path& output) {
  const std::filesystem::path path = submission_file(output);
  std::ifstream file(path);
  if (!file) return std::nullopt;
  try {
    const nlohmann::json json = nlohmann::json::parse(file);
    return Submission{json.at("parts").get<std::int64_t>(), json.at("study_sha256").get<std::string>(),
                      json.at("jobs").get<std::vector<std::string>>()};
  } catch (const nlohmann::json::exception&) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged; expected the parts, the study and the submitted jobs. "
                              "Remove it when no job is in the queue",
                              path.string()));
  }
}

void write_submission(const std::filesystem::path& output, const Submission& submission) {
  const nlohmann::ordered_json json{
      {"parts", submission.parts}, {"study_sha256", submission.study_sha256}, {"jobs", submission.jobs}};
  storage::replace_file(submission_file(output), json.dump(2) + "\n");
}

}  // namespace zerocount::cluster
