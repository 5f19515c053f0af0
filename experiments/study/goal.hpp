#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/parameters.hpp"
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
  /// Mass that it speaks of, of two; none of a rigid axis, and where which closes the loop differs.
  std::optional<motion::EncoderPlace> of{};
  /// It is not the mass that closes the loop (everywhere): its position error has measures of its own.
  bool of_other_mass{false};
  bool of_either{
      false};  ///< without `of`, where which mass closes the loop differs: it is of the one that does
  bool beside_load{false};  ///< it is of the motor, and the same of the load is counted beside it
};

constexpr std::string_view mass_text(motion::EncoderPlace mass) {
  return mass == motion::EncoderPlace::load ? "load" : "motor";
}

/// The name in files of a measure of a move for the goal: "load_true_overshoot", of the position error of its
/// mass.
inline std::string name_in(const Goal& goal, std::string_view measure) {
  const bool of_position = measure.starts_with("true_") || measure.starts_with("tolerance_");
  return (goal.of_other_mass && of_position ? std::string(mass_text(*goal.of)) + "_" : "") +
         std::string(measure);
}

/// A goal with `beside_load` as one of the load.
inline Goal for_the_load(Goal goal) {
  goal.of = motion::EncoderPlace::load;
  goal.of_other_mass = !goal.of_other_mass;
  goal.beside_load = false;
  return goal;
}
/// A parameter that tuning may change.
struct FreeParameter {
  std::string name;         ///< dotted path, e.g. "controller.ki"
  std::string unit{"1"};    ///< in the manifest; "1" if dimensionless
  double low{0.0};          ///< lowest value
  double high{0.0};         ///< highest value
  bool logarithmic{false};  ///< sought on a logarithmic scale; low is above 0
  bool whole{false};        ///< takes whole numbers only
};

/// Machines of the margins differ from those that the study draws by up to these parts, both ways, in all
/// combinations: what a data sheet does not tell exactly. Only of what the study does not draw. Each is off
/// where it has no value.
struct LoopSpread {
  std::optional<double> inertia{};          ///< of plant.inertia, and of the load
  std::optional<double> damping{};          ///< of the contact's damping, before sliding and while sliding
  std::optional<double> torque_constant{};  ///< of the torque, or force, that a code makes
};

/// Spread that data sheets usually leave open.
constexpr LoopSpread typical_spread{.inertia = 0.1, .damping = 0.3, .torque_constant = 0.05};

/// Margins that the linear loop of every machine must keep, at every stiffness of the contact before it
/// slides. Each is off where it has no value.
struct LoopMargins {
  std::optional<double> gain{6.0};      ///< dB, both ways
  std::optional<double> phase{30.0};    ///< degrees
  std::optional<double> delay{0.5};     ///< samples by which the delay may grow
  std::optional<double> sensitivity{};  ///< largest |S|, S = 1/(1 + L)
  LoopSpread spread{};
};

/// What is accepted when a loop is commissioned: 6 dB, 45°, a sensitivity of at most 1.6, a sample of delay,
/// of machines with a typical spread.
constexpr LoopMargins commissioning_margins{
    .gain = 6.0, .phase = 45.0, .delay = 1.0, .sensitivity = 1.6, .spread = typical_spread};

/// The task of `zerocount tune` (`tune`): values of the free parameters that meet the goal of the study and
/// keep the margins, and of these the ones with the smallest criterion.
struct Tuning {
  std::vector<FreeParameter> free{};
  std::string minimise{"band_settling_time.p95"};  ///< the criterion; without [band] of the goal's band
  LoopMargins margins{};
};

}  // namespace zerocount::study
