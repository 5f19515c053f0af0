#include "runners/verification/file_checks.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/trials/summary/study_statistics.hpp"
#include "core/text/text.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "results/reading/first_difference.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {
namespace {

constexpr double tolerance_of_rounding = 1e-9;

template <class Value>
void require_equal(std::string_view name, const Value& there, const Value& expected, ProblemList& problems) {
  if (there == expected) return;
  problems.add(fmt::format("the attribute '{}' is {}; its manifest says {}", name, there, expected));
}

void compare_header(const layout::FileHeader& header, const study::Study& study, ProblemList& problems) {
  if (!header.finished) problems.add("it was never finished");
  require_equal("name", header.name, study.name, problems);
  require_equal("seed", header.seed, study.seed, problems);
  // Another program may define the hash otherwise: its files are compared by their manifests alone.
  if (layout::same_build(header.provenance, layout::current_provenance()))
    require_equal("study_sha256", header.study_sha256, study.study_sha256, problems);
}

/// Checks that every drawn parameter of the kept trials has a value that the table of parameters allows.
/// @param positions positions of the trials in the file's tables
/// @throws Failure (bad_data) if one has not
void require_allowed_inputs(const reading::TrialTables& trials, const study::StudyPlan& plan,
                            layout::RowRange positions) {
  const std::size_t columns = std::min(trials.input_columns().size(), plan.inputs.size());
  for (std::size_t column = 0; column < columns; ++column) {
    const parameters::Parameter& row = plan.table.rows[plan.inputs[column].slot];
    const std::vector<double> values = trials.input(column, positions);
    const auto wrong = std::ranges::find_if_not(values, [&](double value) {
      return numerics::contains(row.range, value) || (row.none && value == *row.none);
    });
    if (wrong == values.end()) continue;
    const std::int64_t trial = trials.rows({positions.first + (wrong - values.begin()), 1}).front();
    throw Failure(ExitCode::bad_data, fmt::format("/trial/input/{}: trial {}: it is {}; expected {}",
                                                  trials.input_columns()[column].name, trial, *wrong,
                                                  numerics::range_text(row.range)));
  }
}

/// Checks that the inputs, measures and jerks of the trials in the file are possible values. If the file has
/// sums, checks also that they are possible for the number of trials at each design point and, if the file
/// keeps the failed trials, that the failures counted in the sums are as many as these trials.
/// @throws Failure (bad_data) if a value is impossible
void check_contents(const reading::ResultsFile& file, const study::Study& study) {
  if (file.trials()) {
    file.trials()->require_valid_values();
    file.trials()->for_each_block(
        [&](layout::RowRange block) { require_allowed_inputs(*file.trials(), *study.plan, block); });
  }
  if (!layout::has_sums(study.retention)) return;
  for (std::int64_t i = 0; i < file.points(); ++i) {
    const std::int64_t point = file.first_point() + i;
    const std::int64_t expected = summary::restored_point(file, study, point).failures();
    const std::int64_t count =
        file.trials() ? file.trials()->positions_of(file.rows_of(point)).count : expected;
    if (count == expected) continue;
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: design point {}: {} failures; expected the {} of its sums",
                              file.path().string(), point, count, expected));
  }
}

/// Checks that the sample records (traces) in the file belong to the retained trials in their order, each
/// starting with its first sample. Adds a problem otherwise. This must be checked here, because a file that
/// is made again takes over the numbers of the records.
void check_records(const reading::ResultsFile& file, const study::Study& study, ProblemList& problems) {
  if (!file.trials() || study.retained_trials.empty()) return;
  std::vector<std::int64_t> expected;
  for (std::int64_t row = file.rows().first; row < file.rows().end(); ++row) {
    if (std::ranges::binary_search(study.retained_trials, row % study.trials)) expected.push_back(row);
  }
  std::size_t traced = 0;
  std::int64_t position = 0;
  for (const auto& [row, places] : study_run::places_of_records(*file.trials())) {
    if (traced == expected.size() || row != expected[traced] || places.first != position) {
      problems.add(fmt::format("/trace/trial: row {}: it is {}; expected the retained trials, in their order",
                               places.first, row));
      return;
    }
    std::int64_t k = 0;
    for (const layout::TraceRecord& record : file.trials()->trace_at(places.first, places.count)) {
      if (record.trial == row && record.k == k++) continue;
      problems.add(fmt::format("/trace/k: trial {}: its samples are not those from 0 on", row));
      return;
    }
    position = places.end();
    ++traced;
  }
  if (traced == expected.size()) return;
  problems.add(
      fmt::format("/trace/trial: it has records of {} trials; expected those of the {} retained ones", traced,
                  expected.size()));
}

/// Checks that a file which keeps only failed trials keeps no trial that succeeded. Adds a problem for each.
void check_failures(const reading::ResultsFile& file, const study::Study& study, ProblemList& problems) {
  if (!file.trials() || !layout::has_sums(study.retention)) return;
  const reading::TrialTables& trials = *file.trials();
  const auto moves = static_cast<std::size_t>(trials.moves());
  trials.for_each_block([&](layout::RowRange positions) {
    const std::vector<trial::MoveOutcome> outcomes = trials.outcomes(positions);
    std::span<const trial::MoveOutcome> rest = outcomes;
    for (const std::int64_t row : trials.rows(positions)) {
      if (trial::succeeded(rest.first(moves)))
        problems.add(fmt::format("trial {}: kept as a failure; all its moves ended at zero", row));
      rest = rest.subspan(moves);
    }
  });
}

