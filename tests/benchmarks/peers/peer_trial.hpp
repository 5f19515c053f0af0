#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/loop/controller/pid.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// Checks that peer_trial() can simulate the trial: ideal encoders and converter, no amplifier, one control
/// phase, stepwise targets, and a rotor that stands at the start.
/// @throws std::invalid_argument if the trial has anything else
void require_plain(const trial::TrialParameters& parameters);

/// Data of the sampled loop at a sample, for recorders.
struct PeerSample {
  std::int64_t k{0};
  std::int64_t target{0};
  std::int64_t count{0};
  loop::DacOutput decided{};
};

/// Simulates a trial: the sampled loop around a plant that another library integrates, with encoder, PID law,
/// converter, delay of whole samples, and the measures of each move.
/// @param observe called with every PeerSample, before the plant moves on
template <class PeerPlant, class Observe>
trial::TrialOutcome peer_trial(const trial::TrialParameters& p, PeerPlant& plant, Observe observe) {
  const double sample_time = 1.0 / p.controller.sample_rate;
  const loop::Encoder encoder = loop::fine_encoder(p.encoder, p.initial.encoder_phase);
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const bool clamps = p.controller.anti_windup == loop::AntiWindup::clamp;
  const loop::TorqueRange range{clamps ? loop::lowest_torque(p.dac) : -unbounded,
                                clamps ? loop::highest_torque(p.dac) : unbounded};
  loop::Pid controller({p.controller.kp, p.controller.ki, p.controller.kd}, p.initial.integral, range);
  controller.observe({0.0, static_cast<double>(loop::read_count(encoder, plant.theta()))});
  loop::TorqueDelay delay(p.controller.delay);
  trial::TrialOutcome outcome;
  std::int64_t k = 0;
  for (std::size_t m = 0; m < p.command.targets.size(); ++m) {
    const trial::MoveTiming timing = trial::move_timing(p, m);
    const std::int64_t target = p.command.targets[m];
    trial::MoveMeasures measures(timing, static_cast<std::int64_t>(m));
    plant.contact().forget_deepest();
    const std::int64_t breakaways_before = plant.contact().breakaways();
    const bool sliding_before = plant.contact().sliding();
    for (std::int64_t i = 0; i < timing.samples; ++i, ++k) {
      const double theta = plant.theta();
      const std::int64_t count = loop::read_count(encoder, theta);
      const loop::DacOutput decided = loop::convert(
          p.dac, controller.step({static_cast<double>(target - count), static_cast<double>(count)}));
      observe(PeerSample{k, target, count, decided});
      measures.add(
          {target, count, decided.torque, decided.clipped, theta, plant.contact().extension(plant.state())});
      plant.set_torque(delay.pass(decided.torque).after);
      plant.advance(sample_time);
    }
    const bool slid = sliding_before || plant.contact().breakaways() > breakaways_before;
    measures.finish(slid, plant.contact().deepest(), std::isfinite(plant.theta()));
    outcome.moves.push_back(measures.outcome());
  }
  return outcome;
}

/// The outcome of a trial simulated with another library's integrator, without recording. This function is
/// timed.
template <class PeerPlant>
trial::TrialOutcome peer_outcome(const trial::TrialParameters& p, PeerPlant& plant) {
  return peer_trial(p, plant, [](const PeerSample&) {});
}

/// The samples of a trial simulated with another library's integrator, in the form in which run_trial()
/// records them.
template <class PeerPlant>
std::vector<trial::SampleRecord> peer_records(const trial::TrialParameters& p, PeerPlant& plant) {
  const loop::Encoder coarse = loop::coarse_encoder(p.encoder, p.initial.encoder_phase);
  loop::TorqueDelay delay(p.controller.delay);
  std::vector<trial::SampleRecord> records;
  peer_trial(p, plant, [&](const PeerSample& sample) {
    const PeerState& y = plant.state();
    trial::SampleRecord record;
    record.k = sample.k;
    record.t = static_cast<double>(sample.k) / p.controller.sample_rate;
    record.target = record.reference = sample.target;
    record.count = sample.count;
    record.theta = plant.theta();
    record.coarse_count = loop::read_count(coarse, record.theta);
    record.error = sample.target - sample.count;
    record.code = sample.decided.code;
    record.torque = sample.decided.torque;
    record.drive_torque = delay.pass(record.torque).after;
    record.omega = plant.contact().omega(y);
    record.xp = plant.contact().extension(y);
    record.xh = plant.contact().hardening(y);
    record.depth = plant.contact().depth();
    record.mode = plant.contact().sliding() ? trial::HookMode::slide : trial::HookMode::stick;
    records.push_back(record);
  });
  return records;
}

}  // namespace zerocount::testing
