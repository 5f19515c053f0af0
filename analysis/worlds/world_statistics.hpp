#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/goal/question.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/worlds/world_rule.hpp"

/// Statistics of a design point by world.
namespace zerocount::worlds {

/// The proportion in each world, and the worst, median and best of them.
struct RatesOfWorlds {
  /// [world] Rate with bounds that hold for each world alone.
  std::vector<goal::BoundedProportion> worlds;
  std::size_t worst{0};  ///< World with the lowest rate.
  std::size_t best{0};   ///< World with the highest rate.
  double median{0.0};    ///< Median of the rates.
  /// The lowest rate of all worlds; its bounds are the lowest of the bounds of each world (Bonferroni).
  goal::BoundedProportion lowest{};
};

/// The rate of each world; all of them have trials. @param confidence of each one-sided bound
RatesOfWorlds rates_of_worlds(const std::vector<measures::MoveCounts>& worlds, double confidence);

/// A design point by world.
struct PointWorlds {
  RatesOfWorlds success;  ///< Proportion of trials in which all moves ended at zero error.
  /// Rates by the question of the study: proportions of machines, moves or trials. Without a goal: `success`.
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
/// @param point of a study with worlds @param inputs what differs between them there @param seed of the study
/// @param points that the point was chosen from, as of goal::judge_goal()
PointWorlds point_worlds(const measures::PointSummary& point, const goal::Question& all,
                         std::span<const WorldInput> inputs, std::uint64_t seed, double confidence,
                         std::size_t points = 1);

}  // namespace zerocount::worlds
