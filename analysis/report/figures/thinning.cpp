#include "analysis/report/figures/thinning.hpp"

#include <algorithm>

namespace zerocount::report {

std::vector<std::size_t> extreme_samples(std::size_t first, std::size_t end,
                                         const std::vector<SampleQuantity>& quantities) {
  if (first >= end) return {};
  std::vector<std::size_t> samples{first, end - 1};
  for (const SampleQuantity& quantity : quantities) {
    std::size_t lowest = first;
    std::size_t highest = first;
    double low = quantity(first);
    double high = low;
    for (std::size_t k = first + 1; k < end; ++k) {
      const double value = quantity(k);
      if (value < low) {
        low = value;
        lowest = k;
      }
      if (value >= high) {
        high = value;
        highest = k;
      }
    }
    samples.push_back(lowest);
    samples.push_back(highest);
  }
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

}  // namespace zerocount::report
