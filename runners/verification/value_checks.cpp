#include "runners/verification/value_checks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "analysis/summary/summed_point.hpp"
#include "core/trial/parameters.hpp"
#include "results/layout/fields.hpp"
#include "results/reading/input_validation.hpp"

namespace zerocount::verification {
namespace {

/// Trials that are checked together.
struct Block {
  layout::RowRange positions;
  std::vector<std::int64_t> rows;
  std::vector<double> durations;  ///< [trial][move] of the moves, s
};

std::vector<double> durations_of(const study::Study& study, const std::vector<std::int64_t>& rows) {
  std::vector<double> durations(rows.size() * static_cast<std::size_t>(study.moves));
  oneapi::tbb::parallel_for(std::int64_t{0}, std::ssize(rows), [&](std::int64_t i) {
    const std::int64_t row = rows[static_cast<std::size_t>(i)];
    const trial::TrialParameters parameters =
        study::study_trial(study, row / study.trials, row % study.trials).parameters;
    for (std::int64_t move = 0; move < study.moves; ++move) {
      const auto samples =
          static_cast<double>(trial::samples_of_move(parameters, static_cast<std::size_t>(move)));
      durations[static_cast<std::size_t>(i * study.moves + move)] =
          samples / parameters.controller.sample_rate;
    }
  });
  return durations;
}

/// The allowance for a sample time that has no exact representation.
constexpr double longest = 1.0 + 1e-12;

/// The values have passed the checks of the layout: times are not negative.
void check_times(const reading::TrialTables& trials, const Block& block,
                 const std::vector<trial::MoveOutcome>& moves, ProblemList& problems) {
  for (const layout::RecordField<trial::MoveOutcome>& field : trials.measures()) {
    if (field.column.unit != "s") continue;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const double value = layout::value_of(field, moves[i]);
      if (!(value > block.durations[i] * longest)) continue;  // a NaN is not longer
      const std::int64_t at = static_cast<std::int64_t>(i);
      problems.add(fmt::format("/outcome/{}: trial {}, move {}: it is {} s; the move lasts {} s",
                               field.column.name, block.rows[static_cast<std::size_t>(at / trials.moves())],
                               at % trials.moves(), value, block.durations[i]));
    }
  }
}

void check_jerk_times(const reading::TrialTables& trials, const Block& block, ProblemList& problems) {
  const std::int64_t first = block.rows.front();
  for (const layout::JerkRecord& jerk : trials.jerks_of({first, block.rows.back() + 1 - first})) {
    const auto row = std::lower_bound(block.rows.begin(), block.rows.end(), jerk.trial);
    if (row == block.rows.end() || *row != jerk.trial) {
      problems.add(fmt::format("/jerk/trial: trial {}: it is not among the kept trials", jerk.trial));
      continue;
    }
    const auto move = static_cast<std::size_t>((row - block.rows.begin()) * trials.moves() + jerk.move);
    if (jerk.onset + jerk.duration <= block.durations[move] * longest) continue;
    problems.add(
        fmt::format("/jerk/duration: trial {}, move {}: it is from {} s to {} s; the move lasts {} s",
                    jerk.trial, jerk.move, jerk.onset, jerk.onset + jerk.duration, block.durations[move]));
  }
}

void check_block(const reading::ResultsFile& file, const study::Study& study, layout::RowRange positions,
                 ProblemList& problems) {
  const reading::TrialTables& trials = *file.trials();
  reading::check_inputs(trials, study, positions,
                        [&](std::string problem) { problems.add(std::move(problem)); });
  try {
    Block block{positions, trials.rows(positions), {}};
    block.durations = durations_of(study, block.rows);
    const std::vector<trial::MoveOutcome> moves = trials.outcomes(positions);
    check_times(trials, block, moves, problems);
    check_jerk_times(trials, block, problems);
    if (!layout::has_sums(study.retention)) return;
    std::span<const trial::MoveOutcome> rest = moves;
    for (const std::int64_t row : block.rows) {
      if (trial::succeeded(rest.first(static_cast<std::size_t>(trials.moves()))))
        problems.add(fmt::format("trial {}: kept as a failure; all its moves ended at zero", row));
      rest = rest.subspan(static_cast<std::size_t>(trials.moves()));
    }
  } catch (const Failure& failure) {  // the first of these trials; others may have more
    if (failure.code() == ExitCode::machine_failed) throw;
    problems.add(problem_of(failure, file.path()));
  }
}

/// The sums can be those of the trials, and count the failures that the file keeps.
void check_sums(const reading::ResultsFile& file, const study::Study& study, ProblemList& problems) {
  for (std::int64_t i = 0; i < file.points(); ++i) {
    const std::int64_t point = file.first_point() + i;
    const std::int64_t expected = summary::restored_point(file, study, point).failures();
    if (!file.trials()) continue;
    const std::int64_t count = file.trials()->positions_of(file.rows_of(point)).count;
    if (count == expected) continue;
    problems.add(
        fmt::format("design point {}: {} failures; expected the {} of its sums", point, count, expected));
  }
}

}  // namespace

void check_values(CheckReport& report, const reading::ResultsFile& file, const study::Study& study) {
  add_check(report, "values", [&](Check& check, ProblemList& problems) {
    std::vector<std::string> details;
    if (layout::has_sums(study.retention)) {
      check_sums(file, study, problems);
      details.emplace_back("sums");
    }
    if (file.trials()) {
      file.trials()->for_each_block([&](layout::RowRange positions) {
        require_no_stop(report.stop);
        check_block(file, study, positions, problems);
      });
      details.push_back(
          fmt::format("{} trials, {} jerks", file.trials()->count(), file.trials()->jerk_count()));
    }
    check.detail = fmt::format("{}", fmt::join(details, ", "));
  });
}

}  // namespace zerocount::verification
