#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/batch/kernels/batch_state.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/sample_clock.hpp"
#include "core/motion/disturbance.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::batch {

/// Taylor series of a vibration torque about each sampling instant k·T. The sines and cosines of its lines
/// are advanced from sample to sample by rotation, and computed anew every 256 samples.
class VibrationSeries {
 public:
  using Coefficients = std::array<double, vibration_order + 1>;

  VibrationSeries(const std::vector<motion::Vibration>& lines, double sample_time);

  /// The highest order whose coefficient of the series matters; 0 if the vibration has no lines.
  std::size_t terms() const { return terms_; }
  /// Coefficients of the vibration about sample k in powers of (t − k·T)/T, up to the order terms(), N m.
  /// Fastest if k increases from call to call.
  Coefficients about_sample(std::int64_t k);

 private:
  struct Line {
    motion::Vibration of;
    double turn_sine, turn_cosine;  // of the angle in T
    double sine, cosine;            // at the last sample
    Coefficients weights;           // amplitude·(2πf·T)^k/k!, with the sign of the k-th derivative
  };

  std::vector<Line> lines_;
  double sample_time_;
  std::int64_t last_{-1};
  std::size_t terms_{0};
};

/// The torque on the rotor of a lane from one sample to the next, in pieces: the output of the
/// reference's Drive for the decided torques, and the disturbance.
class LaneDrive {
 public:
  explicit LaneDrive(const trial::TrialParameters& parameters);

  /// Passes on the torque (N m) that the converter gives at sample k; pieces of torque for the following
  /// sample time are computed from it.
  void send(std::int64_t k, double torque);
  /// Whether the torque on the rotor stays constant as long as the controller decides the same torque.
  bool stays() const;

  /// Present piece of the motor's torque, a time span with a constant amplifier input, without the
  /// disturbance.
  const loop::TorquePiece& piece() const { return pieces_[present_]; }
  /// End of the present piece of the motor's torque, s after the nominal instant k·T of the last sample.
  double piece_end() const { return piece_end_; }
  bool is_last_piece() const { return present_ + 1 == count_; }
  void next_piece();

  /// The disturbance torque on the rotor, without its constant part.
  const motion::Disturbance& disturbance() const { return disturbance_; }
  /// Whether the torque on the rotor may vary between two stops, because the amplifier lags or the
  /// disturbance varies.
  bool may_vary() const { return lags_ || disturbance_varies(); }
  bool disturbance_varies() const { return motion::varies(disturbance_); }
  /// Whether the kernels get the sinusoidal lines of the vibration one by one, because they are few;
  /// otherwise they get the series vibration().
  bool lanes_have_lines() const { return disturbance_.vibration.size() <= max_lane_lines; }
  /// Taylor series of the vibration torque about sample k: coefficients in powers of (t − k·T)/T, N m.
  VibrationSeries::Coefficients vibration(std::int64_t k) { return vibration_.about_sample(k); }
  std::size_t vibration_terms() const { return vibration_.terms(); }
  bool jitters() const { return jitters_; }
  /// Time δ_k (s) by which sample k is late.
  double lateness(std::int64_t k) const { return clock_.lateness(k); }

 private:
  void add(const loop::TorquePiece& piece);

  double sample_time_;
  bool jitters_;
  bool lags_;             // by an amplifier
  bool passes_on_;        // the decided torque, at once
  std::int64_t delayed_;  // samples on their way
  loop::SampleClock clock_;
  loop::Drive drive_;
  motion::Disturbance disturbance_;
  VibrationSeries vibration_;
  loop::Lateness late_{};
  double last_torque_;  // that was sent last; before the first, the torque held
  std::int64_t alike_;  // number of equal torques sent last
  std::array<loop::TorquePiece, 8> pieces_{};
  std::size_t count_{0};
  std::size_t present_{0};
  double piece_end_{0.0};
};

}  // namespace zerocount::batch
