#pragma once

#include <cstdint>

#include "core/loop/formulas.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

std::int64_t lowest_code(const DacParameters& dac);   ///< −2^(bits−1)
std::int64_t highest_code(const DacParameters& dac);  ///< 2^(bits−1) − 1

double lowest_torque(const DacParameters& dac);   ///< of the lowest code, lowest_code·Δu, N m
double highest_torque(const DacParameters& dac);  ///< of the highest code, highest_code·Δu, N m

/// The converter's output for a wanted torque.
struct DacOutput {
  std::int64_t code{0};
  double torque{0.0};   ///< code·Δu, N m
  bool clipped{false};  ///< the wanted code was out of range
};

/// code = round-half-even(torque/Δu), clipped to the converter's range.
/// @param torque wanted, N m.
DacOutput convert(const DacParameters& dac, double torque);

/// A converter from sample to sample. With sigma-delta it converts v = u + r, u the wanted torque, and
///
///   r ← v − code·Δu, or 0 where the code was clipped,   r = 0 at first.
class Converter {
 public:
  explicit Converter(const DacParameters& dac) : dac_(dac) {}

  DacOutput convert(double torque) {
    if (!dac_.sigma_delta) return loop::convert(dac_, torque);
    const double with_remainder = torque + remainder_;
    const DacOutput output = loop::convert(dac_, with_remainder);
    remainder_ = rounding_remainder(with_remainder, output.torque, output.clipped);
    return output;
  }

 private:
  DacParameters dac_;
  double remainder_{0.0};  ///< r, N m
};

/// Whether the output differs from code·Δu.
bool has_errors(const DacParameters& dac);

/// The output for `code`, without noise, N m:
///
///   Δu·(1 + gain_error)·(code + INL(code)) + offset,
///   INL(code) = nonlinearity·4·(code − lowest)·(highest − code)/(highest − lowest)²   codes,
///
/// a parabola that is 0 at both ends of the range and `nonlinearity` in the middle, at code −½.
double torque_with_errors(const DacParameters& dac, std::int64_t code);

}  // namespace zerocount::loop
