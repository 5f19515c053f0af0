#pragma once

#include <algorithm>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"
#include "core/loop/controller/count_difference.hpp"
#include "core/loop/controller/torque_hold.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {

inline IntegralConstants<double> integral_constants(const ControlBlocks& blocks, double sample_rate,
                                                    const TorqueRange& range) {
  const auto& [enter, leave] = blocks.deadband;
  return {enter,
          std::max(enter, leave),
          blocks.integrator_zone,
          numerics::exp(-1.0 / (sample_rate * blocks.integrator_leak)),
          range.lowest,
          range.highest};
}

inline ErrorDeadbandConstants<double> error_deadband_constants(const ErrorDeadband& deadband) {
  const bool subtracts = deadband.form == DeadbandForm::subtract && deadband.band > 0.0;
  return {deadband.band, subtracts ? deadband.band : 0.0};
}

/// The integral I of a control law:
///
///   I ← clamp(ρ·I + increment) where |e_k| is outside the deadband and |e_k| ≤ zone; otherwise I stays,
///
///   I(z) = 1/(1 − ρ·z⁻¹)·Increment(z),   ρ = exp(−T/τ),
///
/// with the state of the deadband by inside_deadband(), and τ the time constant of the leak. Without a leak ρ
/// = 1.
class Integrator {
 public:
  explicit Integrator(const IntegralConstants<double>& constants, double integral)
      : constants_(constants), state_{integral, 0.0} {}

  /// Adds an increment (N m) to the integral I, subject to deadband, zone, leak and range.
  /// @param error e, counts.
  /// @returns I, N m.
  double add(double error, double increment) {
    integrate(constants_, state_, error, increment);
    return state_.integral;
  }

  /// Updates the deadband's state at a sample at which another law (of the other control phase) decides the
  /// torque. The integral I stays.
  void observe(double error) {
    state_.inside = inside_deadband(constants_, state_.inside, error) ? 1.0 : 0.0;
  }

  void set(double integral) { state_.integral = integral; }
  double value() const { return state_.integral; }  ///< Integral I, N m

  /// Transfer function from a signal x to the integral I outside the deadband, if the increment is
  /// half_gain·(x_k + x_{k−1}) (trapezoidal rule).
  TransferFunction trapezoid(double half_gain) const {
    return {{half_gain, half_gain}, {1.0, -constants_.retention}};
  }

 private:
  IntegralConstants<double> constants_;
  IntegralState<double> state_;
};

struct PidGains {
  double kp{0.0};  ///< Proportional gain, N m/count
  double ki{0.0};  ///< Integral gain of the trapezoidal rule: torque per sum of two successive errors, N
                   /// < m/count
  double kd{0.0};  ///< Gain on the difference of successive counts, N m/count
};

inline StandstillConstants<double> standstill_constants(const Standstill& standstill, double sample_rate) {
  return {standstill.band, dwell_samples(standstill.dwell, sample_rate), standstill.kp, standstill.ki,
          standstill.kd};
}

/// The PID law with the trapezoidal integral:
///
///   I ← I + ki·(e_k + e_{k−1}),   u = I + kp·e_k − kd·d_k;
///
///   U(z) = [kp + ki·(1 + z⁻¹)/(1 − z⁻¹)]·E(z) − kd·D(z).
///
/// The error e′ after the dead zone (acting_error) replaces e. Integrator adds the conditions on I and the
/// leak. CountDifference gives d, the difference of counts. Before the first sample e was 0. While the axis
/// stands still (stands_still) the gains of Standstill act, and I continues.
class Pid {
 public:
  Pid(const ControllerParameters& parameters, const ControlStart& start)
      : Pid({parameters.kp, parameters.ki, parameters.kd},
            Integrator(integral_constants(parameters.blocks, parameters.sample_rate, start.integral_range),
                       start.integral),
            CountDifference(derivative_pole(parameters.blocks, parameters.sample_rate),
                            parameters.blocks.derivative_window, start.before)) {
    deadband_ = error_deadband_constants(parameters.blocks.error_deadband);
    standstill_ = standstill_constants(parameters.blocks.standstill, parameters.sample_rate);
  }

  /// Creates the PID law without further conditions on its integral, and without a derivative filter.
  /// @param integral integral I before the first sample, N m.
  /// @param range range to which I is clamped whenever an error changes it.
  Pid(const PidGains& gains, double integral, const TorqueRange& range)
      : Pid(gains, Integrator(integral_constants({}, 1.0, range), integral), CountDifference(0.0)) {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    const double d = difference_.step(now.count);
    const double error = acting_error(deadband_, now.error);
    const PidGains gains = gains_at(now);
    const double integral = integral_.add(now.error, gains.ki * (error + last_error_));
    last_error_ = error;
    return pid_torque(integral, gains.kp, error, gains.kd, d);
  }

  void observe(const Feedback& now) {
    difference_.step(now.count);
    integral_.observe(now.error);
    last_error_ = acting_error(deadband_, now.error);
    run_ = 0.0;
  }

  void pause(const Feedback& now) {
    difference_.pass(now.count);
    last_error_ = acting_error(deadband_, now.error);
    gains_at(now);
  }

  /// Sets the integral I to `torque` (N m), so that the law continues from this torque.
  /// @returns 0, the torque needed from the block before, because the law is the first block.
  double take_over(double torque) {
    integral_.set(torque);
    return 0.0;
  }

  /// Linear description of the PID law, without its limits. Parts without gain are left out, because an
  /// integral with ki = 0 would be a constant state.
  LinearChain linear() const {
    LinearBlock block{{LoopSignal::error, {{gains_.kp}}}};
    if (gains_.ki != 0.0) block.push_back({LoopSignal::error, integral_.trapezoid(gains_.ki)});
    if (gains_.kd != 0.0) block.push_back({LoopSignal::count, difference_.transfer(-gains_.kd)});
    return {block};
  }

  double integral() const { return integral_.value(); }  ///< Integral I of the PID law, N m

 private:
  Pid(const PidGains& gains, const Integrator& integral, const CountDifference& difference)
      : gains_(gains), integral_(integral), difference_(difference) {}

  /// The PID gains that act at this sample: the normal gains, or those at standstill.
  PidGains gains_at(const Feedback& now) {
    const bool stands = stands_still(standstill_, run_, now.new_target ? 1.0 : 0.0, now.error);
    return stands ? PidGains{standstill_.kp, standstill_.ki, standstill_.kd} : gains_;
  }

  PidGains gains_;
  ErrorDeadbandConstants<double> deadband_{-1.0, 0.0};
  StandstillConstants<double> standstill_{-1.0, 1.0, 0.0, 0.0, 0.0};
  double run_{0.0};  // of samples_within(standstill_.band)
  Integrator integral_;
  CountDifference difference_;
  double last_error_{0.0};
};

}  // namespace zerocount::loop
