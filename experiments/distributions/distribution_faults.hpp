#pragma once

#include <optional>
#include <string>

#include "experiments/distributions/distribution.hpp"

namespace zerocount::distributions {

/// Why the parameters of a distribution are invalid: the two phrases of a message.
struct DistributionFault {
  std::string what;
  std::string expected;
};

/// The first fault of a distribution with finite parameters: low not below high, no spread, an empty choice,
/// …
std::optional<DistributionFault> find_fault(const Distribution& distribution);

}  // namespace zerocount::distributions
