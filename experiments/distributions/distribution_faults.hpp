#pragma once

#include <optional>
#include <string>

#include "experiments/distributions/distribution.hpp"

namespace zerocount {

/// Why some numbers make no distribution, as the two phrases of a message.
struct DistributionFault {
  std::string what;
  std::string expected;
};

/// The first fault of a distribution whose numbers are finite: low not below high, no spread, nothing to
/// choose from, …
std::optional<DistributionFault> find_fault(const Distribution& distribution);

}  // namespace zerocount
