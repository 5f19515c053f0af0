#include "runners/verification/verification.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "runners/verification/file_checks.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {

bool holds(const CheckReport& report) {
  return std::all_of(report.checks.begin(), report.checks.end(),
                     [](const Check& check) { return check.problems.empty(); });
}

ProblemList::~ProblemList() {
  if (others_ > 0) check_.problems.push_back(fmt::format("and {} more", others_));
}

void ProblemList::add(std::string problem) {
  if (check_.problems.size() < max_problems) {
    check_.problems.push_back(std::move(problem));
  } else {
    ++others_;
  }
}

void require_no_stop(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Failure(ExitCode::interrupted, "interrupted: not everything was checked");
}

std::string problem_of(const Failure& failure, const std::filesystem::path& path) {
  const std::string_view message = failure.what();
  const std::string start = path.string() + ": ";
  return std::string(message.starts_with(start) ? message.substr(start.size()) : message);
}

namespace {

namespace fs = std::filesystem;

/// A file with the checks made so far. If it could be opened and described, its trials can be simulated
/// again.
struct OpenedFile {
  CheckReport report;
  std::optional<Described> described;  ///< Header and study of the file; nothing if it cannot be read.
};

/// A shard (file with some trials of a study) whose header was read.
struct ShardHeader {
  fs::path path;
  layout::FileHeader header;
};

/// Hash of the study to which most of the shards belong. If several studies have equally many, the one of the
/// first shard in the folder.
std::string common_study(std::span<const ShardHeader> shards) {
  std::map<std::string, std::int64_t> counts;
  for (const ShardHeader& shard : shards) ++counts[shard.header.study_sha256];
  const auto fewer = [&](const ShardHeader& one, const ShardHeader& other) {
    return counts[one.header.study_sha256] < counts[other.header.study_sha256];
  };
  return std::max_element(shards.begin(), shards.end(), fewer)->header.study_sha256;
}

/// First reason why the shard cannot be of the same run as the shard `first`; empty if it can.
std::string stranger(const layout::FileHeader& shard, const layout::FileHeader& first) {
  if (shard.study_sha256 != first.study_sha256)
    return fmt::format("from another study ('{}') than most", shard.name);
  if (!layout::same_build(shard.provenance, first.provenance))
    return fmt::format("from another build ({}, commit {})", shard.provenance.zerocount_version,
                       shard.provenance.git_commit);
  if (shard.engine != first.engine) return fmt::format("from the {} engine", layout::name_of(shard.engine));
  return {};
}

void check_overlaps(std::span<const shards::ShardInfo> sorted, ProblemList& problems) {
  const shards::ShardInfo* furthest = nullptr;
  for (const shards::ShardInfo& shard : sorted) {
    if (furthest != nullptr && shard.rows.first < furthest->rows.end()) {
      problems.add(fmt::format("{} holds trials {} to {}, which overlap those of {}",
                               shard.path.filename().string(), shard.rows.first, shard.rows.end() - 1,
                               furthest->path.filename().string()));
    }
    if (furthest == nullptr || shard.rows.end() > furthest->rows.end()) furthest = &shard;
  }
}

/// Skipped check that says how many trials are missing in the shards, because the run goes on or was
/// interrupted.
/// @param gaps ranges of rows (numbers of trials) that no shard has
Check unfinished(std::span<const layout::RowRange> gaps) {
  return {.name = "all trials",
          .detail = fmt::format("{} are in none of the shards yet, from trial {} on",
                                layout::total_rows(gaps), gaps.front().first),
          .skipped = true};
}

/// Checks that the shards (files with trials) of a folder belong to one study, build and engine, and that
/// they contain each trial of the study once. The study is that to which most of the shards belong.
/// @param stops whether the study has a stopping rule, so that there may be fewer trials than its manifest
/// allows
void check_shard_set(CheckReport& report, std::span<const ShardHeader> shards, bool stops) {
  std::vector<layout::RowRange> gaps;
  add_check(report, "shards", [&](Check& check, ProblemList& problems) {
    const std::string study = common_study(shards);
    const layout::FileHeader& first =
        std::find_if(shards.begin(), shards.end(), [&](const ShardHeader& shard) {
          return shard.header.study_sha256 == study;
        })->header;
    std::vector<shards::ShardInfo> own;
    for (const ShardHeader& shard : shards) {
      const std::string strange = stranger(shard.header, first);
      if (strange.empty()) own.push_back({shard.path, shard.header.rows});
      if (!strange.empty()) problems.add(fmt::format("{} is {}", shard.path.filename().string(), strange));
    }
    shards::sort_by_rows(own);
    check_overlaps(own, problems);
    check.detail = fmt::format("{} of one study{}", own.size(), stops ? "" : ", with each trial once");
    if (!stops) gaps = shards::missing_ranges(own, {0, first.trials * first.points});
  });
  if (!gaps.empty()) report.checks.push_back(unfinished(gaps));
}

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

/// Makes all checks of one file that do not simulate its trials again.
OpenedFile check_stored(const fs::path& path, const VerifySettings& settings) {
  OpenedFile opened{{.path = path, .stop = settings.stop, .scratch = settings.scratch}, {}};
  CheckReport& report = opened.report;
  if (!check_checksum(report)) return opened;
  opened.described = check_statistics(report, settings.plugin);
  if (opened.described) require_plugin(path, opened.described->study, settings);
  return opened;
}

/// Simulates trials of a file again, and adds the comparison with their records to its report.
/// @param chosen numbers of the trials, counted from the first trial of the file; if the file keeps only
/// failures, as many of these are added
/// @param seed seed for the random choice of these failures
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

/// Whether the file has only some trials of the study of its folder: a shard, or a part in a folder of
/// shards.
bool is_piece(const OpenedFile& opened) {
  if (!opened.described || opened.described->header.complete) return false;
  return opened.described->header.kind == layout::FileKind::shard ||
         opened.report.path.parent_path().extension() == ".shards";
}

/// Simulates a random sample of the trials of all shards of a folder again.
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
                  fmt::format("{}: no results files (*.h5) or shards in this directory", folder.string()));
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

void verify_file(const fs::path& path, const VerifySettings& settings, std::vector<CheckReport>& reports) {
  OpenedFile file = check_stored(path, settings);
  if (file.described)
    run_again(file, sample_below(file.described->header.rows.count, settings.trials, settings.seed),
              settings.seed);
  reports.push_back(std::move(file.report));
}

}  // namespace

std::vector<CheckReport> verify(std::span<const fs::path> operands, const VerifySettings& settings) {
  std::vector<CheckReport> reports;
  for (const fs::path& operand : operands) {
    std::error_code ignored;
    if (!fs::exists(operand, ignored))
      throw Failure(ExitCode::bad_input, fmt::format("{}: no such file", operand.string()));
    if (fs::is_directory(operand, ignored)) {
      verify_folder(operand, settings, reports);
    } else if (fs::is_regular_file(operand, ignored)) {
      verify_file(operand, settings, reports);
    } else {
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: not a regular file; a results file was expected", operand.string()));
    }
  }
  return reports;
}

}  // namespace zerocount::verification
