#include "core/trial/rig.hpp"

#include <algorithm>
#include <cmath>

#include "core/trial/random_history.hpp"

namespace zerocount {
namespace {

/// Fraction of a fine count that the motion may leave out per torque step. Far below the accuracy asked for,
/// because a trial that breaks away in every cycle of its ringing multiplies an error from cycle to cycle.
constexpr double motion_tolerance_in_counts = 1e-11;

/// Amplitude of an oscillation that counts as rest, in fine counts: a hundredth of the accuracy asked for.
constexpr double rest_in_counts = 1e-8;

/// Farther than this, counts are no longer whole numbers of a double.
constexpr double most_counts = 0x1p52;

}  // namespace

PlantStart plant_start(const TrialParameters& p) {
  return {p.initial.position, p.initial.hardening,
          p.initial.preload,  draw_history(p.initial.history, p.randomness),
          p.initial.velocity, p.initial.mode == InitialMode::slide};
}

MotionTolerance motion_tolerance(double resolution) {
  return {motion_tolerance_in_counts * resolution, rest_in_counts * resolution};
}

Rig::Rig(const TrialParameters& p)
    : sample_time_(1.0 / p.controller.sample_rate),
      measurement_(p.encoder, p.initial.encoder_phase, p.initial.position, p.randomness),
      dac_(p.dac),
      drive_(p.dac, p.amplifier, p.controller.delay, sample_time_, p.randomness),
      plant_(p.plant, p.friction, plant_start(p), motion_tolerance(measurement_.fine_resolution())) {}

SampleRecord Rig::read(std::int64_t k) {
  SampleRecord record;
  record.k = k;
  record.t = static_cast<double>(k) * sample_time_;
  const PlantReading plant = plant_.read();
  record.theta = plant.theta;
  record.omega = plant.omega;
  const EncoderReading reading = measurement_.read(k, record.theta);
  record.count = reading.fine;
  record.coarse_count = reading.coarse;
  record.xp = plant.creep.extension;
  record.xh = plant.creep.hardening;
  record.depth = plant.depth;
  record.mode = plant.sliding ? HookMode::slide : HookMode::stick;
  return record;
}

void Rig::drive(double torque, SampleRecord& record) {
  const DacOutput output = convert(dac_, torque);
  course_ = drive_.send(record.k, output);
  clipped_ = output.clipped;
  record.code = output.code;
  record.torque = output.torque;
  record.drive_torque = course_.now;
}

void Rig::drive_exactly(double torque, SampleRecord& record) {
  course_ = drive_.send_exact(torque);
  record.torque = torque;
  record.drive_torque = course_.now;
}

bool Rig::readable() const {
  const double finest = std::min(measurement_.fine_resolution(), measurement_.coarse_resolution());
  return plant_.finite() && std::abs(plant_.theta()) < most_counts * finest;
}

}  // namespace zerocount
