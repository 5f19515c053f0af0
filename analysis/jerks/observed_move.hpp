#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::jerks {

/// A jerk in whole samples.
struct SampledJerk {
  std::int64_t onset{0};      ///< first sample with an error, counted from arrival
  std::int64_t length{0};     ///< samples with an error
  std::int64_t magnitude{0};  ///< counts
  bool agrees{false};         ///< in the direction of the holding torque of the move
};

/// A move after its arrival. Samples are counted from the first of the arrival dwell.
struct ObservedMove {
  std::int64_t trial{0};    ///< global row
  std::int64_t cluster{0};  ///< the independent unit: the trial, or with rigs the trial's rig
  bool arrived{false};
  bool lost{false};         ///< the state became non-finite at an unknown time; the fields below are unset
  double sample_time{0.0};  ///< s
  std::int64_t dwell{0};    ///< first sample at which a jerk could begin
  std::int64_t end{0};      ///< number of observed samples
  std::vector<SampledJerk> jerks;
};

/// Calls `take(first, end)` for each run of samples at which a jerk could begin: from the dwell on, samples
/// whose predecessor has no error.
void for_each_run_at_risk(const ObservedMove& move,
                          const std::function<void(std::int64_t, std::int64_t)>& take);

/// Calls `take` for each move of a point, in order of trial and move.
/// @throws Failure (bad_data) if the jerks of a trial do not match the numbers that its moves counted, or are
/// outside the time of the move.
void for_each_move(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                   const std::function<void(const ObservedMove&)>& take);

}  // namespace zerocount::jerks
