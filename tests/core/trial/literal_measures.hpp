#pragma once

#include <cstddef>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// What the recorded samples of a move say of it.
struct LiteralMeasures {
  trial::MoveOutcome outcome;  ///< but what goes on between the samples: broke_away and reversal_depth
  std::vector<trial::Jerk> jerks;
};

/// The measures of move `move`, each by its definition over all samples of the move. The torques before
/// rounding, N m, tell whether the converter clipped; there are none past it.
LiteralMeasures literal_measures(const trial::TrialParameters& p,
                                 const std::vector<trial::SampleRecord>& samples,
                                 const std::vector<long double>& wanted, std::size_t move);

/// Expects the measures of a move to be those by the definitions.
void expect_same_measures(const trial::MoveOutcome& measured, const trial::MoveOutcome& expected);
void expect_same_jerks(const std::vector<trial::Jerk>& measured, const std::vector<trial::Jerk>& expected);

}  // namespace zerocount::testing
