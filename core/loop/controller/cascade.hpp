#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/loop/controller/count_difference.hpp"
#include "core/loop/controller/pid.hpp"

namespace zerocount::loop {

/// Gains of the cascade (position loop around a velocity loop), converted to units of counts and samples.
/// @param sample_rate Hz.
/// @param resolution, velocity_resolution Δx of the encoders of the position and the velocity loop, rad per
/// count.
inline CascadeConstants<double> cascade_constants(const CascadeParameters& gains, double sample_rate,
                                                  double resolution, double velocity_resolution) {
  return {gains.kv * resolution, sample_rate * velocity_resolution, gains.kp, 0.5 * gains.ki / sample_rate};
}

/// The velocity command of a position loop that may run in a host of its own. The host may be slower than the
/// velocity loop and sends the command over a bus, as a number of few digits. With m = divider and q =
/// latency, at sample k
///
///   v*_k = kv·Δx·e_k + feedforward·ṙ_k where k is a multiple of m, elsewhere v*_{k−1}          (rad/s)
///
///   V*(z) = z^−q·(1/m)·(1 + z⁻¹ + … + z^−(m−1))·kv·Δx·E(z), the images of the slower sampling left out.
///
/// v*_k is rounded half to even to a multiple of the resolution, and then clipped to ± the limit. The
/// velocity loop gets v*_{k−q}, or 0 before the first command has arrived. The delay counts the samples at
/// which the controller runs.
class VelocityCommand {
 public:
  explicit VelocityCommand(const CascadeParameters& parameters)
      : parameters_(parameters), sent_(static_cast<std::size_t>(parameters.latency), 0.0) {}

  /// The velocity command that the velocity loop gets at this sample, rad/s.
  /// @param wanted kv·Δx·e_k, rad/s.
  double step(const Feedback& now, double wanted) {
    if (now.sample % parameters_.divider == 0) {
      const auto& p = parameters_;
      if (p.feedforward != 0.0) wanted += p.feedforward * now.reference.velocity;
      if (p.resolution > 0.0) wanted = rounded_command(wanted, p.resolution);
      command_ = clamped(wanted, -p.limit, p.limit);
    }
    if (sent_.empty()) return command_;
    const double arrived = std::exchange(sent_[oldest_], command_);
    oldest_ = (oldest_ + 1) % sent_.size();
    return arrived;
  }

  /// Transfer function from the position error to `gain` times the velocity command, divided by kv·Δx:
  /// gain·V*(z)/(kv·Δx·E(z)), without the rounding to the resolution.
  TransferFunction transfer(double gain) const {
    const auto divider = static_cast<std::size_t>(parameters_.divider);
    std::vector<double> b(sent_.size(), 0.0);
    b.insert(b.end(), divider, gain / static_cast<double>(divider));
    return {b};
  }

 private:
  CascadeParameters parameters_;
  double command_{0.0};       // of the last sample of the position loop, rad/s
  std::vector<double> sent_;  // commands on their way, in a ring, rad/s
  std::size_t oldest_{0};
};

/// The usual cascade of a drive, a proportional position loop around a PI velocity loop:
///
///   v*_k by VelocityCommand,   v_k = (Δx_v/T)·d_k,   w_k = v*_k − v_k                        (rad/s)
///   I ← I + (ki·T/2)·(w_k + w_{k−1}),   u = kp·w_k + I                                       (N m)
///
///   U(z) = [kp + (ki·T/2)·(1 + z⁻¹)/(1 − z⁻¹)]·[V*(z) − (Δx_v/T)·D(z)].
///
/// The error e′ after the dead zone (acting_error) replaces e. Integrator adds the conditions on I, which
/// depend on the position error e, and the leak. CountDifference gives d, the difference of the counts of the
/// encoder that the velocity loop reads, whose resolution is Δx_v. Before the first sample w was 0. Source:
/// Groß, Hamann, Wiegärtner, "Electrical Feed Drives in Automation", Siemens/MCD 2001, chapter 3.
class Cascade {
 public:
  Cascade(const ControllerParameters& parameters, const ControlStart& start)
      : constants_(cascade_constants(parameters.blocks.cascade, parameters.sample_rate, start.resolution,
                                     start.velocity_resolution)),
        deadband_(error_deadband_constants(parameters.blocks.error_deadband)),
        integral_(integral_constants(parameters.blocks, parameters.sample_rate, start.integral_range),
                  start.integral),
        command_(parameters.blocks.cascade),
        difference_(derivative_pole(parameters.blocks, parameters.sample_rate),
                    parameters.blocks.derivative_window, start.velocity_before) {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    const double w = velocity_error(constants_, command(now), difference_.step(now.velocity_count));
    const double integral = integral_.add(now.error, constants_.ki * (w + last_velocity_error_));
    last_velocity_error_ = w;
    return cascade_torque(integral, constants_.kp, w);
  }

  void observe(const Feedback& now) {
    last_velocity_error_ = velocity_error(constants_, command(now), difference_.step(now.velocity_count));
    integral_.observe(now.error);
  }

  void pause(const Feedback& now) {
    difference_.pass(now.velocity_count);
    last_velocity_error_ = velocity_error(constants_, command(now), difference_.value());
  }

  /// Sets the integral I to `torque` (N m), so that the law continues from this torque.
  /// @returns 0, the torque needed from the block before, because the law is the first block.
  double take_over(double torque) {
    integral_.set(torque);
    return 0.0;
  }

  LinearChain linear() const {
    const LinearBlock position_loop{{LoopSignal::error, command_.transfer(constants_.kv)},
                                    {LoopSignal::velocity_count, difference_.transfer(-constants_.velocity)}};
    LinearBlock velocity_loop{{LoopSignal::torque, {{constants_.kp}}}};
    if (constants_.ki != 0.0) {
      velocity_loop.push_back({LoopSignal::torque, integral_.trapezoid(constants_.ki)});
    }
    return {position_loop, velocity_loop};
  }

  double integral() const { return integral_.value(); }  ///< Integral I of the velocity loop, N m

 private:
  /// Velocity command v* of the position loop that acts at this sample, rad/s.
  double command(const Feedback& now) {
    return command_.step(now, constants_.kv * acting_error(deadband_, now.error));
  }

  CascadeConstants<double> constants_;
  ErrorDeadbandConstants<double> deadband_;
  Integrator integral_;
  VelocityCommand command_;
  CountDifference difference_;
  double last_velocity_error_{0.0};
};

}  // namespace zerocount::loop
