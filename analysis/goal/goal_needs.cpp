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
  Needs cheapest;
  std::int64_t rigs = 0;
  std::int64_t trials_of_unit = 0;  ///< of a rig; without rigs of the world
  bool some_below = false;
  bool all_decided = true;
  for (const measures::MoveCounts& world : measures::in_worlds(counts)) {
    const Needs one = needs_of(goal, world, points * static_cast<std::size_t>(counts.worlds));
    all_decided = all_decided && one.trials > 0;
    if (one.trials == 0) continue;
    if (is_below(goal, world)) {
      if (!some_below || one.trials < cheapest.trials) cheapest = one;
      some_below = true;
    }
    rigs = std::max(rigs, one.rigs);
    trials_of_unit = std::max(trials_of_unit, one.rigs > 0 ? one.trials / one.rigs : one.trials);
  }
  if (!some_below && !all_decided) return {};
  const Needs dearest{rigs, rigs > 0 ? rigs * trials_of_unit : trials_of_unit};
  const Needs needs = some_below ? cheapest : dearest;
  return {needs.rigs * counts.worlds, needs.trials * counts.worlds};
}

}  // namespace

Needs needs_of(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  if (counts.worlds > 0) return needs_of_worlds(goal, counts, points);
  const auto decided = [&](const measures::MoveCounts& larger) {
    return judge_goal(goal, larger, points).status != Status::undecided;
  };
  if (counts.rigs.empty()) {
    const std::int64_t trials = counts.of_trials.clusters;
    if (trials == 0) return {};
    const auto factor = [&](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(trials); };
    return {
        0, smallest(2, max_trials, [&](std::int64_t n) { return decided(larger_study(counts, factor(n))); })};
  }
  std::vector<statistics::RigMoves> sorted = counts.rigs;
  std::sort(sorted.begin(), sorted.end(), [](const statistics::RigMoves& a, const statistics::RigMoves& b) {
    return a.met * b.moves < b.met * a.moves;
  });
  // More trials on each rig are needed where these cannot tell rigs below and above Goal::moves apart.
  for (std::int64_t more = 1; more <= 1024; more *= 2) {
    std::vector<statistics::RigMoves> rigs = sorted;
    for (statistics::RigMoves& rig : rigs) {
      rig.trials *= more;
      rig.moves *= more;
      rig.met *= more;
    }
    const std::int64_t needed =
        smallest(2, max_rigs, [&](std::int64_t n) { return decided(rigs_like(rigs, n)); });
    if (needed > 0 && needed <= max_trials / std::max<std::int64_t>(rigs.front().trials, 1))
      return {needed, needed * rigs.front().trials};
  }
  return {};
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
