#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/reading/all_trials_file.hpp"
#include "runners/tuning/loop_examiner.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Of the values of some moves, of which 95 % are at most `p95`; NaN without values.
struct UpperValues {
  double p95{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
};

/// The torque decided while moves are at rest (MoveOutcome::rest_torque_power), over these moves.
struct RestTorque {
  double rms{0.0};       ///< root of the mean of its mean square, N m
  double changes{0.0};   ///< likewise of its changes from sample to sample, N m
  double of_range{0.0};  ///< the changes as a proportion of the converter's largest torque
};

/// How the moves that a goal asks are made under a condition: what an engineer looks at beside the goal.
struct MoveBehaviour {
  std::optional<std::string> goal{};       ///< its name; "no goal" for moves that none of several asks
  std::optional<std::string> condition{};  ///< none without conditions
  std::size_t number{0};                   ///< of the goal in the study; their number for other moves
  std::int64_t moves{0};
  UpperValues overshoot;          ///< counts
  UpperValues overshoot_length;   ///< the same, rad
  UpperValues overshoot_of_step;  ///< the same as a proportion of the move's step; NaN where nothing steps
  double smallest_step{std::numeric_limits<double>::infinity()};  ///< counts
  UpperValues peak_torque;                                        ///< N m
  UpperValues peak_of_range;  ///< the same as a proportion of the converter's largest torque
  double range{std::numeric_limits<double>::infinity()};  ///< that torque, the smallest of the machines', N m
  double saturated{0.0};             ///< proportion of moves in which the converter clipped
  std::optional<RestTorque> rest{};  ///< where it is measured, and some move comes to rest
};

/// That of the trials in a results file of one point, by goal and condition.
std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study);

/// That of the first `count` units, each with one trial under each condition. The torque at rest is measured
/// from the dwell within `verdict.rest_band` on; where the study does not measure it, within the largest band
/// or tolerance of its goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<MoveBehaviour> simulated_behaviour(const study::Study& study, const trials::Replicates& units,
                                               std::int64_t count, const trials::Effort& effort);

/// Something that a drive engineer refuses, although the goals do not forbid it.
struct Refusal {
  std::string finding;  ///< "overshoot", "saturation", "phase margin", "torque noise"
  std::string text;     ///< "95 % of the moves of goal 'large' overshoot by up to 59 % of the step"
  double value{0.0};
  double largest{0.0};  ///< that passes; of the phase margin the smallest
  std::string remedy;   ///< "limits: {overshoot: 50}", as it stands in a manifest
};

/// Overshoot of more than 25 % of the step in 5 % of the moves (where it leaves the goal's band), a converter
/// that clips in more than 1 % of the moves, a phase margin below 30°, a torque whose changes at rest have an
/// rms of more than a tenth of the converter's largest torque.
std::vector<Refusal> refusals_of(const std::vector<MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study);

}  // namespace zerocount::tuning
