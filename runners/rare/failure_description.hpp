#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runners/rare/estimator.hpp"
#include "runners/rare/rare_question.hpp"

namespace zerocount::rare {

/// Quantiles of an input.
struct InputRange {
  double low{0.0};  ///< 5 %
  double median{0.0};
  double high{0.0};  ///< 95 %
};

/// An input of the trials: what it is in those that fail.
struct FailureInput {
  std::string name;  ///< dotted path
  std::string unit;
  /// Mean over the failures of the input's normal score: how many standard deviations failures lie above the
  /// median. Of a random coordinate it is that; of another input it follows from the rank among some thousand
  /// trials.
  double shift{0.0};
  InputRange usual;     ///< of all trials
  InputRange failures;  ///< of those that fail
};

/// The inputs that differ between trials; those that failure shifts most come first. Empty without a failure.
std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state);

/// How often the machines fail that carry the probability.
struct CarryingMachines {
  std::int64_t examined{0};    ///< machines, drawn from the failures
  std::int64_t moves_each{0};  ///< trials of each, with new moves
  double median_rate{0.0};     ///< of their proportion of failing moves
  double mostly_failing{0.0};  ///< proportion of the failures on machines that fail in most of their moves
  double probability_of_one{0.0};  ///< that a machine is one of these
};

/// Runs further moves of machines that failed, drawn by the weights of the failures. Nothing without a
/// failure, or where machines and moves are not told apart.
/// @throws trial::Interrupted
std::optional<CarryingMachines> carrying_machines(const Question& question, const EstimatorState& state,
                                                  double probability, const trials::Effort& effort);

}  // namespace zerocount::rare
