#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/goal.hpp"

namespace zerocount::tuning {

/// A point of the unit cube: [free parameter] the place in its range, 0 to 1, by its scale.
using UnitCubePoint = std::vector<double>;
/// [free parameter] the value in the manifest's unit.
using Values = std::vector<double>;

/// The values at a place, each rounded to four significant digits, or to a whole number, inside its range:
/// what is simulated is what a user types in.
Values values_at(std::span<const study::FreeParameter> free, const UnitCubePoint& place);

/// A positive number to three digits, as answers show it: what is simulated is what they say.
double to_three_digits(double value);

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

/// Differential evolution of Storn and Price (Journal of Global Optimization 11, 1997), rand/1/bin, to the
/// places whose shortfall is 0. Once walkers are there they fill the region, because any move within it is
/// taken.
class Walk {
 public:
  using Shortfalls = std::function<std::vector<double>(const std::vector<UnitCubePoint>&)>;

  /// @param face parameters that stay at their low ends
  Walk(Shortfalls shortfalls, std::vector<std::size_t> face, random::NumberSource& numbers)
      : shortfalls_(std::move(shortfalls)), face_(std::move(face)), numbers_(numbers) {}

  /// The places with a shortfall of 0 that one round finds. @param first places at which it may begin, 0, 1,
  /// …
  std::vector<UnitCubePoint> next(const std::function<UnitCubePoint(std::int64_t)>& first);

  bool goes_on() const;

 private:
  struct Walker {
    UnitCubePoint place;
    double shortfall{0.0};
  };

  UnitCubePoint moved(const Walker& walker);
  std::vector<Walker> at(std::vector<UnitCubePoint> places) const;

  Shortfalls shortfalls_;
  std::vector<std::size_t> face_;
  random::NumberSource& numbers_;
  std::vector<Walker> walking_;
  int rounds_{0};
};

/// A number below `size`, evenly distributed.
std::size_t index_below(std::size_t size, random::NumberSource& numbers);

}  // namespace zerocount::tuning
