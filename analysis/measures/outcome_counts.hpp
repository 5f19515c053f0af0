#pragma once

#include <cstdint>

#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// How many trials (or moves) had each outcome.
struct OutcomeCounts {
  std::int64_t zero_count{0};
  std::int64_t one_count{0};
  std::int64_t off_target{0};
  std::int64_t oscillating{0};
  std::int64_t nonfinite{0};
  std::int64_t open_loop{0};  ///< not judged
};

/// Where an outcome is counted.
/// @throws Failure (bad_data) for a value that is no outcome, which only a damaged file has.
std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome);

}  // namespace zerocount::measures
