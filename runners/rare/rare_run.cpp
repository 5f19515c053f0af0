#include "runners/rare/rare_run.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "runners/rare/rare_answer.hpp"
#include "runners/rare/rare_file.hpp"
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

class RareRun {
 public:
  RareRun(const Question& question, const RareSettings& settings, const std::stop_token& stop)
      : question_(question),
        settings_(settings),
        whole_(stop),
        effort_(whole_.share({}, settings.seconds)),
        line_(settings.quiet) {
    answer_.confidence = settings.confidence;
    answer_.max_trials = settings.max_trials;
    answer_.max_seconds = settings.seconds;
    if (std::optional<RareRecord> earlier = earlier_record(question, settings)) {
      answer_.state = std::move(earlier->state);
      earlier_seconds_ = earlier->seconds;
      next_write_ += earlier_seconds_;
    }
  }

  RareAnswer run() {
    const EstimatorSettings settings = estimator_settings();
    try {
      const Simulation simulate = simulation_of(question_, effort_);
      estimate(
          answer_.state, settings,
          [&](std::span<const TrialPoint> points) {
            trials_ += std::ssize(points);
            return simulate(points);
          },
          [this](const EstimatorState& state) { return goes_on(state); });
    } catch (const trial::Interrupted&) {
      // The state is as it was before the trials that were in work.
    }
    answer_.estimate = answer_of(answer_.state, settings);
    answer_.seconds = elapsed();
    if (whole_.is_interrupted()) {
      if (answer_.state.learned) write();
      throw Failure(ExitCode::interrupted,
                    answer_.state.learned
                        ? fmt::format("interrupted: {} holds the trials so far; the same command goes on",
                                      settings_.output.string())
                        : "interrupted while it learned where failures are: nothing was written");
    }
    describe();
    write();
    line_.finish("");
    return std::move(answer_);
  }

 private:
  EstimatorSettings estimator_settings() const {
    EstimatorSettings settings;
    settings.space = question_.space;
    settings.scores = measures::move_scores.size();
    settings.confidence = settings_.confidence;
    settings.ratio = settings_.ratio;
    settings.seed = question_.study.seed;
    return settings;
  }

  /// Seconds, those of earlier runs included.
  double elapsed() const {
    return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  bool goes_on(const EstimatorState& state) {
    line_.show([&] { return progress_text(answer_of(state, estimator_settings()), state); });
    if (state.learned && elapsed() > next_write_) write_meanwhile(state);
    const bool has_trials = !settings_.max_trials || trials_ < *settings_.max_trials;
    return has_trials && !effort_.is_spent();
  }

  /// Keeps the trials so far. Writing takes a tenth of the time at most.
  void write_meanwhile(const EstimatorState& state) {
    answer_.estimate = answer_of(state, estimator_settings());
    answer_.seconds = elapsed();
    write();
    const double taken = elapsed() - answer_.seconds;
    next_write_ = elapsed() + std::max(seconds_between_writes, 9.0 * taken);
  }

  void describe() {
    try {
      answer_.inputs = failure_inputs(question_, answer_.state);
      answer_.machines = carrying_machines(question_, answer_.state, answer_.estimate.probability, whole_);
    } catch (const trial::Interrupted&) {
      answer_.machines.reset();  // the answer does not rest on them
    }
  }

  void write() const {
    if (settings_.output.empty()) return;
    const document::Description<RareReading> description = rare_description();
    const document::Members contents =
        description.members_of(RareReading{answer_, question_, settings_.output});
    write_rare_file(settings_.output, question_, answer_.state, answer_.seconds,
                    document::json(description.items(), contents));
  }

  const Question& question_;
  const RareSettings& settings_;
  trials::Effort whole_;
  trials::Effort effort_;  ///< with the limit of time
  status::StatusLine line_;
  Clock::time_point start_{Clock::now()};
  double earlier_seconds_{0.0};
  double next_write_{seconds_between_writes};  ///< s, by elapsed()
  std::int64_t trials_{0};                     ///< of this run
  RareAnswer answer_;
};

}  // namespace

RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop) {
  return RareRun(question, settings, stop).run();
}

}  // namespace zerocount::rare