/// Sentence about a difference between the checked file and the file that was made again from its manifest
/// and trials.
std::string sentence(const reading::DatasetDifference& difference, const hdf5::Group& file) {
  if (difference.kind != reading::DatasetDifference::Kind::in_one_file_only)
    return fmt::format("{}: {} from what its manifest and its trials give", difference.path, difference.how);
  return fmt::format("{}: {}", difference.path,
                     file.contains(difference.path) ? "not a dataset of this study" : "missing");
}

/// Makes the results file again from its manifest and its trials, at the path `rebuilt`. Messages about wrong
/// trials do not name this temporary file.
void rebuild(const reading::ResultsFile& file, const study::Study& study,
             const std::filesystem::path& rebuilt, const std::stop_token& stop) {
  const std::array<shards::ShardInfo, 1> trials{{{file.path(), file.rows()}}};
  try {
    study_run::assemble(trials, study, rebuilt, file.rows(), {.stop = stop});
  } catch (const Failure& failure) {
    require_no_stop(stop);
    if (failure.code() != ExitCode::bad_data) throw;
    throw Failure(failure.code(), problem_of(failure, storage::part_of(rebuilt)));
  }
}

/// Removes the folder for temporary files at the end of the object's scope.
struct RemovedAtEnd {
  storage::ScratchFolder& scratch;
  ~RemovedAtEnd() { scratch.remove(); }
};

void compare_rebuilt(const reading::ResultsFile& file, const study::Study& study, const CheckReport& report,
                     ProblemList& problems) {
  const RemovedAtEnd folder{*report.scratch};
  const std::filesystem::path rebuilt = folder.scratch.make() / "rebuilt.h5";
  rebuild(file, study, rebuilt, report.stop);
  const reading::ResultsFile other(rebuilt, reading::Require::unfinished);
  const bool exact = equality_of(file.header()) == Equality::bits;
  const double tolerance = exact ? 0.0 : tolerance_of_rounding;
  for (const reading::DatasetDifference& one : reading::differences(file.root(), other.root(), tolerance)) {
    // Another build may have had more statistics, or fewer.
    if (exact || one.kind != reading::DatasetDifference::Kind::in_one_file_only)
      problems.add(sentence(one, file.root()));
  }
}

std::size_t datasets_in(const hdf5::Group& group) {
  std::size_t count = 0;
  for (const std::string& name : group.children())
    count += group.is_group(name) ? datasets_in(group.open_group(name)) : 1;
  return count;
}

/// Text that says what the check of the statistics covered, such as the number of trials.
std::string detail_of(const reading::ResultsFile& file, const study::Study& study) {
  const layout::FileHeader& header = file.header();
  std::string values;
  if (file.trials()) {
    const reading::TrialTables& trials = *file.trials();
    values = fmt::format(
        "{} inputs and {} measures of {} trials with {} moves, {} jerks and {} sample records in their "
        "ranges; ",
        trials.input_columns().size(), trials.measures().size(), trials.count(),
        trials.count() * trials.moves(), trials.jerk_count(), trials.trace_count());
  }
  if (header.kind == layout::FileKind::shard)
    return fmt::format("{}, trials {} to {} of {}: {}header as its manifest says", header.name,
                       header.rows.first, header.rows.end() - 1, header.trials * header.points, values);
  return fmt::format(
      "{}, trials {} to {} of {}: header as its manifest says; {}all {} datasets, the statistics of {} among "
      "them, equal to those made again{}",
      header.name, header.rows.first, header.rows.end() - 1, header.trials * header.points, values,
      datasets_in(file.root()), text::counted(study::point_count(study), "design point"),
      equality_of(header) == Equality::bits ? "" : ", to a relative 1e-9");
}

}  // namespace

bool check_checksum(CheckReport& report) {
  return add_check(report, "checksum", [&](Check& check, ProblemList&) {
    if (reading::is_shard(report.path)) {
      storage::require_valid_checksum(report.path);
    } else {
      layout::open_results(report.path);
    }
    check.detail = "SHA-256 " + storage::recorded_checksum(report.path);
  });
}

std::optional<Described> check_statistics(CheckReport& report,
                                          const std::shared_ptr<const plugin::ControllerPlugin>& plugin) {
  std::optional<Described> described;
  add_check(report, "statistics", [&](Check& check, ProblemList& problems) {
    layout::FileHeader header = shards::unchecked_header(report.path);
    study::Study study = layout::recorded_study(header, report.path, header.plugin ? plugin : nullptr);
    compare_header(header, study, problems);
    const reading::ResultsFile file(report.path, reading::Require::unfinished);  // the checksum was checked
    check.detail = detail_of(file, study);
    if (file.trials() && file.trials()->moves() != study.moves) {
      problems.add(
          fmt::format("/outcome/move: {} moves; its manifest has {}", file.trials()->moves(), study.moves));
      return;
    }
    described = {std::move(header), std::move(study)};
    const auto work_on = [&](const auto& work) {  // after a wrong value the others are still compared
      try {
        work();
      } catch (const Failure& failure) {
        if (failure.code() != ExitCode::bad_data) throw;
        problems.add(problem_of(failure, report.path));
      }
    };
    work_on([&] { check_contents(file, described->study); });
    work_on([&] { check_records(file, described->study, problems); });
    work_on([&] { check_failures(file, described->study, problems); });
    if (described->header.kind != layout::FileKind::shard)  // it has nothing that follows from its trials
      work_on([&] { compare_rebuilt(file, described->study, report, problems); });
  });
  return described;
}

}  // namespace zerocount::verification
