#include "analysis/trials/measures/trial_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "results/layout/fields.hpp"

namespace zerocount::measures {
namespace {

/// The value that ranks a move in which the event never came, such as settling: +∞ if larger values are
/// worse, otherwise −∞.
double worst_value(const layout::CountedValues& values) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return values.worse == layout::Worse::more ? infinity : -infinity;
}

bool ran_to_its_end(const trial::MoveOutcome& move) {
  return !move.stopped && move.outcome != trial::Outcome::nonfinite;
}

}  // namespace

double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move) {
  return counted_value(measure, move, layout::value_of(measure.field, move));
}

std::optional<double> ranked_value(const layout::CountedValues& values, double value) {
  if (std::isnan(value) || (values.negative_is_missing && value < 0.0))
    return values.missing == layout::Missing::none ? std::nullopt : std::optional(worst_value(values));
  return values.magnitude ? std::abs(value) : value;
}

std::optional<double> ranked_value(const layout::Measure& measure, const trial::MoveOutcome& move) {
  const bool is_late = measure.values.missing == layout::Missing::late;
  if (!trial::was_run(move)) return is_late ? std::optional(worst_value(measure.values)) : std::nullopt;
  const std::optional<double> value = ranked_value(measure.values, counted_value(measure, move));
  return value || ran_to_its_end(move) ? value : worst_value(measure.values);
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
  const bool may_lack_it = measure.values.missing == layout::Missing::none;
  double result = may_lack_it ? statistics::unknown : 0.0;
  switch (measure.reduction) {
    case layout::MoveReduction::all:
    case layout::MoveReduction::any:
      return std::ranges::count_if(moves, has) >= wanted_moves(measure, std::ssize(moves)) ? 1.0 : 0.0;
    case layout::MoveReduction::sum:
      return sum_of_moves(moves, value_of_move);
    case layout::MoveReduction::largest:
      for (const trial::MoveOutcome& move : moves) {
        double value = std::abs(value_of_move(move));
        if (std::isnan(value) && late && measure.values.missing == layout::Missing::late) value = late();
        if (std::isnan(value) && !(may_lack_it && ran_to_its_end(move))) return statistics::unknown;
        result = std::fmax(result, value);  // of NaN and a number the number
      }
      return result;
    case layout::MoveReduction::last:
      return value_of_move(moves.back());
  }
  return statistics::unknown;
}

}  // namespace zerocount::measures
