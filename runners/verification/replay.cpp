#include "runners/verification/replay.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <stop_token>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::verification {
namespace {

bool same(double a, double b, Equality equality, double allowed = 0.0) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  if (equality == Equality::bits) return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  return std::abs(a - b) <= std::max(allowed, 1e-9 * std::max(std::abs(a), std::abs(b)));
}

/// Absolute tolerance with which a column of a replayed trial must agree: 1e-10 rad for angles, 1e-3 count
/// for positions in counts. A position in counts is the difference of large numbers, so it has the accuracy
/// of the angle: 1e-10 rad is less than 1e-3 count for encoders of up to 60 million counts per revolution.
double allowed_in(const layout::Column& column) {
  if (column.unit == "rad") return 1e-10;
  return column.unit == "count" ? 1e-3 : 0.0;
}

/// How recorded and replayed values are compared; `what` is the word for one record in messages.
struct Comparison {
  std::string_view what;
  Equality equality;
};

/// Compares two lists of records field by field, and appends a line to `lines` for each difference.
template <class Record>
void compare(const std::vector<layout::RecordField<Record>>& fields, const std::vector<Record>& recorded,
             const std::vector<Record>& replayed, const Comparison& comparison,
             std::vector<std::string>& lines) {
  const std::string_view what = comparison.what;
  if (recorded.size() != replayed.size()) {
    lines.push_back(fmt::format("{}s: recorded {}, replayed {}", what, recorded.size(), replayed.size()));
    return;
  }
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    for (const layout::RecordField<Record>& field : fields) {
      const double before = layout::value_of(field, recorded[i]);
      const double now = layout::value_of(field, replayed[i]);
      const bool real = field.column.element == hdf5::Element::float64;
      if (real ? same(before, now, comparison.equality, allowed_in(field.column)) : before == now) continue;
      lines.push_back(
          fmt::format("{} {}: {}: recorded {}, replayed {}", what, i, field.column.name, before, now));
    }
  }
}

std::vector<layout::JerkRecord> jerk_records(const shards::TrialResult& result) {
  std::vector<layout::JerkRecord> records;
  for (const trial::Jerk& jerk : result.jerks) records.push_back({jerk, result.row});
  return records;
}

std::vector<layout::TraceRecord> trace_records(const shards::TrialResult& result) {
  std::vector<layout::TraceRecord> records;
  for (const trial::SampleRecord& record : result.trace) records.push_back({record, result.row});
  return records;
}

constexpr std::int64_t max_rows_of_task = 256;
constexpr std::size_t tasks_at_once = 64;  // bounds the memory

using Results = std::vector<shards::TrialResult>;

/// A results file whose recorded trials are compared with those that are simulated again.
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

/// Simulates trials in parallel, and calls `take` with the results of each range of rows, in ascending order.
/// @param rows numbers of the trials in the study, ascending
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

/// Rows of the trials to simulate again, for a file that keeps only failures: the chosen rows, and as many of
/// the recorded failures, drawn with equal probability. If few trials fail, hardly any failure is among the
/// chosen rows.
std::vector<std::int64_t> with_failures(const ChosenTrials& chosen, const reading::TrialTables& failures) {
  std::set<std::int64_t> rows(chosen.rows.begin(), chosen.rows.end());
  for (const std::int64_t position : sample_below(failures.count(), std::ssize(chosen.rows), chosen.seed))
    rows.insert(failures.rows({position, 1}).front());
  return {rows.begin(), rows.end()};
}

std::string detail_of(std::size_t run, std::int64_t trials, Equality equality) {
  return fmt::format("{} of {}, with inputs, measures, jerks and sample records equal {}", run, trials,
                     equality == Equality::bits
                         ? "to the bit"
                         : "to a relative 1e-9 (run by another build or on another processor)");
}

}  // namespace

Equality equality_of(const layout::FileHeader& header) {
  const layout::Provenance here = layout::current_provenance();
  const layout::Provenance& there = header.provenance;
  const bool same =
      layout::same_build(there, here) && there.compiler == here.compiler && there.cpu == here.cpu;
  return same ? Equality::bits : Equality::rounded;
}

std::vector<std::string> differences(const std::vector<study::InputColumn>& inputs,
                                     const shards::TrialResult& recorded, const shards::TrialResult& replayed,
                                     const std::vector<layout::RecordField<trial::MoveOutcome>>& measures,
                                     Equality equality) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (same(recorded.inputs.at(i), replayed.inputs.at(i), equality)) continue;
    lines.push_back(fmt::format("input {}: recorded {}, replayed {}", inputs[i].name, recorded.inputs[i],
                                replayed.inputs[i]));
  }
  compare(measures, recorded.outcome.moves, replayed.outcome.moves, {"move", equality}, lines);
  compare(layout::jerk_fields(), jerk_records(recorded), jerk_records(replayed), {"jerk", equality}, lines);
  return lines;
}

std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult* recorded,
                                                 const shards::TrialResult& replayed, Equality equality) {
  const bool kept = !layout::has_sums(file.header().retention) || !trial::succeeded(replayed.outcome.moves);
  if (kept != (recorded != nullptr)) {
    return {fmt::format("recorded as a {}, replayed as a {}", kept ? "success" : "failure",
                        kept ? "failure" : "success")};
  }
  if (!recorded) return {};
  const reading::TrialTables& trials = *file.trials();
  std::vector<std::string> lines =
      differences(trials.input_columns(), *recorded, replayed, trials.measures(), equality);
  if (!recorded->trace.empty()) {
    compare(layout::trace_fields(trials.features()), trace_records(*recorded), trace_records(replayed),
            {"record", equality}, lines);
  }
  return lines;
}

std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality) {
  if (!file.trials()) return {};
  const std::vector<shards::TrialResult> recorded =
      study_run::read_trials(*file.trials(), {replayed.row, 1}, replayed.row, {});
  return differences_from_record(file, recorded.empty() ? nullptr : &recorded.front(), replayed, equality);
}

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
