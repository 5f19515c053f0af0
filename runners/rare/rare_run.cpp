#include "runners/rare/rare_run.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "runners/status/status.hpp"

namespace zerocount::rare {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double seconds_between_writes = 60.0;

/// Text that says how the question recorded in a file differs from this one; empty if it does not differ.
std::string difference(const fs::path& file, const RareRecord& record, const Question& question) {
  if (record.header.study_sha256 != question.whole.study_sha256)
    return fmt::format("its study differs: {}", manifest_text::differences_text(layout::study_differences(
                                                    file, record.header, question.whole)));
  if (record.of.point != question.of.point) return "its design point differs";
  if (record.of.world != question.of.world) return "its world differs";
  if (record.of.setting != question.of.setting) return "its condition differs";
  if (record.event != question.event.text) return "its event differs";
  if (!layout::same_build(record.header.provenance, layout::current_provenance()))
    return "it was made by another build of the program";
  return "";
}

/// Record of an earlier run in the file settings.output, from which this run resumes; nothing if there is
/// none.
std::optional<RareRecord> earlier_record(const Question& question, const RareSettings& settings) {
  std::error_code error;
  if (settings.output.empty() || !fs::exists(settings.output, error) || settings.force) return std::nullopt;
  std::string problem = "it is not an estimate of 'zerocount rare'";
  if (is_rare_file(settings.output)) {
    RareRecord record = read_rare_file(settings.output);
    problem = difference(settings.output, record, question);
    if (problem.empty()) return record;
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: exists already, and {}; expected another FILE, or --force to replace it",
                            settings.output.string(), problem));
}

/// Text of the status line of a running estimate.
std::string progress_text(const ProbabilityEstimate& estimate, const EstimatorState& state) {
  if (!state.learned) return fmt::format("learns where failures are: {} trials", state.trials);
  return fmt::format("{} trials: {:.2g} [{:.2g}, {:.2g}]", state.trials, estimate.probability,
                     estimate.bounds.low, estimate.bounds.high);
}

/// Adds to the answer how the inputs of failing trials differ from all trials, and the failure rates of the
/// machines on which failures occur.
void describe_failures(const trials::Effort& effort, RareAnswer& answer) {
  try {
    answer.inputs = failure_inputs(answer.question, answer.state);
    answer.machines = carrying_machines(answer.question, answer.state, answer.estimate.probability, effort);
  } catch (const trial::Interrupted&) {
    answer.machines.reset();  // the answer does not rest on them
  }
}

}  // namespace

RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop) {
  const EstimatorSettings estimator{question.space, measures::move_scores.size(), settings.confidence,
                                    settings.ratio, question.study.seed};
  const trials::Effort whole(stop);
  const trials::Effort effort = whole.limited_to({}, settings.seconds);
  RareAnswer answer{question, settings};
  double earlier_seconds = 0.0;
  if (std::optional<RareRecord> earlier = earlier_record(question, settings)) {
    answer.state = std::move(earlier->state);
    earlier_seconds = earlier->seconds;
  }
  const Clock::time_point start = Clock::now();
  const auto elapsed = [&] {
    return earlier_seconds + std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto take_estimate = [&] {
    answer.estimate = answer_of(answer.state, estimator);
    answer.seconds = elapsed();
  };
  const auto write = [&] {
    if (!settings.output.empty()) write_rare_file(answer);
  };
  status::StatusLine line(settings.quiet);
  double next_write = earlier_seconds + seconds_between_writes;
  std::int64_t run = 0;  // trials, of this run
  const auto simulate = [&](std::span<Trial> trials) {
    run += std::ssize(trials);
    run_trials(question, trials, effort);
  };
  const auto goes_on = [&](const EstimatorState& state) {
    line.show([&] { return progress_text(answer_of(state, estimator), state); });
    if (state.learned && elapsed() > next_write) {
      // Keeps the trials so far. Writing takes a tenth of the time at most.
      take_estimate();
      write();
      next_write = elapsed() + std::max(seconds_between_writes, 9.0 * (elapsed() - answer.seconds));
    }
    return (!settings.max_trials || run < *settings.max_trials) && !effort.is_spent();
  };
  try {
    estimate(answer.state, estimator, simulate, goes_on);
  } catch (const trial::Interrupted&) {
    // The state is as it was before the trials that were in work.
  }
  take_estimate();
  if (whole.is_interrupted()) {
    if (answer.state.learned) write();
    throw Failure(ExitCode::interrupted,
                  answer.state.learned
                      ? fmt::format("interrupted: {} holds the trials so far; the same command goes on",
                                    settings.output.string())
                      : "interrupted while it learned where failures are: nothing was written");
  }
  describe_failures(whole, answer);
  write();
  line.finish("");
  return answer;
}

}  // namespace zerocount::rare
