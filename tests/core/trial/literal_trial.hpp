#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

// The command at each sample of a trial, computed independently from core/README.md.

/// Where the samples of a move are in those of its trial.
struct MoveSpan {
  std::size_t first{0};
  std::size_t size{0};
};

/// The moves of the trial, by the stated numbers of samples.
std::vector<MoveSpan> literal_spans(const trial::TrialParameters& p);

/// The number of samples on the way from one torque level to the next, n = ⌈|b − a|/(rate·T)⌉; `move` has b.
std::int64_t literal_samples_on_the_way(const trial::TrialParameters& p, std::size_t move);

/// The commanded torque (N m) of each sample, open loop.
std::vector<long double> literal_torques(const trial::TrialParameters& p);

/// The fastest motion from rest to rest within the limits of a profile: a velocity that is constant for the
/// time `pulse`, averaged over the time `ramp`, which limits the acceleration, and over the time `blend`,
/// which limits the jerk. All s; 0 of those that the profile does without.
struct LiteralMotion {
  long double travel{0};  ///< with its sign, counts
  long double pulse{0};
  long double ramp{0};
  long double blend{0};
  long double duration() const { return pulse + ramp + blend; }
};

/// The motion of the reference in a move, closed loop.
LiteralMotion literal_motion(const trial::TrialParameters& p, std::size_t move);

/// How far (counts, not rounded) the motion is after the time t (s).
long double literal_travel(const LiteralMotion& motion, long double t);

// The decisions of a controller, computed independently from core/loop/equations.md and the recorded samples
// of a whole trial at once: nothing is carried from sample to sample but where the equation itself does.

/// What the controller decides at a sample.
struct LiteralDecision {
  loop::ControlPhase phase{loop::ControlPhase::fine};
  long double integral{0};  ///< I, N m
  long double torque{0};    ///< u, N m
};

/// The decisions of a closed loop by the recorded references and counts. The last decided torque is that of
/// the record.
std::vector<LiteralDecision> literal_decisions(const trial::TrialParameters& p,
                                               const std::vector<trial::SampleRecord>& samples);

/// What the recorded samples of a move say of it.
struct LiteralMeasures {
  trial::MoveOutcome outcome;  ///< but what goes on between the samples: broke_away and reversal_depth
  std::vector<trial::Jerk> jerks;
};

/// The measures of move `move`, each by its definition over all samples of the move. The torques before
/// rounding, N m, tell whether the converter clipped; there are none past it.
LiteralMeasures literal_measures(const trial::TrialParameters& p,
                                 const std::vector<trial::SampleRecord>& samples,
                                 const std::vector<long double>& wanted, std::size_t move);

/// Expects the measures of a move to be those by the definitions.
void expect_same_measures(const trial::MoveOutcome& measured, const trial::MoveOutcome& expected);
void expect_same_jerks(const std::vector<trial::Jerk>& measured, const std::vector<trial::Jerk>& expected);

// Encoders, converter and amplifier, computed independently from core/README.md and the recorded samples of
// a whole trial at once.

/// What an encoder shows at each sample, by the recorded angles.
std::vector<std::int64_t> literal_fine_counts(const trial::TrialParameters& p,
                                              const std::vector<trial::SampleRecord>& samples);
std::vector<std::int64_t> literal_coarse_counts(const trial::TrialParameters& p,
                                                const std::vector<trial::SampleRecord>& samples);

/// The amplifier over a part of a sample.
struct LiteralDrive {
  long double input{0};   ///< v, N m
  long double output{0};  ///< u at its start, N m
  long double time{0};    ///< its duration, s
};

/// The amplifier's input and output in each sample, in two parts, by the recorded codes, or by the recorded
/// torques past the converter.
std::vector<std::array<LiteralDrive, 2>> literal_drive(const trial::TrialParameters& p,
                                                       const std::vector<trial::SampleRecord>& samples);

}  // namespace zerocount::testing
