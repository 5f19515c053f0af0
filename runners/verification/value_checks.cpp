#include "runners/verification/value_checks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/trial/parameters.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/input_validation.hpp"

namespace zerocount::verification {
namespace {

/// [row][move] the durations of the moves, s.
std::vector<double> durations_of(const study::Study& study, layout::RowRange rows) {
  std::vector<double> durations(static_cast<std::size_t>(rows.count * study.moves));
  oneapi::tbb::parallel_for(std::int64_t{0}, rows.count, [&](std::int64_t i) {
    const std::int64_t row = rows.first + i;
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
void check_times(const reading::StudyFile& file, layout::RowRange rows, const std::vector<double>& durations,
                 const std::vector<trial::MoveOutcome>& moves, ProblemList& problems) {
  for (const layout::RecordField<trial::MoveOutcome>& field : file.measures()) {
    if (field.column.unit != "s") continue;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const double value = layout::value_of(field, moves[i]);
      if (!(value > durations[i] * longest)) continue;  // a NaN is not longer
      const std::int64_t at = static_cast<std::int64_t>(i);
      problems.add(fmt::format("/outcome/{}: trial {}, move {}: it is {} s; the move lasts {} s",
                               field.column.name, rows.first + at / file.moves(), at % file.moves(), value,
                               durations[i]));
    }
  }
}

void check_jerk_times(const reading::StudyFile& file, layout::RowRange rows,
                      const std::vector<double>& durations, ProblemList& problems) {
  for (const layout::JerkRecord& jerk : file.jerks(rows)) {
    const auto move = static_cast<std::size_t>((jerk.trial - rows.first) * file.moves() + jerk.move);
    if (jerk.onset + jerk.duration <= durations[move] * longest) continue;
    problems.add(
        fmt::format("/jerk/duration: trial {}, move {}: it is from {} s to {} s; the move lasts {} s",
                    jerk.trial, jerk.move, jerk.onset, jerk.onset + jerk.duration, durations[move]));
  }
}

}  // namespace

void check_values(CheckReport& report, const reading::StudyFile& file, const study::Study& study) {
  add_check(report, "values", [&](Check& check, ProblemList& problems) {
    const std::int64_t at_once = layout::chunk_rows(file.moves());
    for (std::int64_t first = file.rows().first; first < file.rows().end(); first += at_once) {
      const layout::RowRange rows{first, std::min(at_once, file.rows().end() - first)};
      reading::check_inputs(file, study, rows,
                            [&](std::string problem) { problems.add(std::move(problem)); });
      const std::vector<double> durations = durations_of(study, rows);
      try {
        check_times(file, rows, durations, file.outcomes(rows), problems);
        check_jerk_times(file, rows, durations, problems);
      } catch (const Failure& failure) {  // the first of these trials; others may have more
        if (failure.code() == ExitCode::machine_failed) throw;
        problems.add(problem_of(failure, file.path()));
      }
    }
    check.detail = fmt::format("{} trials, {} jerks", file.rows().count, file.jerk_count());
  });
}

}  // namespace zerocount::verification
