#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/worlds/world_statistics.hpp"

namespace zerocount::summary {

/// The worlds at a point; nothing for a study without worlds, or where a world has no trials yet.
/// @param chosen_from number of points that it was chosen from
std::optional<worlds::PointWorlds> worlds_of_point(const StudySummary& summary, std::int64_t point,
                                                   std::size_t chosen_from = 1);

/// Parameters, and quantities derived from them, that differ between the worlds at a point of a study with
/// worlds.
inline const std::vector<worlds::WorldInput>& world_inputs_of(const StudySummary& summary,
                                                              std::int64_t point) {
  return summary.world_inputs[static_cast<std::size_t>(point)];
}

/// "5 of 30 worlds fall short of the goal: where friction.alpha > 1.4 1/s (5 of these 5, and 1 of the other
/// 25; by chance with probability 0.0025); what separates them need not be the cause", with the other
/// quantities that separate the same worlds, and what derived ones mean.
std::string bad_worlds_sentence(const worlds::PointWorlds& point,
                                const std::vector<worlds::WorldInput>& inputs,
                                const goal::Question& question);

/// The worlds at a design point, and what differs between them.
struct WorldsReading {
  const worlds::PointWorlds& point;
  const std::vector<worlds::WorldInput>& inputs;
  const goal::Question& question;
};

/// Rates and verdicts by world, the bad worlds and the rule that tells them apart; people are shown the rates
/// that the study is judged by.
document::Description<WorldsReading> worlds_description(const goal::Question& question);

}  // namespace zerocount::summary
