#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/goal.hpp"

namespace zerocount::tuning {

/// Point of the unit cube. [free parameter] Position in the parameter's range, 0 (low end) to 1 (high end),
/// on its linear or logarithmic scale.
using UnitCubePoint = std::vector<double>;
/// [free parameter] Value of each free parameter, in the unit of the manifest.
using Values = std::vector<double>;

/// Values of the free parameters at a point of the unit cube, each rounded to four significant digits, or to
/// a whole number, inside its range. So a user can type in exactly the values that were simulated.
Values values_at(std::span<const study::FreeParameter> free, const UnitCubePoint& place);

/// Rounds a positive number to three significant digits, as answers show it, so that the shown number is the
/// simulated one.
double to_three_digits(double value);

/// Point of the unit cube that represents the values; values outside a range are clamped to its ends.
UnitCubePoint place_of(std::span<const study::FreeParameter> free, const Values& values);

/// A sequence that fills the unit cube evenly: the fractional parts of start_d + i·g⁻ᵈ, d = 1, 2, …, g the
/// root of gᴰ⁺¹ = g + 1 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
class SpreadPlaces {
 public:
  explicit SpreadPlaces(std::vector<double> start);

  UnitCubePoint at(std::int64_t i) const;

 private:
  std::vector<double> start_;
  std::vector<double> ratios_;  ///< [d] g⁻ᵈ, the step of the sequence in dimension d = 1, 2, ….
};

/// Differential evolution rand/1/bin (Storn and Price, Journal of Global Optimization 11, 1997) over the unit
/// cube, towards places whose shortfall (distance from keeping the stability margins) is 0. Walkers that have
/// reached this region spread over it, because every move within it is accepted.
class Walk {
 public:
  using Shortfalls = std::function<std::vector<double>(const std::vector<UnitCubePoint>&)>;

  /// @param shortfalls returns the shortfall at each place: 0 where values are admissible, otherwise larger
  /// the farther away
  /// @param face indices of the parameters that stay at their low ends
  Walk(Shortfalls shortfalls, std::vector<std::size_t> face, random::NumberSource& numbers)
      : shortfalls_(std::move(shortfalls)), face_(std::move(face)), numbers_(numbers) {}

  /// Runs one round of the evolution. Returns the places with a shortfall of 0 that it finds.
  /// @param first returns the i-th place (i = 0, 1, …) at which the walk may begin
  std::vector<UnitCubePoint> next(const std::function<UnitCubePoint(std::int64_t)>& first);

  /// Whether the walk has rounds left and should call next() again.
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

/// Random index below `size`, uniformly distributed.
std::size_t index_below(std::size_t size, random::NumberSource& numbers);

}  // namespace zerocount::tuning
