#include "analysis/measures/outcome_counts.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount {

std::int64_t OutcomeCounts::*counter_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::zero_count:
      return &OutcomeCounts::zero_count;
    case Outcome::one_count:
      return &OutcomeCounts::one_count;
    case Outcome::off_target:
      return &OutcomeCounts::off_target;
    case Outcome::oscillating:
      return &OutcomeCounts::oscillating;
    case Outcome::nonfinite:
      return &OutcomeCounts::nonfinite;
    case Outcome::open_loop:
      return &OutcomeCounts::open_loop;
  }
  throw Failure(ExitCode::bad_data,
                fmt::format("a move with outcome {}; expected 0 to 5", static_cast<int>(outcome)));
}

}  // namespace zerocount
