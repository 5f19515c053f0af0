#include "analysis/measures/trial_value.hpp"

#include <algorithm>
#include <cmath>

#include "results/layout/fields.hpp"

namespace zerocount::measures {

double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move) {
  return counted_value(measure, move, layout::value_of(measure.field, move));
}

bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves) {
  return !measure.values.needs_target ||
         std::none_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) {
           return move.outcome == trial::Outcome::open_loop;
         });
}

std::int64_t wanted_moves(const layout::Measure& quality, std::int64_t moves_of_trial) {
  return quality.reduction == layout::MoveReduction::all ? moves_of_trial : 1;
}

double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late) {
  const auto has = [&](const trial::MoveOutcome& move) { return layout::has_quality(measure, move); };
  const auto value_of_move = [&](const trial::MoveOutcome& move) {
    return layout::value_of(measure.field, move);
  };
  double result = 0.0;
  switch (measure.reduction) {
    case layout::MoveReduction::all:
    case layout::MoveReduction::any:
      return std::ranges::count_if(moves, has) >= wanted_moves(measure, std::ssize(moves)) ? 1.0 : 0.0;
    case layout::MoveReduction::sum:
      return sum_of_moves(moves, value_of_move);
    case layout::MoveReduction::largest:
      for (const trial::MoveOutcome& move : moves) {
        double value = std::abs(value_of_move(move));
        if (std::isnan(value) && late && measure.values.nan_is_late) value = late();
        if (std::isnan(value)) return statistics::unknown;
        result = std::max(result, value);
      }
      return result;
    case layout::MoveReduction::last:
      return value_of_move(moves.back());
  }
  return statistics::unknown;
}

}  // namespace zerocount::measures
