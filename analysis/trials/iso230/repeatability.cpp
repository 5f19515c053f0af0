#include "analysis/trials/iso230/repeatability.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"

namespace zerocount::iso230 {
namespace {

constexpr double coverage = 2.0;  // of the standard's bands x̄ ± 2·s

/// Accumulates the smallest and the largest of the values added. One NaN makes both NaN.
class Extremes {
 public:
  void add(double value) {
    if (std::isnan(value) || value < smallest_) smallest_ = value;
    if (std::isnan(value) || value > largest_) largest_ = value;
  }
  double largest() const { return largest_; }
  double range() const { return largest_ - smallest_; }

 private:
  double smallest_{std::numeric_limits<double>::infinity()};
  double largest_{-std::numeric_limits<double>::infinity()};
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? statistics::unknown : sum / static_cast<double>(values.size());
}

double standard_uncertainty(const std::vector<double>& values, double mean) {
  if (values.size() < 2) return statistics::unknown;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

TargetRepeatability of_target(const TargetDeviations& target) {
  TargetRepeatability t;
  t.mean_positive = mean_of(target.positive);
  t.mean_negative = mean_of(target.negative);
  t.mean = (t.mean_positive + t.mean_negative) / 2.0;
  t.reversal = t.mean_positive - t.mean_negative;
  t.uncertainty_positive = standard_uncertainty(target.positive, t.mean_positive);
  t.uncertainty_negative = standard_uncertainty(target.negative, t.mean_negative);
  t.repeatability_positive = 2.0 * coverage * t.uncertainty_positive;
  t.repeatability_negative = 2.0 * coverage * t.uncertainty_negative;
  Extremes bidirectional;
  bidirectional.add(coverage * t.uncertainty_positive + coverage * t.uncertainty_negative +
                    std::abs(t.reversal));
  bidirectional.add(t.repeatability_positive);
  bidirectional.add(t.repeatability_negative);
  t.repeatability = bidirectional.largest();
  return t;
}

void add_band(Extremes& extremes, double mean, double uncertainty) {
  extremes.add(mean + coverage * uncertainty);
  extremes.add(mean - coverage * uncertainty);
}

AxisRepeatability of_axis(const std::vector<TargetRepeatability>& targets) {
  if (targets.empty()) return {};
  Extremes reversal, repeatability_positive, repeatability_negative, repeatability;
  Extremes systematic_positive, systematic_negative, systematic, mean;
  Extremes accuracy_positive, accuracy_negative, accuracy;
  double reversals = 0.0;
  for (const TargetRepeatability& t : targets) {
    reversal.add(std::abs(t.reversal));
    reversals += t.reversal;
    repeatability_positive.add(t.repeatability_positive);
    repeatability_negative.add(t.repeatability_negative);
    repeatability.add(t.repeatability);
    systematic_positive.add(t.mean_positive);
    systematic_negative.add(t.mean_negative);
    systematic.add(t.mean_positive);
    systematic.add(t.mean_negative);
    mean.add(t.mean);
    add_band(accuracy_positive, t.mean_positive, t.uncertainty_positive);
    add_band(accuracy_negative, t.mean_negative, t.uncertainty_negative);
    add_band(accuracy, t.mean_positive, t.uncertainty_positive);
    add_band(accuracy, t.mean_negative, t.uncertainty_negative);
  }
  return {.reversal = reversal.largest(),
          .mean_reversal = reversals / static_cast<double>(targets.size()),
          .repeatability_positive = repeatability_positive.largest(),
          .repeatability_negative = repeatability_negative.largest(),
          .repeatability = repeatability.largest(),
          .systematic_positive = systematic_positive.range(),
          .systematic_negative = systematic_negative.range(),
          .systematic = systematic.range(),
          .mean_bidirectional = mean.range(),
          .accuracy_positive = accuracy_positive.range(),
          .accuracy_negative = accuracy_negative.range(),
          .accuracy = accuracy.range()};
}

std::int64_t target_count(std::span<const study::SequenceMove> sequence) {
  std::int64_t last = -1;
  for (const study::SequenceMove& move : sequence) last = std::max(last, move.target);
  return last + 1;
}

/// [target] The deviations of the moves that end at each target, sorted by direction of approach.
/// `deviation(move)` returns the deviation of the move with this number.
template <typename Deviation>
std::vector<TargetDeviations> deviations(std::span<const study::SequenceMove> sequence,
                                         const Deviation& deviation) {
  std::vector<TargetDeviations> targets(static_cast<std::size_t>(target_count(sequence)));
  for (std::size_t move = 0; move < sequence.size(); ++move) {
    if (sequence[move].target < 0) continue;
    TargetDeviations& target = targets[static_cast<std::size_t>(sequence[move].target)];
    (sequence[move].direction > 0 ? target.positive : target.negative).push_back(deviation(move));
  }
  return targets;
}

bool lost(const trial::MoveOutcome& move) {
  return move.outcome == trial::Outcome::nonfinite || !std::isfinite(move.final_position);
}

}  // namespace

Repeatability repeatability_of(std::span<const TargetDeviations> targets) {
  Repeatability result;
  std::transform(targets.begin(), targets.end(), std::back_inserter(result.targets), of_target);
  result.axis = of_axis(result.targets);
  return result;
}

SequenceShape shape_of(std::span<const study::SequenceMove> sequence) {
  SequenceShape shape{.targets = target_count(sequence)};
  std::vector<std::int64_t> from_below(static_cast<std::size_t>(shape.targets), 0);
  std::vector<std::int64_t> from_above(from_below);
  for (const study::SequenceMove& move : sequence) {
    if (move.target < 0) continue;
    ++(move.direction > 0 ? from_below : from_above)[static_cast<std::size_t>(move.target)];
  }
  if (shape.targets == 0) return shape;
  shape.positive = *std::max_element(from_below.begin(), from_below.end()) > 0;
  shape.negative = *std::max_element(from_above.begin(), from_above.end()) > 0;
  const std::int64_t below = *std::min_element(from_below.begin(), from_below.end());
  const std::int64_t above = *std::min_element(from_above.begin(), from_above.end());
  shape.cycles = !shape.negative ? below : !shape.positive ? above : std::min(below, above);
  return shape;
}

std::vector<double> listed_targets(std::span<const study::SequenceMove> sequence,
                                   const trial::TrialParameters& parameters) {
  std::vector<double> positions(static_cast<std::size_t>(target_count(sequence)), statistics::unknown);
  for (std::size_t move = 0; move < sequence.size(); ++move) {
    if (sequence[move].target < 0) continue;
    positions[static_cast<std::size_t>(sequence[move].target)] =
        static_cast<double>(parameters.command.targets[move]);
  }
  return positions;
}

std::optional<TrialRepeatability> trial_repeatability(std::span<const study::SequenceMove> sequence,
                                                      const trial::TrialParameters& parameters,
                                                      std::span<const trial::MoveOutcome> moves) {
  if (moves.size() != sequence.size() || parameters.command.targets.size() != sequence.size()) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("a trial with {} moves to {} targets; expected the {} of the "
                              "sequence",
                              moves.size(), parameters.command.targets.size(), sequence.size()));
  }
  if (std::any_of(moves.begin(), moves.end(), lost)) return std::nullopt;
  const double resolution = loop::fine_resolution(parameters.encoder);
  const auto of_motor = [&](std::size_t move) {
    const auto target = static_cast<double>(parameters.command.targets[move]);
    return moves[move].final_position - (target + 0.5 - parameters.initial.encoder_phase) * resolution;
  };
  const auto by_encoder = [&](std::size_t move) { return static_cast<double>(-moves[move].final_error); };
  TrialRepeatability trial;
  trial.from_encoder = repeatability_of(deviations(sequence, by_encoder));
  trial.from_position = trial.of_load = trial.of_motor = repeatability_of(deviations(sequence, of_motor));
  if (!motion::has_load(parameters.plant)) return trial;
  const bool load_closes = parameters.plant.load.encoder == motion::EncoderPlace::load;
  const auto of_load = [&](std::size_t move) {
    const trial::MoveOutcome& outcome = moves[move];
    return -(load_closes ? outcome.true_error : outcome.other_true_error) * resolution;
  };
  trial.of_load = repeatability_of(deviations(sequence, of_load));
  if (load_closes) trial.from_position = trial.of_load;
  return trial;
}

}  // namespace zerocount::iso230
