#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "experiments/study/tuning.hpp"

namespace zerocount::tuning {

/// A point of the unit cube: [free parameter] the place in its range, 0 to 1, by its scale.
using UnitCubePoint = std::vector<double>;
/// [free parameter] the value in the manifest's unit.
using Values = std::vector<double>;

/// The values at a place, each rounded to four significant digits, or to a whole number, inside its range:
/// what is simulated is what a user types in.
Values values_at(std::span<const study::FreeParameter> free, const UnitCubePoint& place);

/// The place of the values, clamped to the ranges.
UnitCubePoint place_of(std::span<const study::FreeParameter> free, const Values& values);

/// A sequence that fills the unit cube evenly: the fractional parts of start_d + i·g⁻ᵈ, d = 1, 2, …, g the
/// root of gᴰ⁺¹ = g + 1 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
class SpreadPlaces {
 public:
  explicit SpreadPlaces(std::vector<double> start);

  UnitCubePoint at(std::int64_t i) const;

 private:
  std::vector<double> start_;
  std::vector<double> ratios_;  ///< [d] g⁻ᵈ
};

}  // namespace zerocount::tuning
