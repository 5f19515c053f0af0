#include <cerrno>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/pairs/comparison/comparison.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_file.hpp"

namespace zerocount::comparison {
namespace {

namespace fs = std::filesystem;

/// The bytes of a file; empty if the file does not exist.
std::string bytes_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  if (!fs::exists(there)) return {};
  if (!fs::is_regular_file(there)) storage::fail_irregular(path);  // a pipe would be waited for
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file.is_open() || file.bad()) storage::fail_with(path, "read", errno);
  return bytes;
}

/// The text as a double-quoted string of YAML. JSON strings are valid YAML.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string comparison_with(const fs::path& before, const fs::path& now) {
  try {
    return verdict_sentence(compare_files(before, now));
  } catch (const Failure& failure) {
    return fmt::format("cannot be compared: {}", failure.what());
  }
}

std::string log_entry(const layout::FileHeader& header, const std::string& sha256, const std::string& reason,
                      const std::string& replaced, const std::string& comparison) {
  const layout::Provenance& build = header.provenance;
  std::string entry = fmt::format(
      "- date: {}\n  reason: {}\n  sha256: {}\n  study: {}\n  overrides: {}\n  trials: {}\n  points: {}\n  "
      "seed: {}\n"
      "  zerocount_version: {}\n  git_commit: {}\n  engine: {}\n",
      quoted(layout::current_provenance().created), quoted(reason), quoted(sha256), quoted(header.name),
      nlohmann::json(header.overrides).dump(), header.trials, header.points, header.seed,
      quoted(build.zerocount_version), quoted(build.git_commit), layout::name_of(header.engine));
  if (!replaced.empty())
    entry += fmt::format("  replaces: {}\n  comparison: {}\n", quoted(replaced), quoted(comparison));
  return entry;
}

/// The present text of the log with the reasons for a baseline, to which further entries can be appended;
/// empty if there is no log.
/// @throws Failure (bad_data) if the file is not such a log.
std::string log_so_far(const fs::path& path) {
  std::string log = bytes_of(path);
  if (log.empty()) return log;
  yaml::Problems problems;
  const yaml::YamlPointer entries = yaml::parse_yaml(log, path.string(), false, problems);
  const bool is_list = problems.empty() && entries && entries->kind == yaml::YamlNode::Kind::list;
  if (is_list && log.back() == '\n') return log;
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: cannot append to this baseline log: expected a YAML list ending in a newline. "
                  "Repair or delete the file",
                  path.string()));
}

}  // namespace

fs::path baseline_log(const fs::path& baseline) {
  fs::path log = baseline;
  log += ".log.yaml";
  return log;
}

BaselineUpdate update_baseline(const fs::path& file, const fs::path& output, const std::string& reason) {
  const reading::AllTrialsFile study(file);
  study.require_valid_values();
  const layout::FileHeader& header = study.header();
  const std::string bytes = bytes_of(file);
  const std::string before = bytes_of(output);
  BaselineUpdate update;
  if (bytes == before) return {false, {}, {}};
  const std::string log = log_so_far(baseline_log(output));
  std::string replaced;
  if (!before.empty()) {
    replaced = hash::sha256_hex(before);
    update.comparison = comparison_with(output, file);
    if (log.find(replaced) == std::string::npos) {
      update.warnings.push_back(
          fmt::format("{} is not the file that its log speaks of last: it was changed without a record",
                      output.string()));
    }
  }
  if (layout::is_dirty(header.provenance)) {
    update.warnings.push_back(fmt::format(
        "{} was made by a build with changes that were not committed: nobody else can reproduce it",
        file.string()));
  }
  storage::OutputFile record(baseline_log(output));
  record.write(log + log_entry(header, hash::sha256_hex(bytes), reason, replaced, update.comparison));
  record.finish();
  storage::OutputFile baseline(output);
  baseline.write(bytes);
  baseline.finish();
  record.publish();
  baseline.publish();
  return update;
}

}  // namespace zerocount::comparison
