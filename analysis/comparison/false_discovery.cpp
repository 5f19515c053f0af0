#include <algorithm>
#include <cstddef>
#include <numeric>

#include "analysis/comparison/measure_comparison.hpp"

namespace zerocount::comparison {

std::vector<double> benjamini_yekutieli(std::span<const double> p) {
  const std::size_t count = p.size();
  double harmonic = 0.0;
  for (std::size_t i = 1; i <= count; ++i) harmonic += 1.0 / static_cast<double>(i);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });

  std::vector<double> adjusted(count);
  double least = 1.0;
  for (std::size_t rank = count; rank > 0; --rank) {
    const double scale = static_cast<double>(count) * harmonic / static_cast<double>(rank);
    least = std::min(least, scale * p[order[rank - 1]]);
    adjusted[order[rank - 1]] = least;
  }
  return adjusted;
}

}  // namespace zerocount::comparison
