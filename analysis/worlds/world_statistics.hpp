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

/// The proportion in each world, and its worst, median and best.
struct RatesOfWorlds {
  std::vector<goal::BoundedProportion> worlds;  ///< [world], each bound alone
  std::size_t worst{0};                         ///< world of the lowest rate
  std::size_t best{0};
  double median{0.0};  ///< of the rates
  /// The lowest rate of all worlds; its bounds are the lowest of the bounds of each world (Bonferroni).
  goal::BoundedProportion lowest{};
};

/// The rate of each world; all of them have trials. @param confidence of each one-sided bound
RatesOfWorlds rates_of_worlds(const std::vector<measures::MoveCounts>& worlds, double confidence);

/// A design point by world.
struct PointWorlds {
  RatesOfWorlds success;  ///< trials all of whose moves ended at zero error
  RatesOfWorlds asked;    ///< by the question: of machines, moves or trials; without a goal success
  std::optional<goal::Verdict> goal;  ///< of a study with a goal
  /// [world] the worst verdict of all goals under all conditions; empty without a goal
  std::vector<goal::Status> statuses;
  std::vector<bool> bad;          ///< [world]
  std::optional<WorldRule> rule;  ///< what the bad worlds have in common
};

/// A world is bad if fewer of its moves (or machines) than a goal asks for meet it, under any condition.
/// Without a goal it is bad if its rate of success, on average over the conditions, is shown to be below the
/// median.
/// @param point of a study with worlds @param inputs what differs between them there @param seed of the study
/// @param points that the point was chosen from, as of goal::judge_goal()
PointWorlds point_worlds(const measures::PointSummary& point, const goal::Question& all,
                         std::span<const WorldInput> inputs, std::uint64_t seed, double confidence,
                         std::size_t points = 1);

}  // namespace zerocount::worlds
