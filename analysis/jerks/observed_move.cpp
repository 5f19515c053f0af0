#include "analysis/jerks/observed_move.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/divergence.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::jerks {
namespace {

[[noreturn]] void fail(const reading::AllTrialsFile& file, std::int64_t row, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: trial {}: {}", file.path().string(), row, what));
}

/// The timing parameters of the trials of a point. Drawn only once if they are the same in all trials.
class Timings {
 public:
  Timings(const study::Study& study, std::int64_t point) : study_(study), point_(point) {
    const std::vector<study::InputColumn>& inputs = study.columns.inputs;
    vary_ = std::any_of(inputs.begin(), inputs.end(), [](const study::InputColumn& input) {
      return input.name == "controller.sample_rate" || input.name == "command.hold" ||
             input.name == "verdict.dwell";
    });
    parameters_ = study::study_trial(study, point, 0).parameters;
  }

  const trial::TrialParameters& of(std::int64_t index) {
    if (vary_) parameters_ = study::study_trial(study_, point_, index).parameters;
    return parameters_;
  }

 private:
  const study::Study& study_;
  std::int64_t point_;
  bool vary_{false};
  trial::TrialParameters parameters_;
};

SampledJerk sampled(const trial::Jerk& jerk, const trial::MoveOutcome& move, double sample_rate) {
  return {std::llround(jerk.onset * sample_rate) - move.arrival, std::llround(jerk.duration * sample_rate),
          jerk.magnitude, jerk.direction == numerics::sign_of(move.holding_torque)};
}

/// A move that was stopped early had diverged: it counts as a jerk that lasted to the end.
std::int64_t observed_end(const ObservedMove& observed, const trial::MoveOutcome& move,
                          std::int64_t samples) {
  if (!move.stopped || observed.jerks.empty()) return samples - move.arrival;
  return observed.jerks.back().onset + observed.jerks.back().length;
}

bool in_order(const ObservedMove& move) {
  std::int64_t at_risk = move.dwell;
  for (const SampledJerk& jerk : move.jerks) {
    if (jerk.onset < at_risk || jerk.length < 1 || jerk.onset + jerk.length > move.end) return false;
    at_risk = jerk.onset + jerk.length + 1;
  }
  return true;
}

ObservedMove observe(const trial::TrialParameters& parameters, std::size_t index,
                     const trial::MoveOutcome& move, std::span<const layout::JerkRecord> jerks) {
  const double rate = parameters.controller.sample_rate;
  ObservedMove observed;
  observed.arrived = move.arrived;
  observed.lost = move.outcome == trial::Outcome::nonfinite;
  observed.sample_time = 1.0 / rate;
  observed.dwell = trial::samples_in(parameters.verdict.dwell, rate);
  for (const layout::JerkRecord& jerk : jerks) observed.jerks.push_back(sampled(jerk, move, rate));
  observed.end = observed_end(observed, move, trial::samples_of_move(parameters, index));
  return observed;
}

}  // namespace

void for_each_run_at_risk(const ObservedMove& move,
                          const std::function<void(std::int64_t, std::int64_t)>& take) {
  std::int64_t first = move.dwell;
  for (const SampledJerk& jerk : move.jerks) {
    take(first, jerk.onset + 1);
    first = jerk.onset + jerk.length + 1;
  }
  if (first < move.end) take(first, move.end);
}

void for_each_move(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                   const std::function<void(const ObservedMove&)>& take) {
  const std::int64_t moves = file.moves();
  const std::int64_t trials = file.header().trials;
  const std::int64_t begin = point * trials;
  const std::int64_t end = begin + trials;
  Timings timings(study, point);
  for (std::int64_t first = begin; first < end; first += layout::chunk_rows(moves)) {
    const layout::RowRange block{first, std::min(layout::chunk_rows(moves), end - first)};
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes(block);
    const std::vector<layout::JerkRecord> jerks = file.jerks(block);
    std::size_t next = 0;
    for (std::int64_t i = 0; i < block.count * moves; ++i) {
      const std::int64_t row = block.first + i / moves;
      const trial::MoveOutcome& move = outcomes[static_cast<std::size_t>(i)];
      const std::size_t start = next;
      while (next < jerks.size() && jerks[next].trial == row && jerks[next].move == i % moves) ++next;
      const std::span<const layout::JerkRecord> own = std::span(jerks).subspan(start, next - start);
      if (std::ssize(own) != move.jerk_count) {
        fail(file, row,
             fmt::format("{} jerks recorded of a move that counted {}", own.size(), move.jerk_count));
      }
      ObservedMove observed =
          observe(timings.of(row - begin), static_cast<std::size_t>(i % moves), move, own);
      observed.trial = row;
      observed.cluster = study.rigs > 0 ? study::rig_of(study, row - begin) : row;
      if (observed.arrived && !observed.lost && !in_order(observed)) {
        fail(file, row, "jerks that are not in order, or outside the time of their move");
      }
      take(observed);
    }
    if (next != jerks.size()) fail(file, jerks[next].trial, "jerks beyond those that its moves counted");
  }
}

}  // namespace zerocount::jerks
