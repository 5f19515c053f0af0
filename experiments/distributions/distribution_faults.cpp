#include <fmt/format.h>

#include "core/numerics/normal_distribution.hpp"
#include "experiments/distributions/distribution.hpp"

namespace zerocount::distributions {
namespace {

using Fault = DistributionFault;

std::optional<Fault> ends_fault(double low, double high) {
  if (low < high) return std::nullopt;
  return Fault{fmt::format("low {} is not below high {}", low, high),
               "low < high (for a constant, the number itself)"};
}

std::optional<Fault> positive_fault(std::string_view name, double value) {
  if (value > 0.0) return std::nullopt;
  return Fault{fmt::format("{} is {}", name, value), fmt::format("{} greater than 0", name)};
}

std::optional<Fault> fault_of(const Uniform& d) {
  return ends_fault(d.low, d.high);
}

std::optional<Fault> fault_of(const LogUniform& d) {
  if (auto fault = positive_fault("low", d.low)) return fault;
  return ends_fault(d.low, d.high);
}

std::optional<Fault> fault_of(const Normal& d) {
  return positive_fault("sd", d.sd);
}

std::optional<Fault> fault_of(const TruncatedNormal& d) {
  if (auto fault = positive_fault("sd", d.sd)) return fault;
  if (auto fault = ends_fault(d.low, d.high)) return fault;
  constexpr double min_probability = 1e-12;
  const double low = (d.low - d.mean) / d.sd;
  const double high = (d.high - d.mean) / d.sd;
  const double probability = low > 0.0
                                 ? numerics::normal_probability(-low) - numerics::normal_probability(-high)
                                 : numerics::normal_probability(high) - numerics::normal_probability(low);
  if (probability >= min_probability) return std::nullopt;
  return Fault{fmt::format("the normal distribution has a probability of only {:.3g} between low and high",
                           probability),
               fmt::format("at least {}", min_probability)};
}

std::optional<Fault> fault_of(const Lognormal& d) {
  if (auto fault = positive_fault("median", d.median)) return fault;
  if (auto fault = positive_fault("cv", d.cv)) return fault;
  constexpr double max_coefficient_of_variation = 10.0;
  if (d.cv <= max_coefficient_of_variation) return std::nullopt;
  return Fault{fmt::format("cv is {}", d.cv), fmt::format("cv at most {}", max_coefficient_of_variation)};
}

std::optional<Fault> fault_of(const Triangular& d) {
  if (auto fault = ends_fault(d.low, d.high)) return fault;
  if (d.low <= d.mode && d.mode <= d.high) return std::nullopt;
  return Fault{fmt::format("the mode {} is not between {} and {}", d.mode, d.low, d.high),
               "low <= mode <= high"};
}

std::optional<Fault> fault_of(const Integers& d) {
  if (d.low <= d.high) return std::nullopt;
  return Fault{fmt::format("low {} is above high {}", d.low, d.high), "low <= high"};
}

std::optional<Fault> fault_of(const Choice& d) {
  if (!d.values.empty()) return std::nullopt;
  return Fault{"the list is empty", "a list of at least one number"};
}

}  // namespace

std::optional<DistributionFault> find_fault(const Distribution& distribution) {
  return std::visit([](const auto& d) { return fault_of(d); }, distribution);
}

}  // namespace zerocount::distributions
