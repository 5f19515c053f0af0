#include "runners/verification/verification.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/verification/file_checks.hpp"
#include "runners/verification/rebuilt_file.hpp"
#include "runners/verification/rerun.hpp"
#include "runners/verification/shard_set.hpp"
#include "runners/verification/value_checks.hpp"

namespace zerocount::verification {
namespace {

namespace fs = std::filesystem;

/// A file that was opened without problems so far, so that its trials can be run again.
struct OpenedFile {
  CheckReport report;
  std::optional<Described> described;  ///< nothing if the file cannot be read
  bool sealed{true};                   ///< its checksum holds
};

void require_plugin(const fs::path& path, const study::Study& study, const VerifySettings& settings) {
  if (!study.plugin || study.plugin->functions != nullptr || settings.trials == 0 ||
      !layout::has_trials(study.retention))
    return;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("zerocount verify: the controller of {} is the plugin {}, which is not loaded from "
                  "a results file; give its path with --plugin, or run no trials with --trials 0",
                  path.string(), study.plugin->description.name));
}

/// All checks of one file except running its trials again.
OpenedFile check_stored(const fs::path& path, const VerifySettings& settings) {
  OpenedFile opened{{.path = path, .stop = settings.stop}, {}};
  CheckReport& report = opened.report;
  if (!(settings.reseal ? check_bytes_to_reseal(report, opened.sealed) : check_bytes(report))) return opened;
  std::optional<Described> described = check_header(report, settings.plugin);
  if (!described) return opened;
  require_plugin(path, described->study, settings);
  const std::optional<reading::ResultsFile> file = check_tables(report, described->study);
  if (!file || !report.checks.back().problems.empty()) return opened;
  check_values(report, *file, described->study);
  check_rebuilt(report, *file, described->study, equality_of(described->header));
  opened.described = std::move(described);
  return opened;
}

/// Runs trials of a file again. @param chosen numbers of the trials from the first of the file on; as many
/// failures are added, drawn with the seed, where the file keeps those alone
void run_again(OpenedFile& opened, std::vector<std::int64_t> chosen, std::uint64_t seed) {
  if (!opened.described || chosen.empty()) return;
  const auto& [header, study] = *opened.described;
  for (std::int64_t& row : chosen) row += header.rows.first;
  try {
    check_trials(opened.report, reading::ResultsFile(opened.report.path, reading::Require::unfinished), study,
                 {std::move(chosen), seed}, equality_of(header));
  } catch (const Failure& failure) {  // it has changed since
    if (failure.code() == ExitCode::interrupted) throw;
    add_check(opened.report, "trials run again", [&](Check&, ProblemList&) { throw failure; });
  }
}

/// True if the file is a piece of the study of its folder: a shard, or a part in a folder of shards.
bool is_piece(const OpenedFile& opened) {
  if (!opened.described || opened.described->header.complete) return false;
  return opened.described->header.kind == layout::FileKind::shard ||
         opened.report.path.parent_path().extension() == ".shards";
}

/// Runs a sample of the trials of all shards again.
void run_shards_again(std::vector<OpenedFile>& files, const VerifySettings& settings) {
  std::int64_t total = 0;
  for (const OpenedFile& file : files) total += is_piece(file) ? file.described->header.rows.count : 0;
  const std::vector<std::int64_t> chosen = sample_below(total, settings.trials, settings.seed);
  auto next = chosen.begin();
  std::int64_t before = 0;
  for (OpenedFile& file : files) {
    if (!is_piece(file)) continue;
    const std::int64_t end = before + file.described->header.rows.count;
    std::vector<std::int64_t> own;
    for (; next != chosen.end() && *next < end; ++next) own.push_back(*next - before);
    run_again(file, std::move(own), settings.seed);
    before = end;
  }
}

void verify_folder(const fs::path& folder, const VerifySettings& settings,
                   std::vector<CheckReport>& reports) {
  const std::vector<fs::path> paths = shards::shard_files(folder);
  if (paths.empty()) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no results files (*.h5) in this directory", folder.string()));
  }
  std::vector<OpenedFile> files;
  std::vector<ShardHeader> shards;
  bool stops = false;
  for (const fs::path& path : paths) {
    files.push_back(check_stored(path, settings));
    if (!is_piece(files.back())) continue;
    shards.push_back({path, files.back().described->header});
    stops = stops || files.back().described->study.stop.has_value();
  }
  run_shards_again(files, settings);
  for (OpenedFile& file : files) {
    if (file.described && !is_piece(file))
      run_again(file, sample_below(file.described->header.rows.count, settings.trials, settings.seed),
                settings.seed);
    reports.push_back(std::move(file.report));
  }
  if (shards.empty()) return;
  reports.push_back({folder});
  check_shard_set(reports.back(), shards, stops);
}

/// Makes the checksum of the file again, if that was wrong and everything else holds.
void reseal(OpenedFile& file) {
  if (file.sealed) return;
  if (!holds(file.report)) {
    file.report.checks.push_back({"checksum made again", "not before everything else holds", {}, true});
    return;
  }
  add_check(file.report, "checksum made again", [&](Check& check, ProblemList&) {
    const storage::OutputLock lock(file.report.path);
    storage::renew_checksum(file.report.path);
    check.detail = "SHA-256 " + storage::recorded_checksum(file.report.path);
  });
}

void verify_file(const fs::path& path, const VerifySettings& settings, std::vector<CheckReport>& reports) {
  OpenedFile file = check_stored(path, settings);
  if (file.described)
    run_again(file, sample_below(file.described->header.rows.count, settings.trials, settings.seed),
              settings.seed);
  reseal(file);
  reports.push_back(std::move(file.report));
}

}  // namespace

std::vector<CheckReport> verify(std::span<const fs::path> operands, const VerifySettings& settings) {
  std::vector<CheckReport> reports;
  for (const fs::path& operand : operands) {
    std::error_code ignored;
    if (!fs::exists(operand, ignored))
      throw Failure(ExitCode::bad_input, fmt::format("{}: no such file", operand.string()));
    const bool folder = fs::is_directory(operand, ignored);
    if (folder && settings.reseal)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: a directory; --reseal expects results files", operand.string()));
    if (folder) {
      verify_folder(operand, settings, reports);
    } else if (fs::is_regular_file(operand, ignored)) {
      verify_file(operand, settings, reports);
    } else {
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: no regular file; a results file was expected", operand.string()));
    }
  }
  return reports;
}

}  // namespace zerocount::verification
