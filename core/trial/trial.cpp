#include "core/trial/trial.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/pid.hpp"
#include "core/plant/plant.hpp"
#include "core/trial/move_measures.hpp"

namespace zerocount {
namespace {

/// Fraction of a fine count that the motion may leave out per torque step. Far below the accuracy asked for,
/// because a trial that breaks away in every cycle of its ringing multiplies an error from cycle to cycle.
constexpr double motion_tolerance_in_counts = 1e-11;

/// Farther than this, counts are no longer whole numbers of a double.
constexpr double most_counts = 0x1p52;

/// Torques on their way from decision to motor: zero until the first has come through.
class DelayLine {
 public:
  explicit DelayLine(int samples) : waiting_(static_cast<std::size_t>(samples), 0.0) {}

  double pass(double torque) {
    if (waiting_.empty()) return torque;
    std::swap(torque, waiting_[oldest_]);
    oldest_ = (oldest_ + 1) % waiting_.size();
    return torque;
  }

 private:
  std::vector<double> waiting_;
  std::size_t oldest_{0};
};

/// The loop of one trial. One sample is: read, decide, hold.
class Loop {
 public:
  explicit Loop(const TrialParameters& p)
      : fine_(make_encoder(p.encoder.fine, p.initial.encoder_phase)),
        coarse_(make_encoder(p.encoder.coarse, p.initial.encoder_phase)),
        dac_(p.dac),
        controller_(p.controller, static_cast<double>(lowest_code(p.dac)) * p.dac.resolution,
                    static_cast<double>(highest_code(p.dac)) * p.dac.resolution),
        delay_(p.controller.delay),
        sample_time_(1.0 / p.controller.sample_rate),
        plant_(p.plant, p.friction, p.initial.position, p.initial.hardening, p.initial.preload,
               MotionTolerance{motion_tolerance_in_counts * fine_.resolution}) {}

  /// Reads the encoders at t_k and decides the torque.
  SampleRecord decide(std::int64_t k, std::int64_t target) {
    SampleRecord record;
    record.k = k;
    record.t = static_cast<double>(k) * sample_time_;
    record.target = target;
    record.theta = plant_.theta();
    record.omega = plant_.omega();
    record.count = read_count(fine_, record.theta);
    record.coarse_count = read_count(coarse_, record.theta);
    record.error = target - record.count;
    const DacOutput output = convert(dac_, controller_.update(target, record.count));
    record.code = output.code;
    record.torque = output.torque;
    record.xp = plant_.creep().extension;
    record.xh = plant_.creep().hardening;
    record.depth = static_cast<std::int64_t>(plant_.spring().depth());
    record.mode = plant_.sliding() ? HookMode::slide : HookMode::stick;
    clipped_ = output.clipped;
    return record;
  }

  /// Holds the torque that has come through the delay until t_{k+1}.
  void hold(double decided_torque) { plant_.advance(delay_.pass(decided_torque), sample_time_); }

  /// Whether the motion is still finite, and within what the counters can count.
  bool readable() const {
    return plant_.finite() &&
           std::abs(plant_.theta()) < most_counts * std::min(fine_.resolution, coarse_.resolution);
  }

  bool clipped() const { return clipped_; }
  Plant& plant() { return plant_; }

 private:
  Encoder fine_;
  Encoder coarse_;
  DacParameters dac_;
  PidController controller_;
  DelayLine delay_;
  double sample_time_;
  Plant plant_;
  bool clipped_{false};
};

MoveOutcome run_move(Loop& loop, const MoveTiming& timing, std::int64_t move, std::int64_t target,
                     const TrialObservers& observers) {
  MoveMeasures measures(timing, move);
  Plant& plant = loop.plant();
  plant.forget_deepest();
  const std::int64_t breakaways_before = plant.breakaways();
  const bool sliding_before = plant.sliding();
  for (std::int64_t i = 0; i < timing.samples && loop.readable(); ++i) {
    const SampleRecord record = loop.decide(move * timing.samples + i, target);
    if (observers.sample) observers.sample(record);
    const bool jerk_ended =
        measures.add({target, record.count, record.torque, loop.clipped(), record.theta, record.xp});
    if (jerk_ended && observers.jerk) observers.jerk(measures.last_jerk());
    loop.hold(record.torque);
  }
  const bool slid = sliding_before || plant.breakaways() > breakaways_before;
  const bool jerk_cut = measures.finish(slid, plant.deepest(), loop.readable());
  if (jerk_cut && observers.jerk) observers.jerk(measures.last_jerk());
  return measures.outcome();
}

}  // namespace

std::int64_t samples_in(double duration, double sample_rate) {
  return std::llround(duration * sample_rate);
}

std::int64_t samples_per_move(const TrialParameters& parameters) {
  return samples_in(parameters.command.hold, parameters.controller.sample_rate);
}

TrialOutcome run_trial(const TrialParameters& parameters, const TrialObservers& observers) {
  Loop loop(parameters);
  const MoveTiming timing = move_timing(parameters);
  TrialOutcome outcome;
  outcome.moves.reserve(parameters.command.targets.size());
  for (std::size_t m = 0; m < parameters.command.targets.size(); ++m) {
    outcome.moves.push_back(
        run_move(loop, timing, static_cast<std::int64_t>(m), parameters.command.targets[m], observers));
  }
  return outcome;
}

}  // namespace zerocount
