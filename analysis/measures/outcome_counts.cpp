#include "analysis/measures/outcome_counts.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::measures {

std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome) {
  switch (outcome) {
    case trial::Outcome::zero_count:
      return &OutcomeCounts::zero_count;
    case trial::Outcome::one_count:
      return &OutcomeCounts::one_count;
    case trial::Outcome::off_target:
      return &OutcomeCounts::off_target;
    case trial::Outcome::oscillating:
      return &OutcomeCounts::oscillating;
    case trial::Outcome::nonfinite:
      return &OutcomeCounts::nonfinite;
    case trial::Outcome::open_loop:
      return &OutcomeCounts::open_loop;
  }
  throw Failure(ExitCode::bad_data,
                fmt::format("a move with outcome {}; expected 0 to 5", static_cast<int>(outcome)));
}

}  // namespace zerocount::measures
