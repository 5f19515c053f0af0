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

/// In what the file's question differs from this one; empty if it does not.
std::string difference(const fs::path& file, const RareRecord& record, const Question& question) {
  if (record.header.study_sha256 != question.whole.study_sha256)
    return fmt::format("its study is another: {}", manifest_text::differences_text(layout::study_differences(
                                                       file, record.header, question.whole)));
  if (record.of.point != question.of.point) return "it is of another design point";
  if (record.of.world != question.of.world) return "it is of another world";
  if (record.of.condition != question.of.condition) return "it is of another condition";
  if (record.event != question.event.text) return "it is of another event";
  if (!layout::same_build(record.header.provenance, layout::current_provenance()))
    return "it was made by another build of the program";
  return "";
}

/// The record from which this run goes on, if there is one.
std::optional<RareRecord> earlier_record(const Question& question, const RareSettings& settings) {
  std::error_code error;
  if (settings.output.empty() || !fs::exists(settings.output, error) || settings.force) return std::nullopt;
  std::string problem = "it is no estimate of 'zerocount rare'";
  if (is_rare_file(settings.output)) {
    RareRecord record = read_rare_file(settings.output);
    problem = difference(settings.output, record, question);
    if (problem.empty()) return record;
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: exists already, and {}; expected another FILE, or --force to replace it",
                            settings.output.string(), problem));
}

/// One line while the estimate goes on.
std::string progress_text(const Estimate& estimate, const EstimatorState& state) {
  if (!state.learned) return fmt::format("learns where failures are: {} trials", state.trials);
  return fmt::format("{} trials: {:.2g} [{:.2g}, {:.2g}]", state.trials, estimate.probability,
                     estimate.bounds.low, estimate.bounds.high);
}

class RareRun {
 public:
  RareRun(const Question& question, const RareSettings& settings, const std::stop_token& stop)
      : answer_{question, settings},
        estimator_{question.space, measures::move_scores.size(), settings.confidence, settings.ratio,
                   question.study.seed},
        whole_(stop),
        effort_(whole_.share({}, settings.seconds)),
        line_(settings.quiet) {
    if (std::optional<RareRecord> earlier = earlier_record(question, settings)) {
      answer_.state = std::move(earlier->state);
      earlier_seconds_ = earlier->seconds;
      next_write_ += earlier_seconds_;
    }
  }

  RareAnswer run() {
    try {
      estimate(
          answer_.state, estimator_,
          [this](std::span<Trial> trials) {
            trials_ += std::ssize(trials);
            run_trials(answer_.question, trials, effort_);
          },
          [this](const EstimatorState&) { return goes_on(); });
    } catch (const trial::Interrupted&) {
      // The state is as it was before the trials that were in work.
    }
    take_estimate();
    if (whole_.is_interrupted()) {
      if (answer_.state.learned) write();
      throw Failure(ExitCode::interrupted,
                    answer_.state.learned
                        ? fmt::format("interrupted: {} holds the trials so far; the same command goes on",
                                      answer_.settings.output.string())
                        : "interrupted while it learned where failures are: nothing was written");
    }
    describe();
    write();
    line_.finish("");
    return std::move(answer_);
  }

 private:
  /// Seconds, those of earlier runs included.
  double elapsed() const {
    return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  void take_estimate() {
    answer_.estimate = answer_of(answer_.state, estimator_);
    answer_.seconds = elapsed();
  }

  bool goes_on() {
    const EstimatorState& state = answer_.state;
    line_.show([&] { return progress_text(answer_of(state, estimator_), state); });
    if (state.learned && elapsed() > next_write_) {
      // Keeps the trials so far. Writing takes a tenth of the time at most.
      take_estimate();
      write();
      next_write_ = elapsed() + std::max(seconds_between_writes, 9.0 * (elapsed() - answer_.seconds));
    }
    const std::optional<std::int64_t>& most = answer_.settings.max_trials;
    return (!most || trials_ < *most) && !effort_.is_spent();
  }

  void describe() {
    const Question& question = answer_.question;
    try {
      answer_.inputs = failure_inputs(question, answer_.state);
      answer_.machines = carrying_machines(question, answer_.state, answer_.estimate.probability, whole_);
    } catch (const trial::Interrupted&) {
      answer_.machines.reset();  // the answer does not rest on them
    }
  }

  void write() const {
    if (!answer_.settings.output.empty()) write_rare_file(answer_);
  }

  RareAnswer answer_;
  EstimatorSettings estimator_;
  trials::Effort whole_;
  trials::Effort effort_;  ///< with the limit of time
  status::StatusLine line_;
  Clock::time_point start_{Clock::now()};
  double earlier_seconds_{0.0};
  double next_write_{seconds_between_writes};  ///< s, by elapsed()
  std::int64_t trials_{0};                     ///< of this run
};

}  // namespace

RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop) {
  return RareRun(question, settings, stop).run();
}

}  // namespace zerocount::rare
