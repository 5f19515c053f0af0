#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/parameters.hpp"
#include "core/text/relation.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// A limit that a goal sets for one measure. A move can meet the goal only if the magnitude of this measure
/// keeps the limit.
struct GoalLimit {
  /// Name of the measure in files: "overshoot", "band_exits[2]", "tolerance_settling_time[1e-08]".
  std::string measure;
  text::Limit limit{};  ///< limit of the magnitude, in the measure's unit
};

/// The time that a goal allows a move, counted from the start of the move (key `within`) or from the end of
/// its profile (key `after_profile`). The end of the profile differs between moves.
struct TimeLimit {
  double time{1.0};  ///< time that the goal allows, s
  bool after_profile{false};

  constexpr TimeLimit() = default;
  constexpr TimeLimit(double of_move, bool after = false) : time(of_move), after_profile(after) {}
  /// Allowed time from the start of the move, s.
  /// @param travel_time duration of the move's profile, s (MoveOutcome::travel_time)
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
  std::string name{};  ///< name of the goal under `goals`; empty if the study has one goal
  /// Half-width of the error band, counts; one of StudyFeatures::bands; not used with a tolerance.
  std::int64_t band{0};
  /// Tolerance of the position error in place of the band, rad or m; one of StudyFeatures::tolerances.
  std::optional<double> tolerance{};
  parameters::AxisKind axis{};  ///< kind of axis of the study; determines the units
  TimeLimit within{};
  std::vector<std::int64_t> on{};  ///< indices of the moves that the goal judges, rising; empty: all moves
  std::vector<GoalLimit> limits{};
  double moves{0.99};
  std::optional<double> machines{};
  double confidence{0.95};
  /// Mass that the goal judges, on an axis with two masses. Empty for a rigid axis; also empty if the
  /// manifest does not name the mass and both masses close the loop, at different points or in different
  /// trials.
  std::optional<motion::EncoderPlace> of{};
  /// The manifest names the mass that the goal judges (`of`), and the other mass closes the loop at some
  /// design point or in some trial. The position error of the judged mass then has its own measures.
  bool of_other_mass{false};
  /// The manifest does not name the mass, and both masses close the loop, at different points or in different
  /// trials. The goal judges the mass that closes the loop.
  bool of_either{false};
  bool beside_load{false};  ///< the goal judges the motor; in addition the same goal is counted for the load
};

/// Proportion that the goal demands: of machines if the goal is about machines, of moves otherwise.
constexpr double demanded_proportion(const Goal& goal) {
  return goal.machines.value_or(goal.moves);
}

constexpr std::string_view mass_text(motion::EncoderPlace mass) {
  return mass == motion::EncoderPlace::load ? "load" : "motor";
}

/// Name in files of a measure of a move, as this goal uses it. If the goal judges the mass that does not
/// close the loop, measures of the position error get the name of the mass in front: "load_true_overshoot".
inline std::string name_in(const Goal& goal, std::string_view measure) {
  const bool of_position = measure.starts_with("true_") || measure.starts_with("tolerance_");
  return (goal.of_other_mass && of_position ? std::string(mass_text(*goal.of)) + "_" : "") +
         std::string(measure);
}

/// The goal for the load that is counted beside the same goal for the motor (`beside_load`).
inline Goal for_the_load(Goal goal) {
  goal.of = motion::EncoderPlace::load;
  goal.of_other_mass = !goal.of_other_mass;
  goal.beside_load = false;
  return goal;
}
/// A parameter that the command `tune` may change, with the range that it searches.
struct FreeParameter {
  std::string name;         ///< dotted path, e.g. "controller.ki"
  std::string unit{"1"};    ///< unit in the manifest; "1" if dimensionless
  double low{0.0};          ///< lowest value that the search may try
  double high{0.0};         ///< highest value that the search may try
  bool logarithmic{false};  ///< the search uses a logarithmic scale; low is above 0
  bool whole{false};        ///< only whole numbers may be tried
};

/// Relative uncertainties of loop parameters that a data sheet does not state exactly. The margins are
/// checked for machines that deviate from those of the study by up to these fractions, in both directions and
/// in all combinations. Only parameters that the study does not draw are spread. An empty member switches its
/// spread off.
struct LoopSpread {
  std::optional<double> inertia{};  ///< relative spread of plant.inertia and of the load's inertia
  std::optional<double> damping{};  ///< relative spread of the contact's damping, before and while sliding
  /// Relative spread of the torque (or force) that one code of the converter produces.
  std::optional<double> torque_constant{};
};

/// Uncertainties of inertia, damping and torque constant that data sheets usually leave open, as relative
/// spreads.
constexpr LoopSpread typical_spread{.inertia = 0.1, .damping = 0.3, .torque_constant = 0.05};

/// Stability margins that the linearised loop of every machine must keep, at every stiffness that the contact
/// has before it slides. An empty member switches its margin off.
struct LoopMargins {
  /// Minimum gain margin for an increase and for a decrease of the gain, dB.
  std::optional<double> gain{6.0};
  std::optional<double> phase{30.0};  ///< minimum phase margin, degrees
  /// Minimum delay margin: samples by which the delay of the loop may grow.
  std::optional<double> delay{0.5};
  /// Maximum of the sensitivity |S| over the frequency, S = 1/(1 + L) with the open loop L.
  std::optional<double> sensitivity{};
  LoopSpread spread{};
};

/// Stability margins that are usual when a loop is commissioned: 6 dB, 45°, a sensitivity of at most 1.6, one
/// sample of additional delay, for machines with the typical spread.
constexpr LoopMargins commissioning_margins{
    .gain = 6.0, .phase = 45.0, .delay = 1.0, .sensitivity = 1.6, .spread = typical_spread};

/// The task of the command `zerocount tune` (section `tune`). Among the values of the free parameters that
/// meet the goal of the study and keep the margins, find those with the smallest criterion.
struct Tuning {
  std::vector<FreeParameter> free{};
  /// Name of the measure to be minimised; if it is about a band and names none, the band of the goal is used.
  std::string minimise{"band_settling_time.p95"};
  LoopMargins margins{};
};

}  // namespace zerocount::study
