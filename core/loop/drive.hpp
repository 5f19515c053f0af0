#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/loop/dac.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/torque_course.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::loop {

/// A delay of n + f samples for the decided torques, n whole, 0 ≤ f < 1.
class TorqueDelay {
 public:
  /// Torques that leave the delay during sample k. For the fraction f of the sample it is `before`, the
  /// torque decided at k − n − 1; then it is `after`, the torque decided at k − n.
  struct Leaving {
    double before;
    double after;
  };

  /// @param held the torque that leaves the delay before the first one has passed it, N m.
  explicit TorqueDelay(double samples, double held = 0.0);

  Leaving pass(double torque);
  double fraction() const { return fraction_; }  ///< f

 private:
  std::vector<double> waiting_;
  std::size_t oldest_{0};
  double fraction_;
};

/// A part of a sample in which the input of the motor's drive stays the same.
struct TorquePiece {
  motion::TorqueCourse course;
  double duration{0.0};  ///< s
  double decay{0.0};     ///< exp(−course.rate·duration)
};

/// The output of the converter for a code: torque_with_errors(code) + noise·z_k, z_k standard normal, number
/// k of its key; without errors code·Δu.
class ConverterErrors {
 public:
  ConverterErrors(const DacParameters& dac, const random::TrialRandomness& randomness);

  /// The torque of sample k, N m.
  double torque(std::int64_t k, const DacOutput& decided) const {
    return any_ ? with_errors(k, decided.code) : decided.torque;
  }

 private:
  double with_errors(std::int64_t k, std::int64_t code) const;

  DacParameters dac_;
  bool any_;
  random::RandomStream noise_;
  std::uint64_t trial_;
};

/// 2πf, 1/s: the rate at which the amplifier's torque approaches its input; 0 without an amplifier.
double lag_rate(const AmplifierParameters& amplifier);

/// Lateness of this sample and of the next one, s.
struct Lateness {
  double now{0.0};
  double next{0.0};
};

/// The path from the decided torque to the motor's torque: converter with its errors, delay, amplifier.
///
/// ConverterErrors gives the output of the converter for the code decided at sample k. The output of the
/// delay is the amplifier's input v: the torque decided at k acts over [t_k + delay·T, t_{k+1} + delay·T).
/// Until the first decided torque has passed the delay, v is exactly the torque held at the start, without
/// rounding, offset and noise: 0, unless the loop holds a load. The amplifier, of bandwidth f, follows from
/// that torque at the start by
///
///   du/dt = 2πf·(v − u),   so u(t_k + t) = v + (u(t_k) − v)·exp(−2πf·t);
///
/// with f = 0, u = v. Above 1e12 Hz, f counts as 1e12 Hz.
///
/// With jitter, sample k is at t_k + δ_k, and all these times are later by δ_k.
///
/// Call one of the two send functions once at each sample, in order.
class Drive {
 public:
  /// @param delay samples between deciding a torque and applying it, ≥ 0.
  /// @param sample_time T, s.
  /// @param jitter whether samples may be late.
  /// @param held torque of the motor before the first decided one acts, N m.
  Drive(const DacParameters& dac, const AmplifierParameters& amplifier, double delay, double sample_time,
        const random::TrialRandomness& randomness, bool jitter = false, double held = 0.0);

  /// Sends the code of sample k through converter, delay and amplifier.
  void send(std::int64_t k, const DacOutput& decided, const Lateness& late = {}) {
    apply(converter_.torque(k, decided), late);
  }

  /// Sends a torque (N m) past the converter, so without its rounding and errors, through delay and
  /// amplifier.
  void send_exact(double torque, const Lateness& late = {}) { apply(torque, late); }

  /// The motor's torque from the last sample sent to the next one; valid until that is sent.
  std::span<const TorquePiece> pieces() const { return {pieces_.data(), count_}; }

  /// The motor's torque at the last t_k, just after sending, N m; before the first, the torque held.
  double torque() const { return pieces_.front().course.now; }

 private:
  /// A duration (s) and the factor by which the amplifier's lag decays in it.
  struct Part {
    double duration;
    double decay;
  };

  void apply(double torque, const Lateness& late);
  void apply_late(double torque, const Lateness& late);
  TorquePiece follow(double input, const TorquePiece& last, const Part& part) const;
  Part part(double duration) const;

  ConverterErrors converter_;
  TorqueDelay delay_;
  double rate_;                          // 2πf
  Part sample_, before_, after_;         // the whole sample; before and after the input changes in it
  std::array<TorquePiece, 4> pieces_{};  // of the last sample
  std::size_t count_{1};                 // of its pieces

  /// A torque that becomes the amplifier's input.
  struct Change {
    double due;     ///< s, from t_k
    double torque;  ///< N m
  };
  double sample_time_;
  double delay_time_;            // s
  std::vector<Change> changes_;  // with jitter, those to come, in order
  double input_;                 // with jitter, the amplifier's input, N m
  bool jitters_;
};

}  // namespace zerocount::loop
