#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/random/number_source.hpp"
#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {

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
