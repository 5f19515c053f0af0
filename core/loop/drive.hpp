#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/loop/dac.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/torque_course.hpp"
#include "core/random/random_numbers.hpp"
#include "core/random/trial_randomness.hpp"

namespace zerocount::loop {

/// The decided torques that the delay holds back: zeros at first.
class TorqueDelay {
 public:
  explicit TorqueDelay(int samples) : waiting_(static_cast<std::size_t>(samples), 0.0) {}

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

/// From the decided torque to the motor's: the converter with its errors, the delay, the amplifier.
///
/// The converter gives torque_with_errors(code) + noise·z_k, z_k standard normal, number k of its key, for
/// the code decided at sample k. After the delay that is the amplifier's input v, which is held for a sample.
/// Until the first decided torque has passed the delay, v is exactly 0, without offset and noise. The
/// amplifier, of bandwidth f, follows from torque 0 at the start by
///
///   du/dt = 2πf·(v − u),   so u(t_k + t) = v + (u(t_k) − v)·exp(−2πf·t);
///
/// with f = 0, u = v. Above 1e12 Hz, f counts as 1e12 Hz.
///
/// Call one of the two send functions once at each sample, in order.
class Drive {
 public:
  /// @param delay samples between deciding a torque and applying it.
  /// @param sample_time T, s.
  Drive(const DacParameters& dac, const AmplifierParameters& amplifier, int delay, double sample_time,
        const random::TrialRandomness& randomness);

  /// Sends the code of sample k through converter, delay and amplifier.
  /// @returns the motor's torque over [t_k, t_{k+1}].
  const motion::TorqueCourse& send(std::int64_t k, const DacOutput& decided) {
    return apply(converter_errors_ ? converted(k, decided.code) : decided.torque);
  }

  /// Sends a torque (N m) past the converter, so without its rounding and errors, through delay and
  /// amplifier.
  /// @returns the motor's torque over [t_k, t_{k+1}].
  const motion::TorqueCourse& send_exact(double torque) { return apply(torque); }

  /// The motor's torque at the last t_k, just after sending, N m: 0 before the first.
  double torque() const { return course_.now; }

 private:
  const motion::TorqueCourse& apply(double torque) {
    const double input = delay_.pass(torque);
    if (rate_ == 0.0) {
      course_ = {input, input, 0.0};
    } else {
      follow(input);
    }
    return course_;
  }

  double converted(std::int64_t k, std::int64_t code) const;
  void follow(double input);

  DacParameters dac_;
  bool converter_errors_;
  random::RandomStream noise_;
  std::uint64_t trial_;
  TorqueDelay delay_;
  double rate_;                    // 2πf
  double decay_per_sample_;        // exp(−2πf·T)
  motion::TorqueCourse course_{};  // since the last t_k
};

}  // namespace zerocount::loop
