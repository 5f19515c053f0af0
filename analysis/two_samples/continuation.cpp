#include "analysis/two_samples/continuation.hpp"

#include <algorithm>
#include <cmath>

#include "core/random/random_numbers.hpp"
#include "core/random/variates.hpp"

namespace zerocount::two_samples {
namespace {

constexpr std::int64_t max_blocks = 1000;
constexpr std::uint32_t continuation_key = 0x636f6e74;

}  // namespace

std::uint64_t continuation_bits(std::uint32_t simulation, std::uint32_t stream, std::uint64_t index,
                                ContinuationDraw draw) {
  return random::random_bits({{continuation_key, stream}, simulation}, index,
                             static_cast<std::uint32_t>(draw));
}

double poisson_number(double mean, std::uint64_t bits) {
  if (mean >= 30.0) return std::max(0.0, std::round(mean + std::sqrt(mean) * random::standard_normal(bits)));
  double left = random::open_uniform(bits);
  double probability = std::exp(-mean);
  double number = 0.0;
  while (left > probability && probability > 0.0) {
    left -= probability;
    number += 1.0;
    probability *= mean / number;
  }
  return number;
}

Continuation::Continuation(std::int64_t units, std::uint32_t stream)
    : units_(units), stream_(stream), blocks_(static_cast<std::size_t>(std::min(units, max_blocks))) {}

std::size_t Continuation::block_of(std::int64_t unit) const {
  return static_cast<std::size_t>(unit * static_cast<std::int64_t>(blocks_) / units_);
}

double Continuation::size_of(std::size_t block) const {
  const auto count = static_cast<std::int64_t>(blocks_);
  const auto first = [&](std::int64_t number) { return (number * units_ + count - 1) / count; };
  const auto number = static_cast<std::int64_t>(block);
  return static_cast<double>(first(number + 1) - first(number));
}

std::vector<double> Continuation::population(std::uint32_t simulation) const {
  std::vector<double> weights(blocks_);
  double sum = 0.0;
  for (std::size_t block = 0; block < blocks_; ++block) {
    const std::uint64_t bits = continuation_bits(simulation, stream_, block, ContinuationDraw::population);
    weights[block] = -size_of(block) * std::log(random::open_uniform(bits));
    sum += weights[block];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> Continuation::further_units(const std::vector<double>& population, double more,
                                                std::uint32_t simulation) const {
  std::vector<double> numbers(blocks_);
  for (std::size_t block = 0; block < blocks_; ++block) {
    const double size = size_of(block);
    const std::uint64_t bits = continuation_bits(simulation, stream_, block, ContinuationDraw::further_units);
    numbers[block] = size * poisson_number(more * population[block] / size, bits);
  }
  return numbers;
}

}  // namespace zerocount::two_samples
