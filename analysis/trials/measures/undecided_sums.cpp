#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"
#include "core/theory/move_times.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::measures {
namespace {

/// Proportion of the moves whose error was still falling for which the advised hold is long enough.
constexpr double advised_proportion = 0.9;

/// The value rounded up to two significant digits, as the double nearest to this decimal number.
double rounded_up(double value) {
  const double decimals = 1.0 - std::floor(std::log10(value));
  const double scale = std::pow(10.0, std::abs(decimals));
  if (decimals < 0.0) return std::ceil(value / scale - 1e-9) * scale;
  return std::ceil(value * scale - 1e-9) / scale;
}

/// Time constant τ of the decay of the error, s, from the errors recorded in the middle and at the end of the
/// hold; see time_to_zero().
double decay_time_constant(std::int64_t midway_error, std::int64_t final_error, std::int64_t samples,
                           double sample_time) {
  const double elapsed = static_cast<double>(samples - 1 - trial::first_of_last_half(samples)) * sample_time;
  return elapsed /
         std::log(static_cast<double>(std::abs(midway_error)) / static_cast<double>(std::abs(final_error)));
}

/// Logarithm ln(step / initial error) of a move, at least 0. With a longer hold the preceding move arrives
/// too, so that this move starts with its whole step as error. 0 for the first move, and under a profiled
/// reference, where the error does not start with the step.
/// @param number number of the move in the trial
/// @param error_before last error of the preceding move, counts
double log_of_longer_way(const trial::TrialParameters& parameters, std::size_t number,
                         std::int64_t error_before) {
  const std::vector<std::int64_t>& targets = parameters.command.targets;
  if (number == 0 || parameters.command.profile.shape != loop::ReferenceShape::step) return 0.0;
  const std::int64_t step = targets[number] - targets[number - 1];
  const std::int64_t start = step + error_before;
  if (step == 0 || start == 0) return 0.0;
  return std::max(0.0, std::log(std::abs(static_cast<double>(step) / static_cast<double>(start))));
}

/// Hold (time until the next move) that the move is expected to need to arrive, s.
/// @param number number of the move in the trial
/// @param error_before last error of the preceding move, counts
double needed_hold(const trial::MoveOutcome& move, std::size_t number, std::int64_t error_before,
                   const trial::TrialParameters& p) {
  const std::int64_t samples = trial::samples_of_move(p, number);
  const std::int64_t final_error = std::max<std::int64_t>(std::abs(move.final_error), 1);
  const double sample_time = 1.0 / p.controller.sample_rate;
  return time_to_zero(move.midway_error, final_error, samples, sample_time) +
         decay_time_constant(move.midway_error, final_error, samples, sample_time) *
             log_of_longer_way(p, number, error_before) +
         theory::chatter_time(p.plant, friction::friction_at(p.friction, p.initial.position), p.controller,
                              p.verdict.dwell) +
         std::max(p.verdict.dwell, p.verdict.window);
}

}  // namespace

double time_to_zero(std::int64_t midway_error, std::int64_t final_error, std::int64_t samples,
                    double sample_time) {
  const auto last = static_cast<double>(samples - 1) * sample_time;
  return last + decay_time_constant(midway_error, final_error, samples, sample_time) *
                    std::log(2.0 * static_cast<double>(std::abs(final_error)));
}

void UndecidedSums::add(const study::Study& study, std::int64_t row,
                        std::span<const trial::MoveOutcome> moves) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    add_move(counts, moves[i]);
    if (!is_still_falling(moves[i])) continue;
    const trial::TrialParameters parameters =
        study::study_trial(study, row / study.trials, row % study.trials).parameters;
    if (!(parameters.controller.ki > 0.0)) continue;
    // Rounding up keeps the order, so that a quantile of the rounded holds is the rounded quantile.
    needed_holds.add(rounded_up(needed_hold(moves[i], i, i == 0 ? 0 : moves[i - 1].final_error, parameters)));
  }
}

UndecidedSums& UndecidedSums::operator+=(const UndecidedSums& other) {
  counts = sum_of(counts, other.counts);
  needed_holds += other.needed_holds;
  return *this;
}

UndecidedMoves UndecidedSums::moves() const {
  UndecidedMoves moves = counts;
  if (needed_holds.size > 0)
    moves.advised_hold = statistics::quantile(needed_holds, advised_proportion).value;
  return moves;
}

}  // namespace zerocount::measures
