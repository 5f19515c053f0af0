#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace zerocount::report {

/// A quantity of a sample, by its number.
using SampleQuantity = std::function<double(std::size_t)>;

/// The samples of [first, end) that a line needs: the first, the last, and those with the minimum and the
/// maximum of each quantity. In order, each once.
std::vector<std::size_t> extreme_samples(std::size_t first, std::size_t end,
                                         const std::vector<SampleQuantity>& quantities);

}  // namespace zerocount::report
