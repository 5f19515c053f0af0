#pragma once

#include <vector>

#include "runners/tuning/effects/limits.hpp"

namespace zerocount::tuning {

/// Effects of a real axis that are added to those of the point: encoder noise of 0.1 counts rms, in
/// quadrature to that of each encoder that closes the loop, and one sample of delay.
std::vector<Effect> added_effects(const study::Study& study, std::int64_t point);

/// A mode of the load at this natural frequency (Hz): theory::with_load_mode.
Effect load_mode(const study::Study& study, std::int64_t point, double frequency);

/// Rates of the goal with each of these effects added, and, if the study has no second mass, with the lowest
/// mode of a load that costs no goal under any condition more than 1 %. All on the random numbers of the
/// study.
///
///     borne(f, units): rates with a mode at f ≥ those without it − 1 %, on the same units
///     f = half the sample rate; by halves while borne on few units; bisected to 5 %
///     in steps of 5 % to the lowest that is borne on more units, whose rate is given
///
/// A mode takes ten times as long to simulate as a rigid axis, so these are the first units with 800 000
/// samples together, and the few are 1/8 of them; there one missing unit more is allowed. A frequency is
/// given up as soon as no result of the other units could save it. Nothing is simulated where every goal is
/// met by 1 % at most.
/// @param tell gets what is being simulated
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> additions_to(const EffectRuns& runs, const TellStage& tell = {});

}  // namespace zerocount::tuning
