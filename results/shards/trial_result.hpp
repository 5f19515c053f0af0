#pragma once

#include <cstdint>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::shards {

/// The stored data of one trial.
struct TrialResult {
  std::int64_t row{0};                     ///< global row: point·trials + index
  std::vector<double> inputs;              ///< [input column of the study], in that column's unit
  trial::TrialOutcome outcome;             ///< one entry per move
  std::vector<trial::Jerk> jerks;          ///< by move and onset
  std::vector<trial::SampleRecord> trace;  ///< every sample of a retained trial; otherwise empty
};

}  // namespace zerocount::shards
