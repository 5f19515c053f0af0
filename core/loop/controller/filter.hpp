#pragma once

#include <optional>
#include <vector>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"

namespace zerocount::loop {

/// Coefficients of the digital filter for the transfer function (n₂·p² + n₁·p + n₀)/(p² + 2ζ·p + 1), p =
/// s/ω0, by the bilinear transform p = (1 − z⁻¹)/(w·(1 + z⁻¹)).
/// @param damping ζ.
/// @param w tan(ω0·T/2) if prewarped at ω0, ω0·T/2 if not.
BiquadConstants<double> bilinear(double n2, double n1, double n0, double damping, double w);

/// Coefficients of the digital filter at this sample rate (Hz). With ω0 = 2π·frequency and p = s/ω0:
///
///   lowpass  1/(p² + 2ζ·p + 1)
///   notch    (p² + 2ζ·depth·p + 1)/(p² + 2ζ·p + 1)
///   lead     (1 + √ratio·p)/(1 + p/√ratio)
///
/// each by the bilinear transform prewarped at ω0, s = ω0/tan(ω0·T/2)·(1 − z⁻¹)/(1 + z⁻¹), so that the
/// response at ω0 equals that of the continuous filter; a `biquad` has the given coefficients. The frequency
/// must be below half the sample rate.
BiquadConstants<double> discretised(const Filter& filter, double sample_rate);

/// Converts a biquad to `ratio` times the sample rate to which its coefficients belong. The inverse bilinear
/// transform gives the filter in s, and the bilinear transform at the new rate gives the result. Both are
/// prewarped at the geometric mean of the natural frequencies of the zeros and the poles, so that a filter
/// made by discretised() becomes the one that discretised() makes at the new rate. Empty if the biquad has no
/// such filter in s, because of a pole at half the sample rate.
std::optional<Filter> resampled(const Filter& biquad, double ratio);

/// The controller's filters in series, applied to the torque of the control law. Past values are 0 at first.
class Filters {
 public:
  Filters(const ControllerParameters& parameters, const ControlStart& start);

  double step(const Feedback& /*now*/, double torque) {
    for (Section& section : sections_) torque = biquad_step(section.constants, section.state, torque);
    return torque;
  }
  static void observe(const Feedback& /*now*/) {}
  static void pause(const Feedback& /*now*/) {}
  /// Sets the filters so that their output continues from `torque` (N m): each filter starts in the steady
  /// state whose output the next filter needs. A filter without a steady state, or without static gain,
  /// starts with past values of 0.
  /// @returns the torque that the first filter needs as its input, N m.
  double take_over(double torque);

  LinearChain linear() const;

 private:
  struct Section {
    BiquadConstants<double> constants;
    BiquadState<double> state{0.0, 0.0};
  };

  std::vector<Section> sections_;
};

}  // namespace zerocount::loop
