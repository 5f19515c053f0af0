#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// A limit of a goal: the largest magnitude of a measure of a move that meets it.
struct GoalLimit {
  std::string measure;  ///< its name in files: "overshoot", "band_exits[2]", "tolerance_settling_time[1e-08]"
  double largest{0.0};  ///< in the measure's unit
};

/// The time that a goal allows a move: from its start (`within`), or from the end of its profile
/// (`after_profile`), which each move has its own of.
struct TimeLimit {
  double time{1.0};  ///< s
  bool after_profile{false};

  constexpr TimeLimit() = default;
  constexpr TimeLimit(double of_move, bool after = false) : time(of_move), after_profile(after) {}
  /// s from the start of a move whose profile takes so long (MoveOutcome::travel_time).
  constexpr double from_start(double travel_time) const { return after_profile ? travel_time + time : time; }
};

/// A goal of a study (`goal`, `goals`). A move meets it if its error is within the band for good after
/// `within` at the latest (BandOutcome::settling_time). The goal is a claim about all axes that the manifest
/// describes, one-sided, with this confidence:
///   without `machines`: at least the proportion `moves` of all their moves meets it;
///   with `machines`: at least the proportion `machines` of them meets it in at least `moves` of its moves.
///
/// With a tolerance the position error |ε| stays within it (MoveOutcome::tolerance_settling_times) in place
/// of the band. A move also misses the goal if a measure of `limits` is larger than allowed, or NaN.
struct Goal {
  std::string name{};                 ///< of `goals`; empty where the study has one goal
  std::int64_t band{0};               ///< counts; one of StudyFeatures::bands; not used with a tolerance
  std::optional<double> tolerance{};  ///< rad, or m; one of StudyFeatures::tolerances
  parameters::AxisKind axis{};        ///< of the study: it determines the units
  TimeLimit within{};
  std::vector<std::int64_t> on{};  ///< moves of a trial that it is about, rising; empty: all
  std::vector<GoalLimit> limits{};
  double moves{0.99};
  std::optional<double> machines{};
  double confidence{0.95};
};

}  // namespace zerocount::study
