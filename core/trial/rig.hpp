#pragma once

#include <cstdint>

#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/plant/plant.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/trial.hpp"

namespace zerocount {

/// What the plant of a trial finds at t = 0.
PlantStart plant_start(const TrialParameters& parameters);

/// How exactly a trial follows its motion, by the resolution (rad) of its fine encoder.
MotionTolerance motion_tolerance(double resolution);

/// The rig of a trial: the plant between its drive and its encoders. What closes the loop stands outside. One
/// sample is: read, drive, hold.
class Rig {
 public:
  explicit Rig(const TrialParameters& parameters);

  /// What the encoders and the plant show at t_k. Torque, target and reference are left to who decides them.
  SampleRecord read(std::int64_t k);

  /// Takes the wanted torque (N m) at t_k through the converter; completes `record`.
  void drive(double torque, SampleRecord& record);

  /// Takes the torque (N m) at t_k to the motor as it is, past the converter; completes `record`.
  void drive_exactly(double torque, SampleRecord& record);

  /// Lets the plant move until t_{k+1}.
  void hold() { plant_.advance(course_, sample_time_); }

  /// Whether the motion is still finite, and within what the counters can count.
  bool readable() const;

  bool clipped() const { return clipped_; }  ///< the converter was out of range at this sample
  const Measurement& measurement() const { return measurement_; }
  Plant& plant() { return plant_; }

 private:
  double sample_time_;
  Measurement measurement_;
  DacParameters dac_;
  Drive drive_;
  Plant plant_;
  TorqueCourse course_;
  bool clipped_{false};
};

}  // namespace zerocount
