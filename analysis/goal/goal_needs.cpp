#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/goal/goal_chances.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "core/numerics/bisection.hpp"

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
  const std::int64_t found = numerics::first_where_by_doubling(low, high + 1, decides);
  return found <= high ? found : 0;
}

constexpr std::int64_t max_more_trials = 1024;  ///< times the trials of a rig that are observed

/// The worlds of a study, or the study itself. Worlds in which the same was observed have the same chances.
class ObservedStudy {
 public:
  ObservedStudy(const study::Goal& goal, const std::vector<measures::MoveCounts>& worlds, std::size_t points,
                std::size_t parts)
      : worlds_(std::ssize(worlds)) {
    std::map<std::array<double, 3>, std::size_t> known;  // of worlds without rigs
    for (const measures::MoveCounts& world : worlds) {
      const std::array<double, 3> key{static_cast<double>(world.met), static_cast<double>(world.moves),
                                      world.of_trials.hits_squared};
      const auto [at, is_new] = known.try_emplace(key, different_.size());
      if (!is_new && world.rigs.empty()) {
        ++different_[at->second].second;
      } else {
        different_.emplace_back(ObservedWorld(goal, world, points, parts * worlds.size()), 1);
      }
    }
  }

  std::int64_t worlds() const { return worlds_; }

  /// Probability that a study whose worlds have this size is decided: met in all of them, or missed in one.
  double chance_of_decision(const PlannedSize& planned) {
    double all_met = 1.0;
    double none_missed = 1.0;
    for (auto& [world, alike] : different_) {
      const Chances chances = world.chances_of(planned);
      all_met *= std::pow(chances.met, static_cast<double>(alike));
      none_missed *= std::pow(1.0 - chances.missed, static_cast<double>(alike));
    }
    return all_met + 1.0 - none_missed;
  }

 private:
  std::int64_t worlds_;
  std::vector<std::pair<ObservedWorld, std::int64_t>> different_;  ///< and how many are like it
};

}  // namespace

Needs needs_of(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
               double probability, std::size_t parts) {
  if (!counts.of_conditions.empty()) {
    const std::size_t conditions = counts.of_conditions.size();
    const std::size_t worst = judge_goal(goal, counts, points, parts).condition;
    Needs needs = needs_of(goal, counts.of_conditions[worst], points, probability, parts * conditions);
    needs.trials *= static_cast<std::int64_t>(conditions);
    return needs;
  }
  const std::vector<measures::MoveCounts> all =
      counts.worlds > 0 ? measures::in_worlds(counts) : std::vector{counts};
  if (std::ranges::any_of(all, [](const measures::MoveCounts& world) { return world.moves == 0; })) return {};
  ObservedStudy observed(goal, all, points, parts);
  const std::int64_t worlds = observed.worlds();
  const auto smallest_with = [&](std::int64_t most, std::int64_t more) {
    return smallest(2, most, [&](std::int64_t units) {
      return observed.chance_of_decision({units, more}) >= probability;
    });
  };
  if (counts.rigs.empty()) return {0, worlds * smallest_with(max_trials / worlds, 1)};
  // More trials on each rig are needed where those observed cannot tell rigs that meet the goal from others.
  for (std::int64_t more = 1; more <= max_more_trials; more *= 2) {
    const std::int64_t each = more * counts.rigs.front().trials;
    const std::int64_t rigs = smallest_with(std::min(max_rigs, max_trials / each / worlds), more);
    if (rigs > 0) return {rigs * worlds, rigs * each * worlds};
  }
  return {};
}

std::vector<Needs> smallest_studies(const study::Goal& goal, bool on_rigs, std::int64_t moves,
                                    std::size_t points, std::int64_t worlds) {
  if (worlds > 0) {
    std::vector<Needs> studies = smallest_studies(goal, on_rigs, moves, points);
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
