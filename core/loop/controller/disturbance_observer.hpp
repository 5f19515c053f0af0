#pragma once

#include <numbers>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"
#include "core/loop/controller/filter.hpp"

namespace zerocount::loop {

/// @param resolution Δx, rad per count.
inline ObserverConstants<double> observer_constants(const ObserverParameters& observer, double sample_rate,
                                                    double resolution) {
  const double w = std::numbers::pi * observer.bandwidth / sample_rate;
  const double rate = 2.0 * std::numbers::pi * observer.bandwidth;
  const BiquadConstants<double> acceleration = bilinear(1.0, 0.0, 0.0, 0.5 * std::numbers::sqrt2, w);
  const BiquadConstants<double> q = bilinear(0.0, 0.0, 1.0, 0.5 * std::numbers::sqrt2, w);
  return {observer.inertia * rate * rate * acceleration.b0 * resolution, q.b0, q.a1, q.a2};
}

/// A disturbance observer, which subtracts its estimate d̂ of the disturbance from the torque of the blocks
/// before:
///
///   u − d̂,   d̂ = Jn·s²·Q·θm − Q·u₁,   Q = ωq²/(s² + √2·ωq·s + ωq²),   ωq = 2π·bandwidth,
///
/// with θm = (count_k − count_0)·Δx, of the encoder of a cascade's velocity loop, and u₁ the torque decided
/// one sample before, both by the bilinear transform without prewarping. With w = ωq·T/2, c = 1 + √2·w + w²
/// and N = 1 + a₁·z⁻¹ + a₂·z⁻²:
///
///   D̂(z) = (Jn·ωq²/c)·(1 − z⁻¹)²/N·Θm(z) − (w²/c)·(1 + z⁻¹)²/N·U₁(z),
///   a₁ = 2·(w² − 1)/c,   a₂ = (1 − √2·w + w²)/c.
///
/// Source: Ohnishi, Shibata, Murakami, "Motion control for advanced mechatronics", IEEE/ASME Transactions on
/// Mechatronics 1 (1996) 56–67. Without bandwidth the torque goes through unchanged.
class DisturbanceObserver {
 public:
  DisturbanceObserver(const ControllerParameters& parameters, const ControlStart& start)
      : acts_(parameters.blocks.observer.bandwidth > 0.0),
        constants_(observer_constants(parameters.blocks.observer, parameters.sample_rate,
                                      start.velocity_resolution)) {}

  double step(const Feedback& now, double torque) {
    observe(now);
    return acts_ ? torque - estimate_ : torque;
  }
  void observe(const Feedback& now) {
    if (!acts_) return;
    if (!started_) first_count_ = now.velocity_count;
    started_ = true;
    estimate_ = observer_step(constants_, state_, now.velocity_count - first_count_, now.torque_in_force);
  }
  static void pause(const Feedback& /*now*/) {}
  double take_over(double torque) const { return torque + estimate_; }

  LinearChain linear() const {
    if (!acts_) return {};
    const auto& [acceleration, q, a1, a2] = constants_;
    const std::vector<double> denominator{1.0, a1, a2};
    return {{{LoopSignal::torque, {{1.0}}},
             {LoopSignal::velocity_count, {{-acceleration, 2.0 * acceleration, -acceleration}, denominator}},
             {LoopSignal::torque_in_force, {{q, 2.0 * q, q}, denominator}}}};
  }

 private:
  bool acts_;
  ObserverConstants<double> constants_;
  BiquadState<double> state_{0.0, 0.0};
  double estimate_{0.0};  ///< d̂ at the last sample, N m
  double first_count_{0.0};
  bool started_{false};
};

}  // namespace zerocount::loop
