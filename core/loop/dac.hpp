#pragma once

#include <cstdint>

#include "core/loop/formulas.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

std::int64_t lowest_code(const DacParameters& dac);   ///< Lowest code of the converter, −2^(bits−1)
std::int64_t highest_code(const DacParameters& dac);  ///< Highest code of the converter, 2^(bits−1) − 1

/// Lowest torque that the motor can be asked for, N m: that of the lowest code, lowest_code·Δu, or the
/// negative limit of the amplifier if that is nearer to 0.
double lowest_torque(const DacParameters& dac);
double highest_torque(const DacParameters& dac);  ///< Highest torque that the motor can be asked for, N m:
                                                  ///< that of the highest code, highest_code·Δu, or the limit
                                                  ///< of the amplifier if that is lower.

/// Output of the digital-to-analogue converter for a wanted torque.
struct DacOutput {
  std::int64_t code{0};
  double torque{0.0};   ///< Torque of the code, code·Δu, N m
  bool clipped{false};  ///< Whether the wanted code was out of range, or the wanted torque beyond the
                        ///< amplifier's limit
};

/// Converts a wanted torque to a code of the digital-to-analogue converter: round-half-even(torque/Δu),
/// clipped to the converter's range.
/// @param torque wanted torque, N m.
DacOutput convert(const DacParameters& dac, double torque);

/// A converter from sample to sample, which clips the wanted torque to ± the limit of the amplifier before it
/// rounds. With sigma-delta it converts v = u + r, u the torque so clipped, and
///
///   r ← v − code·Δu, or 0 where the code was clipped,   r = 0 at first.
class Converter {
 public:
  explicit Converter(const DacParameters& dac) : dac_(dac) {}

  DacOutput convert(double torque) {
    const double limited = within_limit(torque);
    const double with_remainder = limited + remainder_;
    DacOutput output = loop::convert(dac_, with_remainder);
    if (dac_.sigma_delta) remainder_ = rounding_remainder(with_remainder, output.torque, output.clipped);
    output.clipped = output.clipped || limited != torque;
    return output;
  }

  /// The torque (N m), clipped to ± the limit of the amplifier.
  double within_limit(double torque) const { return clamped(torque, -dac_.limit, dac_.limit); }

 private:
  DacParameters dac_;
  double remainder_{0.0};  ///< Rounding error r that a sigma-delta converter adds to the next torque, N m; 0
                           ///< without sigma-delta
};

/// Whether the output of the converter differs from code·Δu because of offset, gain error, non-linearity or
/// noise.
bool has_errors(const DacParameters& dac);

/// Output torque of the converter for `code` with its systematic errors, without noise, N m:
///
///   Δu·(1 + gain_error)·(code + INL(code)) + offset,
///   INL(code) = nonlinearity·4·(code − lowest)·(highest − code)/(highest − lowest)²   codes,
///
/// a parabola that is 0 at both ends of the range and `nonlinearity` in the middle, at code −½.
double torque_with_errors(const DacParameters& dac, std::int64_t code);

}  // namespace zerocount::loop
