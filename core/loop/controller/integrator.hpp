#pragma once

#include <algorithm>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"
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

/// The integral of a control law:
///
///   I ← clamp(ρ·I + increment) where |e_k| is outside the deadband and |e_k| ≤ zone; otherwise I stays,
///
///   I(z) = 1/(1 − ρ·z⁻¹)·Increment(z),   ρ = exp(−T/τ),
///
/// with the deadband's state by inside_deadband, τ the leak's time constant. Without a leak ρ = 1.
class Integrator {
 public:
  explicit Integrator(const IntegralConstants<double>& constants, double integral)
      : constants_(constants), state_{integral, 0.0} {}

  /// @param increment N m. @returns I, N m.
  double add(double error, double increment) {
    integrate(constants_, state_, error, increment);
    return state_.integral;
  }

  /// A sample at which another law decides: I stays, the deadband goes on.
  void observe(double error) {
    state_.inside = inside_deadband(constants_, state_.inside, error) ? 1.0 : 0.0;
  }

  void set(double integral) { state_.integral = integral; }
  double value() const { return state_.integral; }  ///< I, N m

  /// From (gain/2)·(the sum of this sample's and the last one's input) to I, outside the deadband.
  TransferFunction trapezoid(double half_gain) const {
    return {{half_gain, half_gain}, {1.0, -constants_.retention}};
  }

 private:
  IntegralConstants<double> constants_;
  IntegralState<double> state_;
};

}  // namespace zerocount::loop
