#include "runners/verification/rerun.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "results/layout/layout.hpp"
#include "runners/study_run/recorded_trials.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::verification {
namespace {

constexpr std::int64_t max_rows_of_task = 256;
constexpr std::size_t tasks_at_once = 64;  // bounds the memory

using Results = std::vector<shards::TrialResult>;

/// A file whose trials are compared with those that are run again.
struct RecordedFile {
  const reading::ResultsFile& file;
  study_run::RecordPlaces records;
  Equality equality;
};

void compare_range(const RecordedFile& recorded, layout::RowRange rows, const Results& now,
                   ProblemList& problems) {
  try {
    const Results before =
        study_run::read_trials(*recorded.file.trials(), rows, rows.first, recorded.records);
    auto next = before.begin();
    const std::int64_t trials = recorded.file.header().trials;
    for (const shards::TrialResult& trial : now) {
      const bool kept = next != before.end() && next->row == trial.row;
      for (const std::string& line :
           differences_from_record(recorded.file, kept ? &*next : nullptr, trial, recorded.equality))
        problems.add(fmt::format("point {}, trial {}: {}", trial.row / trials, trial.row % trials, line));
      if (kept) ++next;
    }
  } catch (const Failure& failure) {  // damaged values; the other trials are still compared
    if (failure.code() == ExitCode::machine_failed) throw;
    problems.add(problem_of(failure, recorded.file.path()));
  }
}

/// Runs trials in parallel, and gives the results range by range in order of rows.
template <class Take>
void run_in_tasks(const study::Study& study, std::span<const std::int64_t> rows, const std::stop_token& stop,
                  const Take& take) {
  const std::vector<layout::RowRange> ranges = ranges_of(rows);
  oneapi::tbb::enumerable_thread_specific<trials::TrialRunner> runners(
      [&study] { return trials::TrialRunner(study); });
  for (std::size_t first = 0; first < ranges.size(); first += tasks_at_once) {
    require_no_stop(stop);
    const std::size_t count = std::min(tasks_at_once, ranges.size() - first);
    std::vector<Results> results(count);
    oneapi::tbb::parallel_for(std::size_t{0}, count,
                              [&](std::size_t i) { results[i] = runners.local().run(ranges[first + i]); });
    for (std::size_t i = 0; i < count; ++i) take(ranges[first + i], results[i]);
  }
}

/// The chosen rows, and as many failures: where few trials fail, hardly any is among the rows.
std::vector<std::int64_t> with_failures(const ChosenTrials& chosen, const reading::TrialTables& failures) {
  std::set<std::int64_t> rows(chosen.rows.begin(), chosen.rows.end());
  for (const std::int64_t position : sample_below(failures.count(), std::ssize(chosen.rows), chosen.seed))
    rows.insert(failures.rows({position, 1}).front());
  return {rows.begin(), rows.end()};
}

std::string detail_of(std::size_t run, std::int64_t trials, Equality equality) {
  return fmt::format("{} of {}, equal {}", run, trials,
                     equality == Equality::bits
                         ? "to the bit"
                         : "to a relative 1e-9 (run by another build or on another processor)");
}

}  // namespace

std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed) {
  if (count >= size) {
    std::vector<std::int64_t> all(static_cast<std::size_t>(size));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  // Floyd's algorithm (Bentley & Floyd 1987): every subset of this size is equally likely.
  std::mt19937_64 random(seed);
  std::set<std::int64_t> chosen;
  for (std::int64_t limit = size - count; limit < size; ++limit) {
    const auto drawn = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(limit + 1));
    if (!chosen.insert(drawn).second) chosen.insert(limit);
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows) {
  std::vector<layout::RowRange> ranges;
  for (const std::int64_t row : rows) {
    if (ranges.empty() || ranges.back().end() != row || ranges.back().count == max_rows_of_task)
      ranges.push_back({row, 0});
    ++ranges.back().count;
  }
  return ranges;
}

void check_trials(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                  const ChosenTrials& chosen, Equality equality) {
  add_check(report, "trials run again", [&](Check& check, ProblemList& problems) {
    if (!file.trials()) {
      check.skipped = true;
      check.detail = "the file keeps no trials";
      return;
    }
    const std::vector<std::int64_t> rows =
        layout::has_sums(study.retention) ? with_failures(chosen, *file.trials()) : chosen.rows;
    const RecordedFile recorded{file, study_run::places_of_records(*file.trials()), equality};
    run_in_tasks(study, rows, report.stop, [&](layout::RowRange range, const Results& results) {
      compare_range(recorded, range, results, problems);
    });
    check.detail = detail_of(rows.size(), file.rows().count, equality);
  });
}

}  // namespace zerocount::verification
