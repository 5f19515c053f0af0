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

/// Delays the decided torques by n + f samples, n a whole number and 0 ≤ f < 1.
class TorqueDelay {
 public:
  /// Torques that leave the delay during sample k: for the first part of the sample, the fraction f, it is
  /// `before`, the torque decided at k − n − 1; for the rest it is `after`, the torque decided at k − n.
  struct Leaving {
    double before;
    double after;
  };

  /// Creates a delay of `samples` samples.
  /// @param held the torque that leaves the delay until the first decided one has passed it, N m.
  explicit TorqueDelay(double samples, double held = 0.0);

  Leaving pass(double torque);
  double fraction() const { return fraction_; }  ///< Fraction f of a sample in the delay n + f, 0 ≤ f < 1

 private:
  std::vector<double> waiting_;
  std::size_t oldest_{0};
  double fraction_;
};

/// The motor's torque over a part of a sample in which the input of the motor's amplifier stays constant.
struct TorquePiece {
  motion::TorqueCourse course;
  double duration{0.0};  ///< Duration of the part, s
  double decay{0.0};     ///< Factor by which the amplifier's lag decays over the part:
                         /// < exp(−course.rate·duration)
};

/// The converter's output torque for a code, with its errors: torque_with_errors(code) + noise·z_k, z_k the
/// standard normal random number with number k of its key; without errors code·Δu.
class ConverterErrors {
 public:
  ConverterErrors(const DacParameters& dac, const random::TrialRandomness& randomness);

  /// The converter's output torque for the code that was decided at sample k, N m.
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

/// Rate 2πf at which the amplifier's torque approaches its input, f its bandwidth, 1/s; 0 without an
/// amplifier.
double lag_rate(const AmplifierParameters& amplifier);

/// Times by which this sample and the next one are late, s.
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

  /// Sends the code decided at sample k through converter, delay and amplifier.
  /// @param late lateness of this and the next sample.
  void send(std::int64_t k, const DacOutput& decided, const Lateness& late = {}) {
    apply(converter_.torque(k, decided), late);
  }

  /// Sends a torque (N m) past the converter, so without rounding and converter errors, through delay and
  /// amplifier.
  void send_exact(double torque, const Lateness& late = {}) { apply(torque, late); }

  /// The motor's torque from the last sample sent to the next one, as successive parts with a constant
  /// amplifier input; valid until the next sample is sent.
  std::span<const TorquePiece> pieces() const { return {pieces_.data(), count_}; }

  /// The motor's torque at the last sampling instant t_k, just after sending, N m; before the first, the
  /// torque held at the start.
  double torque() const { return pieces_.front().course.now; }

 private:
  /// A part of a sample: its duration (s), and the factor by which the amplifier's lag decays in it.
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

  /// A future change of the amplifier's input.
  struct Change {
    double due;     ///< Time of the change after t_k, s
    double torque;  ///< Torque that becomes the amplifier's input, N m
  };
  double sample_time_;
  double delay_time_;            // s
  std::vector<Change> changes_;  // with jitter, those to come, in order
  double input_;                 // with jitter, the amplifier's input, N m
  bool jitters_;
};

}  // namespace zerocount::loop
