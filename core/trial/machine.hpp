#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/loop/sample_clock.hpp"
#include "core/plant/plant.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::trial {

/// Initial state of an axis that stands still and holds the torques that act on it
/// (InitialConditions::holding).
struct HeldStart {
  double contact{0.0};   ///< Torque that the friction contact carries, N m
  double twist{0.0};     ///< Twist δ of the coupling of a second mass, rad
  double integral{0.0};  ///< Torque that is added to the initial integral, because the contact cannot carry
                         ///< it, N m
};

/// Computes the initial state in which nothing moves at t = 0. With τL(θL) the constant torque and the ripple
/// on the load, the coupling torque is
///
///   Ts = kL·h(δ) = −τL(ε(0) − δ),
///
/// and the contact carries d + (1 + ε′(0))·τL. If that is its breakaway torque or more, or the law has no
/// friction, the integral carries it in place of the contact, and the whole loop starts in the steady state
/// of that torque (loop::Controller::hold, held_torque).
HeldStart held_start(const TrialParameters& parameters);

/// Integral I of the control law before the first sample, N m.
double initial_integral(const TrialParameters& parameters);

/// Torque of the motor before the first decided one acts, N m: in a closed loop HeldStart::integral, so that
/// an axis that its integral holds stands still through delay and amplifier; else 0.
double held_torque(const TrialParameters& parameters);

/// Angles and velocity of the masses at t = 0, from which the counts before the first sample follow.
loop::StartOfMotion start_of_motion(const TrialParameters& parameters);

/// Initial state of the plant at t = 0, from the trial's initial conditions.
motion::PlantStart plant_start(const TrialParameters& parameters);

/// The values of the second mass besides its coupling: the torques on it, the kinematic error, and the
/// initial twist.
motion::LoadSide load_side(const TrialParameters& parameters);

/// Largest absolute count that the program allows, 2⁵², so that a double represents every count exactly.
inline constexpr double max_counts = 0x1p52;

/// Tolerances of the motion integrator, derived from the resolution (rad) of the fine encoder.
motion::MotionTolerance motion_tolerance(double resolution);

/// The machine of a trial: drive, plant and encoders, without the controller. For each sample the functions
/// read(), drive() and hold() are called in this order.
/// @tparam AnyPlant PlantOf a list of friction laws.
template <class AnyPlant>
class Machine {
 public:
  explicit Machine(const TrialParameters& p)
      : sample_time_(1.0 / p.controller.sample_rate),
        clock_(p.controller, p.randomness),
        measurement_(p.encoder, p.initial.encoder_phase, p.initial.position, p.randomness, sample_time_,
                     p.initial.other_encoder_phase),
        drive_(p.dac, p.amplifier, p.controller.delay, sample_time_, p.randomness, p.controller.jitter > 0.0,
               held_torque(p)),
        encoder_place_(motion::has_load(p.plant) ? p.plant.load.encoder : motion::EncoderPlace::motor),
        plant_(p.plant, p.friction, plant_start(p), motion_tolerance(measurement_.fine_resolution())) {
    plant_.disturb(disturbance_of(p.disturbance, p.initial.position, p.randomness));
    if (motion::has_load(p.plant)) plant_.start_load(load_side(p), p.load_side.friction);
    if (p.controller.jitter > 0.0)
      plant_.advance(motion::constant_torque(held_torque(p)), clock_.lateness(0));
  }

  /// Reads the encoders and the plant's state at the sampling instant t_k of sample k. The caller fills in
  /// torque, target and reference of the returned record.
  SampleRecord read(std::int64_t k) {
    SampleRecord record;
    record.k = k;
    late_ = {late_.next, clock_.lateness(k + 1)};
    if (k == 0) late_.now = clock_.lateness(0);
    record.t = static_cast<double>(k) * sample_time_ + late_.now;
    plant_.set_time(record.t);
    const plant::PlantReading plant = plant_.read();
    record.theta = plant.theta;
    record.omega = plant.omega;
    record.load_theta = plant.load_theta;
    record.load_omega = plant.load_omega;
    const bool at_load = encoder_place_ == motion::EncoderPlace::load;
    last_measured_ = at_load ? record.load_theta : record.theta;
    last_other_ = at_load ? record.theta : record.load_theta;
    reading_ = measurement_.read(k, last_measured_, last_other_);
    record.count = reading_.fine;
    record.coarse_count = reading_.coarse;
    record.motor_count = at_load ? reading_.other : reading_.fine;
    record.load_count = at_load ? reading_.fine : reading_.other;
    record.xp = plant.creep.extension;
    record.xh = plant.creep.hardening;
    record.depth = plant.depth;
    record.mode = plant.sliding ? HookMode::slide : HookMode::stick;
    return record;
  }

  const loop::EncoderReading& last_reading() const { return reading_; }
  /// Angle of the mass that closes the loop, rotor or load, at the last reading, rad.
  double last_measured() const { return last_measured_; }
  double last_other() const { return last_other_; }  ///< Angle of the other mass at the last reading, rad

  /// Sends the converter's output that was decided at t_k to amplifier and motor, and fills in the torque
  /// fields of `record`.
  void drive(const loop::DacOutput& output, SampleRecord& record) {
    drive_.send(record.k, output, late_);
    clipped_ = output.clipped;
    record.code = output.code;
    record.torque = output.torque;
    record.drive_torque = drive_.torque();
  }

  /// Applies the torque (N m) at t_k to the motor, without rounding by the converter, and fills in the torque
  /// fields of `record`.
  void drive_exactly(double torque, SampleRecord& record) {
    drive_.send_exact(torque, late_);
    record.torque = torque;
    record.drive_torque = drive_.torque();
  }

  /// Marks the trial as failed, because the controller has failed: it ends after this sample.
  void fail() { failed_ = true; }

  /// Lets the plant move under the motor's torque until the next sample.
  void hold() {
    for (const loop::TorquePiece& piece : drive_.pieces())
      plant_.advance(piece.course, piece.duration, plant::max_steps_of_sample);
  }

  /// Whether the trial can go on: the controller has not failed, and the motion is finite and within the
  /// counters' range.
  bool readable() const {
    return !failed_ && plant_.finite() &&
           std::abs(plant_.theta()) < max_counts * measurement_.finest_resolution();
  }

  bool clipped() const {
    return clipped_;
  }  ///< Whether the converter's range, or the amplifier's limit, was
     ///< exceeded at this sample
  const loop::Measurement& measurement() const { return measurement_; }
  AnyPlant& plant() { return plant_; }

 private:
  double sample_time_;
  loop::SampleClock clock_;
  loop::Lateness late_{};  // of this sample and the next
  loop::Measurement measurement_;
  loop::Drive drive_;
  motion::EncoderPlace encoder_place_;
  loop::EncoderReading reading_{};
  double last_measured_{0.0};
  double last_other_{0.0};
  AnyPlant plant_;
  bool clipped_{false};
  bool failed_{false};
};

}  // namespace zerocount::trial
