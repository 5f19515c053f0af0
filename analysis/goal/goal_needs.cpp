#include <algorithm>
#include <cmath>

#include "analysis/goal/goal_verdict.hpp"

namespace zerocount::goal {
namespace {

constexpr std::int64_t max_trials = 1'000'000'000;
constexpr std::int64_t max_rigs = 100'000;

std::int64_t scaled(std::int64_t number, double factor) {
  return std::llround(static_cast<double>(number) * factor);
}

/// The counts of a study without rigs that is `factor` times as large, with the same proportions.
measures::MoveCounts larger_study(const measures::MoveCounts& counts, double factor) {
  measures::MoveCounts larger;
  larger.moves = scaled(counts.moves, factor);
  larger.met = scaled(counts.met, factor);
  const statistics::ClusterSums& sums = counts.of_trials;
  larger.of_trials = {.clusters = scaled(sums.clusters, factor),
                      .hits = larger.met,
                      .events = larger.moves,
                      .hits_squared = sums.hits_squared * factor,
                      .hits_by_events = sums.hits_by_events * factor,
                      .events_squared = sums.events_squared * factor};
  return larger;
}

/// The counts of a study on so many rigs with the proportions of the observed ones: rig i stands for the
/// quantile (i + ½)/rigs of the rigs in order of their moves that meet the goal.
measures::MoveCounts rigs_like(std::vector<statistics::RigMoves> sorted, std::int64_t rigs) {
  measures::MoveCounts counts;
  for (std::int64_t i = 0; i < rigs; ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(rigs);
    const auto index = static_cast<std::size_t>(place * static_cast<double>(sorted.size()));
    const statistics::RigMoves& rig = sorted[std::min(index, sorted.size() - 1)];
    counts.rigs.push_back(rig);
    counts.moves += rig.moves;
    counts.met += rig.met;
  }
  return counts;
}

/// The smallest number from `low` on, up to `high`, for which `decides`, which is taken to stay true from
/// there on; 0 if there is none.
template <class Decides>
std::int64_t smallest(std::int64_t low, std::int64_t high, const Decides& decides) {
  std::int64_t decided = low;
  while (!decides(decided)) {
    low = decided + 1;
    if (decided > high / 2) return 0;
    decided *= 2;
  }
  while (low < decided) {
    const std::int64_t middle = low + (decided - low) / 2;
    if (decides(middle)) {
      decided = middle;
    } else {
      low = middle + 1;
    }
  }
  return decided;
}

constexpr std::int64_t max_more_trials = 1024;  ///< times the trials of a rig that are observed

/// The rigs with `more` times the trials each that decide; 0 if none of up to max_rigs do.
std::int64_t rigs_needed(const study::Goal& goal, const measures::MoveCounts& counts, std::int64_t more,
                         std::size_t points) {
  std::vector<statistics::RigMoves> rigs = counts.rigs;
  std::sort(rigs.begin(), rigs.end(), [](const statistics::RigMoves& a, const statistics::RigMoves& b) {
    return a.met * b.moves < b.met * a.moves;
  });
  for (statistics::RigMoves& rig : rigs) {
    rig.trials *= more;
    rig.moves *= more;
    rig.met *= more;
  }
  const std::int64_t needed = smallest(2, max_rigs, [&](std::int64_t n) {
    return judge_goal(goal, rigs_like(rigs, n), points).status != Status::undecided;
  });
  return needed <= max_trials / std::max<std::int64_t>(rigs.front().trials, 1) ? needed : 0;
}

/// The trials without rigs that decide; 0 if none of up to max_trials do.
std::int64_t trials_needed(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  const std::int64_t trials = counts.of_trials.clusters;
  if (trials == 0) return 0;
  return smallest(2, max_trials, [&](std::int64_t n) {
    const double factor = static_cast<double>(n) / static_cast<double>(trials);
    return judge_goal(goal, larger_study(counts, factor), points).status != Status::undecided;
  });
}

/// Study size of one world with which the verdicts of all these worlds are expected to be decided.
Needs needs_of_each(const study::Goal& goal, const std::vector<measures::MoveCounts>& worlds,
                    std::size_t points) {
  const auto most_of_all = [&](const auto& needed_in) {
    std::int64_t most = 0;
    for (const measures::MoveCounts& world : worlds) {
      const std::int64_t needed = needed_in(world);
      if (needed == 0) return std::int64_t{0};
      most = std::max(most, needed);
    }
    return most;
  };
  if (worlds.front().rigs.empty())
    return {0, most_of_all([&](const auto& world) { return trials_needed(goal, world, points); })};
  // More trials on each rig are needed where these cannot tell rigs below and above Goal::moves apart.
  for (std::int64_t more = 1; more <= max_more_trials; more *= 2) {
    const std::int64_t rigs =
        most_of_all([&](const auto& world) { return rigs_needed(goal, world, more, points); });
    if (rigs > 0) return {rigs, rigs * more * worlds.front().rigs.front().trials};
  }
  return {};
}

/// Whether a world is expected to be found below the goal.
bool is_below(const study::Goal& goal, const measures::MoveCounts& counts) {
  if (!goal.machines) return static_cast<double>(counts.met) < goal.moves * static_cast<double>(counts.moves);
  const auto meeting = std::count_if(counts.rigs.begin(), counts.rigs.end(), [&](const auto& rig) {
    return static_cast<double>(rig.met) >= goal.moves * static_cast<double>(rig.moves);
  });
  return static_cast<double>(meeting) < *goal.machines * static_cast<double>(counts.rigs.size());
}

/// One world below the goal decides it: the cheapest of these. Where there is none, every world must be
/// decided.
Needs needs_of_worlds(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  const std::vector<measures::MoveCounts> worlds = measures::in_worlds(counts);
  points *= worlds.size();
  Needs cheapest;
  for (const measures::MoveCounts& world : worlds) {
    if (!is_below(goal, world)) continue;
    const Needs one = needs_of_each(goal, {world}, points);
    if (one.trials > 0 && (cheapest.trials == 0 || one.trials < cheapest.trials)) cheapest = one;
  }
  const Needs needs = cheapest.trials > 0 ? cheapest : needs_of_each(goal, worlds, points);
  return {needs.rigs * counts.worlds, needs.trials * counts.worlds};
}

}  // namespace

Needs needs_of(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  return counts.worlds > 0 ? needs_of_worlds(goal, counts, points) : needs_of_each(goal, {counts}, points);
}

std::vector<Needs> smallest_studies(const study::Goal& goal, bool on_rigs, std::int64_t moves,
                                    std::size_t points, std::int64_t worlds) {
  if (worlds > 0) {
    std::vector<Needs> studies =
        smallest_studies(goal, on_rigs, moves, points * static_cast<std::size_t>(worlds));
    for (Needs& one : studies) one = {one.rigs * worlds, one.trials * worlds};
    return studies;
  }
  const auto met = [&](const measures::MoveCounts& counts) {
    return judge_goal(goal, counts, points).status == Status::met;
  };
  if (!on_rigs) {
    const statistics::ClusterSums of_one = {.clusters = 1,
                                            .hits = moves,
                                            .events = moves,
                                            .hits_squared = static_cast<double>(moves * moves),
                                            .hits_by_events = static_cast<double>(moves * moves),
                                            .events_squared = static_cast<double>(moves * moves)};
    const measures::MoveCounts trial{moves, moves, of_one, {}};
    const std::int64_t trials = smallest(
        2, max_trials, [&](std::int64_t n) { return met(larger_study(trial, static_cast<double>(n))); });
    return trials > 0 ? std::vector<Needs>{{0, trials}} : std::vector<Needs>{};
  }
  std::vector<Needs> studies;
  for (const std::int64_t trials : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000}) {
    const std::vector<statistics::RigMoves> rig{{trials, trials * moves, trials * moves}};
    const std::int64_t rigs = smallest(2, max_rigs, [&](std::int64_t n) { return met(rigs_like(rig, n)); });
    const bool fewer = studies.empty() || rigs < studies.back().rigs;
    if (rigs > 0 && fewer) studies.push_back({rigs, rigs * trials});
  }
  return studies;
}

}  // namespace zerocount::goal
