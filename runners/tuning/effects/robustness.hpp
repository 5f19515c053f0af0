#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "runners/tuning/effects/limits.hpp"

/// What a tuned answer rests on: its premises changed one by one, at the same gains.
namespace zerocount::tuning {

/// A study whose premises differ.
struct Variation {
  Limit limit;        ///< its rate, as that of an effect
  bool holds{false};  ///< every goal is met under every condition by these units
};

/// Effects that change premises of a point: twice the spread of all that is drawn of the axis
/// (study::PointEdit::widen), if anything is; and half and twice the delay, or half a sample and two where it
/// has none.
std::vector<Effect> other_premises(const study::Study& study, std::int64_t point);

/// The rates with ten other seeds, of which the lowest counts, and with each of the other premises, on all
/// units.
/// @param runs of the study as it is. @param units of it
/// @param with_seed the same study with another seed
/// @throws trial::Interrupted, trials::Spent
std::vector<Variation> variations_of(const EffectRuns& runs, const trials::Replicates& units,
                                     const std::function<study::Study(std::uint64_t seed)>& with_seed,
                                     const trials::Effort& effort);

}  // namespace zerocount::tuning
