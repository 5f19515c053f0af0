#include "analysis/iso230/trial_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"

namespace zerocount::iso230 {
namespace {

std::int64_t target_count(std::span<const study::SequenceMove> sequence) {
  std::int64_t last = -1;
  for (const study::SequenceMove& move : sequence) last = std::max(last, move.target);
  return last + 1;
}

/// The deviations that `deviation(move)` gives for the moves that go to a target.
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
  const auto from_position = [&](std::size_t move) {
    const auto target = static_cast<double>(parameters.command.targets[move]);
    return moves[move].final_position - (target + 0.5 - parameters.initial.encoder_phase) * resolution;
  };
  const auto from_encoder = [&](std::size_t move) { return static_cast<double>(-moves[move].final_error); };
  return TrialRepeatability{repeatability_of(deviations(sequence, from_position)),
                            repeatability_of(deviations(sequence, from_encoder))};
}

}  // namespace zerocount::iso230
