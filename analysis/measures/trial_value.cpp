#include "analysis/measures/trial_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/trial/divergence.hpp"
#include "results/layout/fields.hpp"

namespace zerocount {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double counted_value(const Measure& measure, const MoveOutcome& move) {
  if (!was_run(move) || (measure.values.needs_motion && move.outcome == Outcome::nonfinite)) return no_value;
  const double value = value_of(measure.field, move);
  return measure.values.magnitude ? std::abs(value) : value;
}

bool has_targets(const Measure& measure, std::span<const MoveOutcome> moves) {
  return !measure.values.needs_target ||
         std::none_of(moves.begin(), moves.end(),
                      [](const MoveOutcome& move) { return move.outcome == Outcome::open_loop; });
}

double value_of_trial(const Measure& measure, std::span<const MoveOutcome> moves,
                      const std::function<double()>& late) {
  const auto has = [&](const MoveOutcome& move) { return has_quality(measure, move); };
  double result = 0.0;
  switch (measure.of_trial) {
    case OfTrial::all:
      return std::all_of(moves.begin(), moves.end(), has) ? 1.0 : 0.0;
    case OfTrial::any:
      return std::any_of(moves.begin(), moves.end(), has) ? 1.0 : 0.0;
    case OfTrial::sum:
      for (const MoveOutcome& move : moves) result += value_of(measure.field, move);
      return result;
    case OfTrial::largest:
      for (const MoveOutcome& move : moves) {
        double value = std::abs(value_of(measure.field, move));
        if (std::isnan(value) && late && measure.values.nan_is_late) value = late();
        if (std::isnan(value)) return no_value;
        result = std::max(result, value);
      }
      return result;
    case OfTrial::last:
      return value_of(measure.field, moves.back());
  }
  return no_value;
}

}  // namespace zerocount
