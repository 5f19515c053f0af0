#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

// The command at each sample of a trial, computed independently from core/README.md.

/// Range of the samples of a move within its trial: index of the first one, and their number.
struct MoveSpan {
  std::size_t first{0};
  std::size_t size{0};
};

/// The sample ranges of the moves of the trial, from the specified numbers of samples.
std::vector<MoveSpan> literal_spans(const trial::TrialParameters& p);

/// The number of samples on the way from one torque level to the next, n = ⌈|b − a|/(rate·T)⌉.
/// @param move move with the level b
std::int64_t literal_samples_on_the_way(const trial::TrialParameters& p, std::size_t move);

/// The commanded torque (N m) of each sample of an open-loop trial.
std::vector<long double> literal_torques(const trial::TrialParameters& p);

/// The fastest motion from rest to rest within the limits of a profile: a velocity that is constant for the
/// time `pulse`, averaged over the time `ramp`, which limits the acceleration, and over the time `blend`,
/// which limits the jerk. All times are in s; a time is 0 if the profile does not use it.
struct LiteralMotion {
  long double travel{0};  ///< signed travel from rest to rest, counts
  long double pulse{0};
  long double ramp{0};
  long double blend{0};
  long double duration() const { return pulse + ramp + blend; }
};

/// The motion of the reference in a move of a closed-loop trial.
LiteralMotion literal_motion(const trial::TrialParameters& p, std::size_t move);

/// Distance that the motion has covered after the time t (s), in counts, not rounded.
long double literal_travel(const LiteralMotion& motion, long double t);

// The decisions of a controller, computed independently from core/loop/equations.md and the recorded samples
// of a whole trial at once: nothing is carried from sample to sample but where the equation itself does.

/// The controller's decision at one sample.
struct LiteralDecision {
  loop::ControlPhase phase{loop::ControlPhase::fine};
  long double integral{0};  ///< state I of the integral, N m
  long double torque{0};    ///< decided torque u, N m
};

/// The decisions of a closed loop, computed from the recorded references and counts. The previously decided
/// torque is taken from the record.
std::vector<LiteralDecision> literal_decisions(const trial::TrialParameters& p,
                                               const std::vector<trial::SampleRecord>& samples);

/// The measures of a move, computed from its recorded samples.
struct LiteralMeasures {
  /// All measures of the move except broke_away and reversal_depth, which change between samples.
  trial::MoveOutcome outcome;
  std::vector<trial::Jerk> jerks;
};

/// The measures of move `move`, each computed by its definition from all samples of the move. The torques
/// before rounding, N m, show whether the converter clipped; they are empty for torques that bypass the
/// converter.
LiteralMeasures literal_measures(const trial::TrialParameters& p,
                                 const std::vector<trial::SampleRecord>& samples,
                                 const std::vector<long double>& wanted, std::size_t move);

/// Expects that the measures of a move equal those computed by the definitions.
void expect_same_measures(const trial::MoveOutcome& measured, const trial::MoveOutcome& expected);
void expect_same_jerks(const std::vector<trial::Jerk>& measured, const std::vector<trial::Jerk>& expected);

// Encoders, converter and amplifier, computed independently from core/README.md and the recorded samples of
// a whole trial at once.

/// The reading of the fine encoder at each sample, computed from the recorded angles.
std::vector<std::int64_t> literal_fine_counts(const trial::TrialParameters& p,
                                              const std::vector<trial::SampleRecord>& samples);
std::vector<std::int64_t> literal_coarse_counts(const trial::TrialParameters& p,
                                                const std::vector<trial::SampleRecord>& samples);

/// State of the amplifier during a part of a sample.
struct LiteralDrive {
  long double input{0};   ///< input v of the amplifier, N m
  long double output{0};  ///< output u of the amplifier at the start of the part, N m
  long double time{0};    ///< duration of this part of the sample, s
};

/// The amplifier's input and output in each sample, in two parts, computed from the recorded codes, or from
/// the recorded torques if they bypass the converter.
std::vector<std::array<LiteralDrive, 2>> literal_drive(const trial::TrialParameters& p,
                                                       const std::vector<trial::SampleRecord>& samples);

}  // namespace zerocount::testing
