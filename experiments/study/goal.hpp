#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// A limit of a goal. A move can meet the goal only if the magnitude of this measure is at most `largest`.
struct GoalLimit {
  std::string measure;  ///< name of the measure in files: "overshoot", "band_exits[2]",
                        ///< "tolerance_settling_time[1e-08]"
  double largest{0.0};  ///< largest allowed magnitude, in the measure's unit
};

/// The time that a goal allows a move, counted from the start of the move (key `within`) or from the end of
/// its profile (key `after_profile`). The end of the profile differs between moves.
struct TimeLimit {
  double time{1.0};  ///< allowed time, s
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
  std::string name{};                 ///< name of the goal under `goals`; empty if the study has one goal
  std::int64_t band{0};               ///< counts; one of StudyFeatures::bands; not used with a tolerance
  std::optional<double> tolerance{};  ///< rad, or m; one of StudyFeatures::tolerances
  parameters::AxisKind axis{};        ///< kind of axis of the study; determines the units
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
  /// The manifest names the mass `of`, and the other mass closes the loop somewhere. The position error of
  /// `of` then has its own measures.
  bool of_other_mass{false};
  /// The manifest does not name the mass, and both masses close the loop, at different points or in different
  /// trials. The goal judges the mass that closes the loop.
  bool of_either{false};
  bool beside_load{false};  ///< the goal judges the motor; the same goal for the load is counted beside it
};

constexpr std::string_view mass_text(motion::EncoderPlace mass) {
  return mass == motion::EncoderPlace::load ? "load" : "motor";
}

/// Name in files of a measure of a move, for the goal. If the goal judges the mass that does not close the
/// loop, measures of the position error get the name of the mass in front: "load_true_overshoot".
inline std::string name_in(const Goal& goal, std::string_view measure) {
  const bool of_position = measure.starts_with("true_") || measure.starts_with("tolerance_");
  return (goal.of_other_mass && of_position ? std::string(mass_text(*goal.of)) + "_" : "") +
         std::string(measure);
}

/// The goal for the load that belongs to a goal for the motor with `beside_load`.
inline Goal for_the_load(Goal goal) {
  goal.of = motion::EncoderPlace::load;
  goal.of_other_mass = !goal.of_other_mass;
  goal.beside_load = false;
  return goal;
}
/// A parameter that tuning may change.
struct FreeParameter {
  std::string name;         ///< dotted path, e.g. "controller.ki"
  std::string unit{"1"};    ///< unit in the manifest; "1" if dimensionless
  double low{0.0};          ///< lowest value
  double high{0.0};         ///< highest value
  bool logarithmic{false};  ///< the search uses a logarithmic scale; low is above 0
  bool whole{false};        ///< the parameter takes whole numbers only
};

/// Relative uncertainties of loop parameters that a data sheet does not state exactly. The margins are
/// checked for machines that deviate from those of the study by up to these fractions, in both directions and
/// in all combinations. Only parameters that the study does not draw are spread. An empty member switches its
/// spread off.
struct LoopSpread {
  std::optional<double> inertia{};  ///< relative spread of plant.inertia and of the load's inertia
  std::optional<double> damping{};  ///< relative spread of the contact's damping, before and while sliding
  std::optional<double> torque_constant{};  ///< relative spread of the torque, or force, per code
};

/// Spread that data sheets usually leave open.
constexpr LoopSpread typical_spread{.inertia = 0.1, .damping = 0.3, .torque_constant = 0.05};

/// Stability margins that the linearised loop of every machine must keep, at every stiffness that the contact
/// has before it slides. An empty member switches its margin off.
struct LoopMargins {
  std::optional<double> gain{6.0};      ///< gain margin in both directions, dB
  std::optional<double> phase{30.0};    ///< phase margin, degrees
  std::optional<double> delay{0.5};     ///< samples by which the delay may grow
  std::optional<double> sensitivity{};  ///< largest |S|, S = 1/(1 + L)
  LoopSpread spread{};
};

/// Margins that are usual when a loop is commissioned: 6 dB, 45°, a sensitivity of at most 1.6, one sample of
/// additional delay, for machines with the typical spread.
constexpr LoopMargins commissioning_margins{
    .gain = 6.0, .phase = 45.0, .delay = 1.0, .sensitivity = 1.6, .spread = typical_spread};

/// The task of the command `zerocount tune` (section `tune`). Among the values of the free parameters that
/// meet the goal of the study and keep the margins, find those with the smallest criterion.
struct Tuning {
  std::vector<FreeParameter> free{};
  std::string minimise{"band_settling_time.p95"};  ///< the criterion; without [band] of the goal's band
  LoopMargins margins{};
};

}  // namespace zerocount::study
