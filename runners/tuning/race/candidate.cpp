#include "runners/tuning/race/candidate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/statistics/quantile.hpp"

namespace zerocount::tuning {
namespace {

bool machine_meets(const Aim& aim, const UnitResult& unit) {
  return unit.met >= aim.moves * unit.moves;
}

/// Sums over the units of a world.
struct WorldCounts {
  std::int64_t units{0};
  std::int64_t moves{0};
  std::int64_t met{0};
  std::int64_t machines{0};  ///< units that meet the goal
};

std::size_t worlds_of(const Aim& aim) {
  return static_cast<std::size_t>(std::max<std::int64_t>(aim.worlds, 1));
}

std::size_t common_units(const Candidate& a, const Candidate& b) {
  return std::min(a.units.size(), b.units.size());
}

}  // namespace

Estimate estimate_of(const Aim& aim, const Candidate& candidate, std::int64_t units) {
  const std::int64_t worlds = std::max<std::int64_t>(aim.worlds, 1);
  std::vector<WorldCounts> counts(static_cast<std::size_t>(worlds));
  std::vector<double> values;
  units = std::min<std::int64_t>(units, std::ssize(candidate.units));
  for (std::int64_t i = 0; i < units; ++i) {
    const UnitResult& unit = candidate.units[static_cast<std::size_t>(i)];
    WorldCounts& world = counts[static_cast<std::size_t>(i % worlds)];
    world.moves += unit.moves;
    world.met += unit.met;
    world.machines += machine_meets(aim, unit) ? 1 : 0;
    ++world.units;
    values.insert(values.end(), unit.values.begin(), unit.values.end());
  }
  Estimate worst;
  bool none = true;
  for (const WorldCounts& world : counts) {
    if (world.moves == 0) continue;
    const double moves = static_cast<double>(world.met) / static_cast<double>(world.moves);
    const double rate =
        aim.machines ? static_cast<double>(world.machines) / static_cast<double>(world.units) : moves;
    worst.moves = none ? moves : std::min(worst.moves, moves);
    worst.rate = none ? rate : std::min(worst.rate, rate);
    worst.near_goal += std::min(rate, wanted_rate(aim)) / static_cast<double>(worlds);
    none = false;
  }
  worst.units = worlds == 1 ? units : std::max<std::int64_t>(units / worlds, none ? 0 : 1);
  if (none) return worst;
  worst.criterion = values.empty() ? std::numeric_limits<double>::infinity()
                                   : statistics::sample_quantile(std::move(values), aim.quantile);
  return worst;
}

bool seems_to_meet(const Aim& aim, const Estimate& estimate) {
  const auto n = static_cast<double>(estimate.units);
  const double cautious = (estimate.rate * n + 1.0) / (n + 2.0);
  const double error = std::sqrt(cautious * (1.0 - cautious) / std::max(n, 1.0));
  return estimate.units > 0 &&
         estimate.rate >= wanted_rate(aim) + std::min(error, 0.5 * (1.0 - wanted_rate(aim)));
}

bool is_better(const Aim& aim, const Estimate& a, const Estimate& b) {
  const bool a_meets = seems_to_meet(aim, a);
  if (a_meets != seems_to_meet(aim, b)) return a_meets;
  if (a_meets && a.criterion != b.criterion) return a.criterion < b.criterion;
  if (aim.worlds > 0 && a.near_goal != b.near_goal) return a.near_goal > b.near_goal;
  if (a.rate != b.rate) return a.rate > b.rate;
  if (a.moves != b.moves) return a.moves > b.moves;
  return a.criterion < b.criterion;
}

double goal_loss(const Aim& aim, const UnitResult& unit) {
  if (aim.machines) return machine_meets(aim, unit) ? 0.0 : 1.0;
  return unit.moves == 0 ? 0.0 : 1.0 - met_proportion(unit);
}

double late_part(const UnitResult& unit, double limit) {
  if (unit.values.empty()) return 0.0;
  const auto late = std::ranges::count_if(unit.values, [limit](double value) { return value > limit; });
  return static_cast<double>(late) / static_cast<double>(unit.values.size());
}

double evidence_of_increase(std::span<const double> differences) {
  constexpr std::array<double, 6> bets{0.02, 0.05, 0.12, 0.3, 0.6, 0.9};
  double evidence = 0.0;
  for (const double bet : bets) {
    double log_wealth = 0.0;
    for (const double d : differences) log_wealth += std::log1p(bet * d);
    evidence += std::exp(std::min(log_wealth, 500.0)) / bets.size();
  }
  return evidence;
}

bool surely_meets(const Aim& aim, const Candidate& candidate, double alpha) {
  const std::size_t worlds = worlds_of(aim);
  for (std::size_t world = 0; world < worlds; ++world) {
    std::vector<double> differences;
    for (std::size_t i = world; i < candidate.units.size(); i += worlds)
      differences.push_back(1.0 - wanted_rate(aim) - goal_loss(aim, candidate.units[i]));
    if (evidence_of_increase(differences) <= 1.0 / alpha) return false;
  }
  return true;
}

bool surely_misses(const Aim& aim, const Candidate& candidate, const Candidate& reliable, double alpha) {
  const std::size_t worlds = worlds_of(aim);
  const double wanted = static_cast<double>(worlds) / alpha;
  for (std::size_t world = 0; world < worlds; ++world) {
    std::vector<double> beyond_goal;
    std::vector<double> beyond_reliable;
    for (std::size_t i = world; i < common_units(candidate, reliable); i += worlds) {
      const double loss = goal_loss(aim, candidate.units[i]);
      beyond_goal.push_back(loss - (1.0 - wanted_rate(aim)));
      beyond_reliable.push_back(loss - goal_loss(aim, reliable.units[i]));
    }
    if (evidence_of_increase(beyond_goal) > wanted && evidence_of_increase(beyond_reliable) > wanted)
      return true;
  }
  return false;
}

bool is_significantly_later(const Aim& aim, const Candidate& candidate, const Candidate& best, double alpha) {
  const std::size_t units = common_units(candidate, best);
  const double limit = estimate_of(aim, best, static_cast<std::int64_t>(units)).criterion;
  std::vector<double> differences;
  for (std::size_t i = 0; i < units; ++i)
    differences.push_back(late_part(candidate.units[i], limit) - late_part(best.units[i], limit));
  return evidence_of_increase(differences) > 1.0 / alpha;
}

}  // namespace zerocount::tuning
