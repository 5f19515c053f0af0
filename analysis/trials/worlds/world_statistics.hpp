#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/worlds/world_rule.hpp"

/// Statistics of a design point by world: one draw of what all machines share and nobody knows.
namespace zerocount::worlds {

/// The proportion (such as the success rate) in each world, one draw of what all machines share, and the
/// worst, median and best of them.
struct RatesOfWorlds {
  /// [world] Proportion with bounds that hold for each world alone.
  std::vector<goal::BoundedProportion> worlds;
  std::size_t worst{0};  ///< Index of the world with the lowest rate.
  std::size_t best{0};   ///< Index of the world with the highest rate.
  double median{0.0};    ///< Median of the worlds' rates.
  /// The lowest rate of all worlds; its bounds are the lowest of the bounds of each world (Bonferroni).
  goal::BoundedProportion lowest{};
};

/// The success rate of each world from its counts; every world must have trials.
/// @param confidence confidence of each one-sided bound
RatesOfWorlds rates_of_worlds(const std::vector<measures::MoveCounts>& worlds, double confidence);

/// The results of a design point by world: one draw of what all machines share and nobody knows.
struct PointWorlds {
  RatesOfWorlds success;  ///< Proportion of trials in each world in which all moves ended at zero error.
  /// Rates of each world by the question of the study: proportions of machines, moves or trials that meet the
  /// goal. Without a goal: `success`.
  RatesOfWorlds asked;
  std::optional<goal::Verdict> goal;  ///< Verdict on the goal; nothing without a goal.
  /// [world] Worst status of all goals in all settings; empty without a goal.
  std::vector<goal::Status> statuses;
  std::vector<bool> bad;  ///< [world] Whether the world is bad, see point_worlds().
  /// Rule that separates the bad worlds from the others; nothing if none is found.
  std::optional<WorldRule> rule;
};

/// A world is bad if fewer of its moves (or machines) than a goal asks for meet it, in any setting.
/// Without a goal it is bad if its rate of success, on average over the settings, is shown to be below the
/// median.
/// @param point statistics of a design point of a study with worlds
/// @param inputs parameters that differ between the worlds
/// @param seed seed of the study
/// @param points number of points from which the point was chosen, see goal::judge_goal()
PointWorlds point_worlds(const measures::PointSummary& point, const goal::Question& all,
                         std::span<const WorldInput> inputs, std::uint64_t seed, double confidence,
                         std::size_t points = 1);

}  // namespace zerocount::worlds
