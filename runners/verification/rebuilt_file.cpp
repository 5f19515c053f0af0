#include "runners/verification/rebuilt_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>

#include <fmt/format.h>

#include "results/reading/first_difference.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/temporary_folder.hpp"
#include "runners/study_run/assembly.hpp"

namespace zerocount::verification {
namespace {

constexpr double tolerance_of_rounding = 1e-9;

/// The sentence for a difference between the file and the rebuilt one.
std::string sentence(const reading::DatasetDifference& difference, const hdf5::Group& file) {
  if (!difference.in_one_file_only)
    return fmt::format("{}: {} from what its manifest and its trials give", difference.path, difference.how);
  return fmt::format("{}: {}", difference.path,
                     file.contains(difference.path) ? "not a dataset of this study" : "missing");
}

/// Makes the file `rebuilt`. Messages about wrong trials do not name this temporary file.
void make(std::span<const shards::ShardInfo> trials, const study::Study& study,
          const std::filesystem::path& rebuilt, layout::RowRange rows, const std::stop_token& stop) {
  try {
    study_run::assemble(trials, study, rebuilt, rows, {.stop = stop});
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_data) throw;
    throw Failure(failure.code(), problem_of(failure, storage::part_of(rebuilt)));
  }
}

}  // namespace

void check_rebuilt(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                   Equality equality) {
  if (file.header().kind == layout::FileKind::shard) return;
  add_check(report, "statistics", [&](Check& check, ProblemList& problems) {
    if (file.header().version != layout::format_version) {
      check.skipped = true;
      check.detail = fmt::format("format version {} had others", file.header().version);
      return;
    }
    const storage::TemporaryFolder folder;
    const std::filesystem::path rebuilt = folder / "rebuilt.h5";
    const std::array<shards::ShardInfo, 1> trials{{{file.path(), file.rows()}}};
    make(trials, study, rebuilt, file.rows(), report.stop);
    const reading::ResultsFile other(rebuilt, reading::Require::unfinished);
    const bool exact = equality == Equality::bits;
    const double tolerance = exact ? 0.0 : tolerance_of_rounding;
    for (const reading::DatasetDifference& one : reading::differences(file.root(), other.root(), tolerance)) {
      // Another build may have had more statistics, or fewer.
      if (exact || !one.in_one_file_only) problems.add(sentence(one, file.root()));
    }
    check.detail = fmt::format("design points, profiles, rigs and statistics made again{}",
                               exact ? "" : ", to a relative 1e-9");
  });
}

}  // namespace zerocount::verification
