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
  dac,   ///< The torque is rounded to codes of the digital-to-analogue converter, and has the converter's
         ///< errors.
  exact  ///< The torque acts exactly as commanded, from one sampling instant to the next.
};

/// Torque levels in place of targets: the rotor is loaded in open loop, without a controller. Each level is a
/// move. The torque goes from the level before, or from 0 at the start, to the level at a constant rate, and
/// is held there.
struct TorqueCommand {
  std::vector<double> levels;  ///< Torque levels, N m; empty if the trial has targets
  double rate{0.1};            ///< Rate at which the torque goes from level to level, N m/s
  TorquePath through{TorquePath::dac};
  /// A recorded torque in place of the levels, applied as one move. There is then one level, 0. Null if there
  /// is no record.
  std::shared_ptr<const TorqueRecord> record{};
};

/// Parameters of the moves of a trial: their targets and durations.
struct CommandParameters {
  std::vector<std::int64_t> targets;  ///< Targets, counted from the position at the start of the trial,
                                      ///< counts, one per move
  /// Time for which each target is held, measured from the move's start, or each torque level, measured from
  /// when it is reached, s
  double hold{1.0};
  loop::ReferenceProfile profile{};
  TorqueCommand torque{};
  /// Targets before they are rounded to counts, measured from the position at the start of the trial, rad,
  /// one per move. If it is empty, the targets in counts are used.
  std::vector<double> exact_targets{};
};

/// Initial state of the hook, the end of the friction spring that sticks to the ground. `stick`: it sticks at
/// t = 0. `slide`: it arrives sliding; the hook slides at t = 0, and the spring had the breakaway torque when
/// the slide began.
enum class InitialMode { stick, slide };

/// Random loading of the contact before t = 0 and after the preload, slow and without creep. The torque goes
/// to `reversals` levels in turn, alternately up and down, and then back to 0, where θ = 0. Each level is
/// drawn evenly between the level before and ±`torque`.
struct RandomHistory {
  int reversals{0};
  double torque{0.0};  ///< Largest absolute value of a torque level, N m
};

/// Initial state of plant and controller at t = 0.
struct InitialConditions {
  /// Position of the mass that closes the loop within a count of the fine encoder at t = 0, in [0, 1).
  double encoder_phase{0.5};
  double position{0.0};   ///< Position of the friction contact along the rotor at t = 0, rad; the friction
                          ///< profiles have their values there
  double hardening{0.0};  ///< Hardening xh of the contact by earlier creep, rad
  double preload{0.0};    ///< Largest torque of a slow loading and unloading before t = 0, from the virgin
                          ///< state and without creep, N m
  RandomHistory history{};
  double velocity{0.0};  ///< Velocity ω of rotor and load, rad/s
  double integral{0.0};  ///< Integral I of the controller before the first sample, N m
  InitialMode mode{InitialMode::stick};
  double gap{0.0};  ///< Initial position of the coupling in its gap, as a proportion of the gap's width, −½
                    ///< to ½
  /// Whether the axis holds a load at t = 0: the contact has been loaded slowly from virgin to the constant
  /// disturbance, and carries it. With a second mass it also carries the torques that act on that mass
  /// (held_start).
  bool holding{false};
  /// Position of the other mass within a count of its encoder, EncoderParameters::other, at t = 0, in [0, 1)
  double other_encoder_phase{0.5};
};

/// Criteria by which a move is judged, and the optional measures that are computed.
struct VerdictParameters {
  double dwell{0.05};   ///< Time for which the error must be zero to make an arrival, s
  double window{0.05};  ///< Duration of the last part of the move, whose errors decide its outcome, s
  /// Whether a move that diverges is ended there, and the trial with it (see divergence.hpp).
  bool stop{false};
  /// A move has diverged once |error| exceeds its value at the move's first sample by more than this, counts
  double limit{1000.0};
  ErrorBands bands{};
  Tolerances tolerances{};
  /// Whether settling within the tolerances of the position error and true overshoot are measured.
  bool position_error{false};
  bool motion{false};  ///< Whether the true motion is measured too (see MotionMeasures).
  /// Largest |e| at which a move is at rest, for the measures of the true motion, counts
  double rest_band{0.0};
  /// Mass whose position error is measured too, besides the mass that closes the loop; empty: none.
  std::optional<motion::EncoderPlace> other_mass{};
};

/// Parameters of a second mass apart from its coupling: kinematic error, disturbance and others.
struct LoadSideParameters {
  /// Kinematic error of the coupling to the second mass, as a function of the rotor's angle
  std::vector<RippleParameters> error{};
  DisturbanceParameters disturbance{};  ///< Disturbance torque on the second mass, with ripples as functions
                                        ///< of its angle
  friction::LoadFrictionParameters friction{};
};

/// All parameters of a trial: two equal sets give the same trial, bit for bit.
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

/// Exchanges the parameters of the fine encoder with those of the encoder on the other mass.
void exchange_encoders(TrialParameters& parameters);

/// Number of whole samples in `duration` (s) at `sample_rate` (Hz): round(duration·sample_rate).
std::int64_t samples_in(double duration, double sample_rate);

/// Number of moves of a trial: the number of its targets or torque levels.
std::size_t move_count(const TrialParameters& parameters);

/// The target of move number `move`, counts; 0 for a move to a torque level.
std::int64_t target_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of move number `move`: round(hold·sample_rate); for a torque level plus the samples on
/// the way to it.
std::int64_t samples_of_move(const TrialParameters& parameters, std::size_t move);

/// Number of samples of all moves of a trial together.
std::int64_t samples_of_trial(const TrialParameters& parameters);

}  // namespace zerocount::trial
