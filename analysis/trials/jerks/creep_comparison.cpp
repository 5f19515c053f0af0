#include "analysis/trials/jerks/creep_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "analysis/basis/statistics/quantile.hpp"
#include "core/friction/presliding/creep.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::jerks {
namespace {

template <class Entry>
bool has_creep_parameter(const std::vector<Entry>& entries) {
  return std::any_of(entries.begin(), entries.end(), [](const Entry& entry) {
    return entry.parameter == &friction::FrictionParameters::alpha ||
           entry.parameter == &friction::FrictionParameters::lambda ||
           entry.parameter == &friction::FrictionParameters::n;
  });
}

std::string why_not(const trial::TrialParameters& parameters) {
  if (parameters.controller.user.plugin)
    return "the controller is a plugin, which this command does not load";
  if (!friction::has_creep(parameters.friction.model) || parameters.friction.uniform.alpha == 0.0)
    return "the friction does not creep";
  if (has_creep_parameter(parameters.friction.profiled)) return "a creep parameter varies along the rotor";
  if (has_creep_parameter(parameters.friction.per_contact)) {
    return "a creep parameter differs between contacts";
  }
  if (parameters.dac.noise != 0.0) return "the converter has noise";
  if (loop::has_errors(parameters.encoder.fine_errors)) return "the encoder has errors";
  if (parameters.controller.encoder != loop::EncoderChoice::fine) return "the coarse encoder closes the loop";
  return {};
}

/// Predicted time from `state` to the beginning of a jerk, s, by the closed form of creep; infinite if no
/// jerk is predicted.
double time_to_edge(const trial::TrialParameters& parameters, const trial::SampleRecord& state) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const friction::FrictionParameters& friction = parameters.friction.uniform;
  const double torque = state.drive_torque;
  const double room = friction::hardening_limit(friction, torque) - state.xh;
  if (!(room > 0.0)) return never;
  const double count = loop::fine_resolution(parameters.encoder);
  const double edges_passed = static_cast<double>(state.target) + (torque > 0.0 ? 1.0 : 0.0);
  const double distance = std::abs((edges_passed - parameters.initial.encoder_phase) * count - state.theta);
  return distance < room ? -std::log1p(-distance / room) / friction.alpha : never;
}

/// Collects the waits of one trial from its samples: intervals of zero error after arrival, up to the next
/// jerk or the end of the move.
class WaitFollower {
 public:
  WaitFollower(const trial::TrialParameters& parameters, std::int64_t trial, CreepComparison& comparison)
      : parameters_(parameters),
        trial_(trial),
        comparison_(comparison),
        rate_(parameters.controller.sample_rate),
        dwell_(trial::samples_in(parameters.verdict.dwell, rate_)),
        move_end_(trial::samples_of_move(parameters, 0)) {}

  void take(const trial::SampleRecord& sample) {
    if (sample.k == move_end_) next_move();
    last_ = sample.k;
    const std::int64_t k = sample.k - move_start_;
    if (sample.error != 0) {
      if (arrived_) close(k, true);
      zeros_ = 0;
      return;
    }
    ++zeros_;
    if (zeros_ == dwell_ && !arrived_) {
      arrived_ = true;
      first_ = true;
    }
    // One sample after the dwell, because a torque acts during the following sample.
    if (arrived_ && zeros_ == dwell_ + 1) state_ = sample;
    const bool constant =
        state_ && sample.drive_torque == state_->drive_torque && sample.mode == trial::HookMode::stick;
    if (state_ && !constant) steady_ = false;
  }

  /// Ends the current move; the sample taken last is its last one.
  void finish() {
    if (arrived_) close(last_ + 1 - move_start_, false);
  }

 private:
  void next_move() {
    finish();
    ++move_;
    move_start_ = move_end_;
    move_end_ += trial::samples_of_move(parameters_, static_cast<std::size_t>(move_));
    zeros_ = 0;
    arrived_ = false;
  }

  /// Ends the current wait, if there is one, at sample `k` of the move.
  /// @param by_jerk true if a jerk ended it, false if the move did
  void close(std::int64_t k, bool by_jerk) {
    if (zeros_ > 0 && !state_) ++comparison_.too_short;
    if (state_ && !steady_) ++comparison_.unsteady;
    if (state_ && steady_) {
      CreepWait wait{.trial = trial_, .move = move_, .first = first_};
      wait.since = static_cast<double>(state_->k - move_start_) / rate_;
      wait.end = static_cast<double>(k) / rate_;
      if (by_jerk) wait.onset = wait.end;
      wait.predicted = wait.since + time_to_edge(parameters_, *state_);
      comparison_.waits.push_back(wait);
    }
    state_.reset();
    steady_ = true;
    first_ = false;
  }

  const trial::TrialParameters& parameters_;
  std::int64_t trial_;
  CreepComparison& comparison_;
  double rate_;
  std::int64_t dwell_;
  std::int64_t move_start_{0}, move_end_, move_{0};
  std::int64_t zeros_{0}, last_{-1};
  bool arrived_{false}, first_{false}, steady_{true};
  std::optional<trial::SampleRecord> state_;
};

}  // namespace

CreepComparison compare_with_creep(const study::Study& study, std::int64_t point, std::int64_t trials) {
  CreepComparison comparison;
  for (std::int64_t index = 0; index < std::min(trials, study.trials); ++index) {
    const trial::TrialParameters parameters = study::study_trial(study, point, index).parameters;
    comparison.not_applicable = why_not(parameters);
    if (!comparison.not_applicable.empty()) return comparison;
    WaitFollower follower(parameters, index, comparison);
    trial::run_trial(parameters, {.sample = [&](const trial::SampleRecord& sample) { follower.take(sample); },
                                  .jerk = {}});
    follower.finish();
    ++comparison.trials;
  }
  return comparison;
}

CreepAgreement agreement_of(const CreepComparison& comparison, double sample_time) {
  CreepAgreement agreement;
  std::vector<double> deviations;
  for (const CreepWait& wait : comparison.waits) {
    const double allowed = 2.0 * sample_time + 0.01 * (wait.end - wait.since);
    if (std::isnan(wait.onset)) {
      ++agreement.lasting;
      agreement.lasting_predicted += wait.predicted > wait.end - allowed;
    } else {
      ++agreement.ended;
      deviations.push_back(std::abs(wait.onset - wait.predicted));
      agreement.predicted += deviations.back() <= allowed;
    }
  }
  if (deviations.empty()) return agreement;
  agreement.largest_deviation = std::ranges::max(deviations);
  agreement.median_deviation = statistics::sample_quantile(std::move(deviations), 0.5);
  return agreement;
}

}  // namespace zerocount::jerks
