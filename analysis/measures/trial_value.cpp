#include "analysis/measures/trial_value.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/unknown.hpp"
#include "core/trial/divergence.hpp"
#include "results/layout/fields.hpp"

namespace zerocount::measures {
double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move) {
  if (!trial::was_run(move) || (measure.values.needs_motion && move.outcome == trial::Outcome::nonfinite))
    return statistics::unknown;
  const double value = layout::value_of(measure.field, move);
  return measure.values.magnitude ? std::abs(value) : value;
}

bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves) {
  return !measure.values.needs_target ||
         std::none_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) {
           return move.outcome == trial::Outcome::open_loop;
         });
}

double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late) {
  const auto has = [&](const trial::MoveOutcome& move) { return layout::has_quality(measure, move); };
  double result = 0.0;
  switch (measure.reduction) {
    case layout::MoveReduction::all:
      return std::all_of(moves.begin(), moves.end(), has) ? 1.0 : 0.0;
    case layout::MoveReduction::any:
      return std::any_of(moves.begin(), moves.end(), has) ? 1.0 : 0.0;
    case layout::MoveReduction::sum:
      for (const trial::MoveOutcome& move : moves) result += layout::value_of(measure.field, move);
      return result;
    case layout::MoveReduction::largest:
      for (const trial::MoveOutcome& move : moves) {
        double value = std::abs(layout::value_of(measure.field, move));
        if (std::isnan(value) && late && measure.values.nan_is_late) value = late();
        if (std::isnan(value)) return statistics::unknown;
        result = std::max(result, value);
      }
      return result;
    case layout::MoveReduction::last:
      return layout::value_of(measure.field, moves.back());
  }
  return statistics::unknown;
}

}  // namespace zerocount::measures
