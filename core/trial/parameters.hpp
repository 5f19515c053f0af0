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
  dac,   ///< The torque is rounded to codes, with the converter's errors.
  exact  ///< The torque acts as commanded at the sampling instants.
};

/// Torque levels in place of targets: the rotor is loaded in open loop. Each level is a move. The torque goes
/// from the level before, or from 0 at the start, to the level at a constant rate, and is held there.
struct TorqueCommand {
  std::vector<double> levels;  ///< Torque levels, N m; empty if the trial has targets
  double rate{0.1};            ///< Rate at which the torque goes to a level, N m/s
  TorquePath through{TorquePath::dac};
  /// A recorded torque in place of the levels, as one move. There is then one level, 0. Null without a
  /// record.
  std::shared_ptr<const TorqueRecord> record{};
};

/// The moves of a trial.
struct CommandParameters {
  std::vector<std::int64_t> targets;  ///< Targets from the start of the trial, counts, one per move
  /// Time for which each target is held, from the move's start, or each torque level, once it is reached, s
  double hold{1.0};
  loop::ReferenceProfile profile{};
  TorqueCommand torque{};
  /// Targets before rounding to counts, from the start of the trial, rad, one per move. If it is empty, the
  /// targets in counts are used.
  std::vector<double> exact_targets{};
};

/// Initial state of the hook. `slide` is arrival from sliding: the hook slides at t = 0, and the spring had
/// the breakaway torque when the slide began.
enum class InitialMode { stick, slide };

/// Random loading before t = 0 and after the preload, slow and without creep. The torque goes to `reversals`
/// levels in turn, alternately up and down, and then back to 0, where θ = 0. Each level is drawn evenly
/// between the level before and ±`torque`.
struct RandomHistory {
  int reversals{0};
  double torque{0.0};  ///< Largest magnitude of a level, N m
};

/// State of plant and controller at t = 0.
struct InitialConditions {
  /// Position of the mass that closes the loop within a count of the fine encoder, in [0, 1).
  double encoder_phase{0.5};
  double position{0.0};   ///< Position of the contact on the rotor, rad; selects from the profiles
  double hardening{0.0};  ///< xh, rad
  double preload{0.0};    ///< Torque of a slow load-and-unload from virgin before t = 0, without creep, N m
  RandomHistory history{};
  double velocity{0.0};  ///< ω, rad/s
  double integral{0.0};  ///< I of the controller before the first sample, N m
  InitialMode mode{InitialMode::stick};
  double gap{0.0};  ///< Twist of the coupling over its gap, −½ to ½
  /// The contact has been loaded slowly from virgin to the constant disturbance, and carries it at t = 0.
  /// With a second mass it also carries the torques that act on that mass (held_start).
  bool holding{false};
  /// Position of the other mass within a count of EncoderParameters::other, in [0, 1)
  double other_encoder_phase{0.5};
};

/// Criteria of the verdict on a move.
struct VerdictParameters {
  double dwell{0.05};   ///< Time at zero error that makes an arrival, s
  double window{0.05};  ///< Last part of the move, which decides its outcome, s
  /// A move that diverges is ended there, and the trial with it (see divergence.hpp).
  bool stop{false};
  /// Excess of |error| over that at the move's first sample beyond which the move has diverged, counts
  double limit{1000.0};
  ErrorBands bands{};
  Tolerances tolerances{};
  /// Settling within the tolerances and true overshoot are measured.
  bool position_error{false};
  bool motion{false};  ///< The true motion is measured too (see MotionMeasures).
  /// Largest |e| at which a move is at rest, for the measures of the true motion, counts
  double rest_band{0.0};
  /// The position error of this mass is measured too, whichever closes the loop.
  std::optional<motion::EncoderPlace> other_mass{};
};

/// Parameters of a second mass apart from its coupling.
struct LoadSideParameters {
  /// Kinematic error of the coupling, as a function of the rotor's angle
  std::vector<RippleParameters> error{};
  DisturbanceParameters disturbance{};  ///< Disturbance of the load, as a function of its angle
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

/// Exchanges the fine encoder and the encoder on the other mass.
void exchange_encoders(TrialParameters& parameters);

/// Number of whole samples in `duration` (s) at `sample_rate` (Hz): round(duration·sample_rate).
std::int64_t samples_in(double duration, double sample_rate);

/// Number of moves: targets, or torque levels.
std::size_t move_count(const TrialParameters& parameters);

/// The target of the move, counts; 0 for a torque level.
std::int64_t target_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of move `move`: round(hold·sample_rate), plus the samples on the way to it for a torque
/// level.
std::int64_t samples_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of all moves.
std::int64_t samples_of_trial(const TrialParameters& parameters);

}  // namespace zerocount::trial
