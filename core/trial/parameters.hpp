#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/friction/load_friction.hpp"
#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/random/random_numbers.hpp"
#include "core/trial/disturbance.hpp"
#include "core/trial/error_bands.hpp"
#include "core/trial/torque_record.hpp"

namespace zerocount::trial {

enum class TorquePath {
  dac,   ///< rounded to codes, with the converter's errors
  exact  ///< as commanded at the sampling instants
};

/// Torque levels in place of targets: the rotor is loaded open loop. Level i is a move of its own: the torque
/// goes to it at the constant rate, from the level before (from 0 at the start), and is held there.
struct TorqueCommand {
  std::vector<double> levels;  ///< N m; empty where the trial has targets
  double rate{0.1};            ///< N m/s
  TorquePath through{TorquePath::dac};
  /// A recorded torque in place of the levels, as one move; then there is one level, 0. Null: none.
  std::shared_ptr<const TorqueRecord> record{};
};

/// The moves of a trial.
struct CommandParameters {
  std::vector<std::int64_t> targets;  ///< counts from the start of the trial, one per move
  double hold{1.0};  ///< s: of each target, from the move's start; of each torque level, once it is reached
  loop::ReferenceProfile profile{};
  TorqueCommand torque{};
  /// Targets before rounding to counts, from the start of the trial, rad, one per move; empty: those in
  /// counts.
  std::vector<double> exact_targets{};
};

/// Initial state of the hook. `slide` is arrival from sliding: the hook slides at t = 0, and the spring had
/// the breakaway torque when the slide began.
enum class InitialMode { stick, slide };

/// Random loading before t = 0 and after the preload, slow and without creep: the torque goes to `reversals`
/// levels one after the other, each drawn evenly between the last one and ±`torque`, up and down by turns,
/// and then back to 0; θ = 0 there.
struct RandomHistory {
  int reversals{0};
  double torque{0.0};  ///< largest magnitude of a level, N m
};

/// State of machine and controller at t = 0.
struct InitialConditions {
  /// Position of the mass that closes the loop within a count of the fine encoder, in [0, 1).
  double encoder_phase{0.5};
  double position{0.0};   ///< position of the contact on the rotor, rad; selects from the profiles
  double hardening{0.0};  ///< xh, rad
  double preload{0.0};    ///< torque of a slow load-and-unload from virgin before t = 0, without creep, N m
  RandomHistory history{};
  double velocity{0.0};  ///< ω, rad/s
  double integral{0.0};  ///< I of the controller before the first sample, N m
  InitialMode mode{InitialMode::stick};
  double gap{0.0};  ///< twist of the coupling over its gap, −½ to ½
  /// The contact has been loaded slowly from virgin to the constant disturbance, and carries it at t = 0;
  /// with a second mass also what acts on that (held_start).
  bool holding{false};
  double other_encoder_phase{0.5};  ///< of the other mass in a count of EncoderParameters::other, in [0, 1)
};

/// Criteria of the verdict on a move.
struct VerdictParameters {
  double dwell{0.05};    ///< time at zero error that makes an arrival, s
  double window{0.05};   ///< last part of the move, by which its outcome is judged, s
  bool stop{false};      ///< a move that diverges is ended there, and the trial with it (see divergence.hpp)
  double limit{1000.0};  ///< |error| beyond that of the move's first sample that counts as diverged, counts
  ErrorBands bands{};
  Tolerances tolerances{};
  bool position_error{false};  ///< settling within the tolerances and true overshoot are measured
  bool motion{false};          ///< the true motion is measured too (see MotionMeasures)
  double rest_band{0.0};       ///< |e| within which a move is at rest, for these measures, counts
  /// The position error of this mass is measured too, whichever closes the loop.
  std::optional<motion::EncoderPlace> other_mass{};
};

/// What belongs to a second mass beside its coupling.
struct LoadSideParameters {
  std::vector<RippleParameters> error{};  ///< kinematic error of the coupling, by the rotor's angle
  DisturbanceParameters disturbance{};    ///< of the load, by its angle
  friction::LoadFrictionParameters friction{};
};

/// Everything that determines a trial: two equal sets give the same trial, bit for bit.
struct TrialParameters {
  motion::PlantParameters plant;
  friction::FrictionAlongRotor friction;
  loop::EncoderParameters encoder;
  loop::DacParameters dac;
  loop::AmplifierParameters amplifier{};
  loop::ControllerParameters controller;
  CommandParameters command;
  InitialConditions initial;
  VerdictParameters verdict;
  random::TrialRandomness randomness{};
  DisturbanceParameters disturbance{};
  LoadSideParameters load_side{};
};

/// Exchanges the fine encoder with that of the other mass.
void exchange_encoders(TrialParameters& parameters);

/// Number of whole samples in `duration` (s) at `sample_rate` (Hz): round(duration·sample_rate).
std::int64_t samples_in(double duration, double sample_rate);

/// Number of moves: targets, or torque levels.
std::size_t move_count(const TrialParameters& parameters);

/// The target of the move, counts; 0 of a torque level.
std::int64_t target_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of move `move`: round(hold·sample_rate), and for a torque level those on the way to it
/// before.
std::int64_t samples_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of all moves.
std::int64_t samples_of_trial(const TrialParameters& parameters);

}  // namespace zerocount::trial
