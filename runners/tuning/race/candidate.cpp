#include "runners/tuning/race/candidate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/trials/goal/standing.hpp"

namespace zerocount::tuning {
namespace {

bool machine_meets(const study::Goal& claim, const ClaimResult& result) {
  return result.met >= claim.moves * result.moves;
}

/// Counts of the machines of one world (one draw of the values that all machines share and nobody knows).
struct WorldCounts {
  std::int64_t machines{0};
  std::int64_t moves{0};
  std::int64_t met{0};
  std::int64_t machines_met{0};  ///< Number of machines that meet the goal.
};

std::size_t worlds_of(const Aim& aim) {
  return static_cast<std::size_t>(std::max<std::int64_t>(aim.worlds, 1));
}

std::size_t common_machines(const Candidate& a, const Candidate& b) {
  return std::min(a.machines.size(), b.machines.size());
}

/// Estimate of one claim (a goal in a setting) from a candidate's first machines. Rates are those of the
/// world with the lowest rate; near_goal is a mean over all worlds.
struct ClaimEstimate {
  double rate{0.0};
  double moves{0.0};
  double near_goal{0.0};
  bool has_moves{false};
};

ClaimEstimate estimate_of_claim(const Aim& aim, std::size_t claim, std::span<const MachineResult> machines) {
  const study::Goal& wanted = aim.claims[claim];
  std::vector<WorldCounts> counts(worlds_of(aim));
  for (std::size_t machine = 0; machine < machines.size(); ++machine) {
    const ClaimResult& result = machines[machine].claims[claim];
    WorldCounts& world = counts[machine % counts.size()];
    world.moves += result.moves;
    world.met += result.met;
    world.machines_met += machine_meets(wanted, result) ? 1 : 0;
    ++world.machines;
  }
  ClaimEstimate worst;
  for (const WorldCounts& world : counts) {
    if (world.moves == 0) continue;
    const double moves = static_cast<double>(world.met) / static_cast<double>(world.moves);
    const double rate = wanted.machines
                            ? static_cast<double>(world.machines_met) / static_cast<double>(world.machines)
                            : moves;
    worst.moves = worst.has_moves ? std::min(worst.moves, moves) : moves;
    worst.rate = worst.has_moves ? std::min(worst.rate, rate) : rate;
    worst.near_goal +=
        std::min(rate, study::demanded_proportion(wanted)) / static_cast<double>(counts.size());
    worst.has_moves = true;
  }
  return worst;
}

/// Margin of a success rate: logit of the rate minus logit of the wanted rate; positive if the rate is
/// higher. Finite for any rate that `machines` machines can have.
double margin_of(double rate, double wanted, std::int64_t machines) {
  constexpr double almost_all = 1.0 - 1e-9;  // success is not claimed: of all moves
  const auto n = static_cast<double>(machines);
  return goal::logit_difference((rate * n + 0.5) / (n + 1.0), std::min(wanted, almost_all));
}

/// Distance of a claim's observed rates from the wanted ones, without confidence bounds.
goal::Standing standing_of(const study::Goal& claim, const ClaimEstimate& estimate, std::int64_t machines) {
  goal::Standing standing{.observed = margin_of(estimate.rate, study::demanded_proportion(claim), machines)};
  if (claim.machines) standing.observed_of_moves = margin_of(estimate.moves, claim.moves, machines);
  return standing;
}

double standard_error(double rate, std::int64_t machines) {
  const auto n = static_cast<double>(machines);
  const double cautious = (rate * n + 1.0) / (n + 2.0);
  return std::sqrt(cautious * (1.0 - cautious) / std::max(n, 1.0));
}

bool seems_to_hold(const study::Goal& claim, double rate, std::int64_t machines) {
  const double error = standard_error(rate, machines);
  return rate >=
         study::demanded_proportion(claim) + std::min(error, 0.5 * (1.0 - study::demanded_proportion(claim)));
}

/// The claim (goal in a setting) whose criterion is the largest of a candidate's claims, and the value of
/// this criterion.
struct Latest {
  std::size_t claim{0};
  double value{0.0};
};

Latest latest_of(const Aim& aim, std::span<const MachineResult> machines) {
  Latest latest{0, late_value(machines, 0, aim.quantile)};
  for (std::size_t claim = 1; claim < aim.claims.size(); ++claim) {
    const double value = late_value(machines, claim, aim.quantile);
    if (value > latest.value) latest = {claim, value};
  }
  return latest;
}

constexpr double hardly_any = 0.01;  // proportion of the moves
constexpr double confidence = 0.95;  // of the bounds on a point's rate
constexpr std::int64_t fewest = 10;  // telling points: single ones occur by chance
constexpr std::int64_t one_in = 20;  // points must be telling

/// Confidence bounds on the proportion of moves that meet the worst goal. The moves of a machine may depend
/// on each other, so each machine counts as one observation.
statistics::ConfidenceInterval bounds_of(const RateEstimate& estimate) {
  const auto met =
      static_cast<std::int64_t>(std::floor(estimate.moves * static_cast<double>(estimate.machines)));
  return statistics::clopper_pearson(met, estimate.machines, confidence);
}

bool is_telling(const Aim& aim, const RateEstimate& estimate) {
  return estimate.machines > 0 && estimate.rate < study::demanded_proportion(aim.claims[estimate.worst]) &&
         bounds_of(estimate).low > hardly_any;
}

}  // namespace

RateEstimate estimate_of(const Aim& aim, std::span<const MachineResult> machines, std::int64_t count) {
  count = std::min<std::int64_t>(count, std::ssize(machines));
  machines = machines.first(static_cast<std::size_t>(count));
  const auto worlds = static_cast<std::int64_t>(worlds_of(aim));
  RateEstimate estimate;
  goal::Standing worst;
  std::vector<ClaimEstimate> claims;
  bool has_moves = false;
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    claims.push_back(estimate_of_claim(aim, claim, machines));
    has_moves = has_moves || claims.back().has_moves;
  }
  estimate.machines = worlds == 1 ? count : std::max<std::int64_t>(count / worlds, has_moves ? 1 : 0);
  std::vector<char> goal_is_missing((aim.claims.size() + aim.settings - 1) / aim.settings, 0);
  for (std::size_t claim = 0; claim < claims.size(); ++claim) {
    const ClaimEstimate& one = claims[claim];
    const goal::Standing standing = standing_of(aim.claims[claim], one, estimate.machines);
    if (claim == 0 || standing < worst) {
      worst = standing;
      estimate.worst = claim;
      estimate.margin = standing.observed;
      estimate.rate = one.rate;
      estimate.moves = one.moves;
    }
    estimate.rates.push_back(one.rate);
    estimate.near_goal += one.near_goal / static_cast<double>(claims.size());
    if (!seems_to_hold(aim.claims[claim], one.rate, estimate.machines))
      goal_is_missing[claim / aim.settings] = 1;
  }
  estimate.missing = std::ranges::count(goal_is_missing, 1);
  if (has_moves) estimate.criterion = latest_of(aim, machines).value;
  return estimate;
}

std::vector<RateEstimate> estimates_of(const Aim& aim, std::span<const Candidate> candidates,
                                       std::int64_t machines) {
  std::vector<RateEstimate> estimates(candidates.size());
  parallel::for_each_index(
      candidates.size(),
      [&](std::size_t i) { estimates[i] = estimate_of(aim, candidates[i].machines, machines); }, "estimate");
  return estimates;
}

bool reaches(const Aim& aim, const RateEstimate& estimate) {
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    if (estimate.rates[claim] < study::demanded_proportion(aim.claims[claim])) return false;
  }
  return true;
}

bool may_meet(const Aim& aim, const RateEstimate& estimate) {
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    const double rate = estimate.rates[claim];
    if (rate + 2.0 * standard_error(rate, estimate.machines) < study::demanded_proportion(aim.claims[claim]))
      return false;
  }
  return true;
}

bool is_better(const Aim& aim, const RateEstimate& a, const RateEstimate& b) {
  if (a.missing != b.missing) return a.missing < b.missing;
  if (a.missing == 0 && a.criterion != b.criterion) return a.criterion < b.criterion;
  if (aim.worlds > 0 && a.near_goal != b.near_goal) return a.near_goal > b.near_goal;
  if (a.margin != b.margin) return a.margin > b.margin;
  if (a.moves != b.moves) return a.moves > b.moves;
  if (a.near_goal != b.near_goal) return a.near_goal > b.near_goal;
  return a.criterion < b.criterion;
}

double goal_loss(const study::Goal& claim, const ClaimResult& result) {
  if (claim.machines) return machine_meets(claim, result) ? 0.0 : 1.0;
  return result.moves == 0 ? 0.0 : 1.0 - met_proportion(result);
}

double late_value(std::span<const MachineResult> machines, std::size_t claim, double quantile) {
  std::vector<double> values;
  for (const MachineResult& machine : machines)
    values.insert(values.end(), machine.claims[claim].values.begin(), machine.claims[claim].values.end());
  return values.empty() ? std::numeric_limits<double>::infinity()
                        : statistics::sample_quantile(std::move(values), quantile);
}

double late_part(const ClaimResult& result, double limit) {
  if (result.values.empty()) return 0.0;
  const auto late = std::ranges::count_if(result.values, [limit](double value) { return value > limit; });
  return static_cast<double>(late) / static_cast<double>(result.values.size());
}

double evidence_of_increase(std::span<const double> differences) {
  constexpr std::array<double, 6> bets{0.02, 0.05, 0.12, 0.3, 0.6, 0.9};
  // Moves that meet a goal or miss it differ in few ways, of which each is computed once.
  std::map<double, std::size_t> numbers;
  std::vector<double> distinct;
  std::vector<std::size_t> kind;
  kind.reserve(differences.size());
  for (const double d : differences) {
    const auto [known, is_new] = numbers.try_emplace(d, distinct.size());
    if (is_new) distinct.push_back(d);
    kind.push_back(known->second);
  }
  std::vector<double> growth(distinct.size());
  double evidence = 0.0;
  for (const double bet : bets) {
    for (std::size_t i = 0; i < distinct.size(); ++i) growth[i] = std::log1p(bet * distinct[i]);
    double log_wealth = 0.0;
    for (const std::size_t i : kind) log_wealth += growth[i];
    evidence += std::exp(std::min(log_wealth, 500.0)) / bets.size();
  }
  return evidence;
}

bool surely_meets(const Aim& aim, const Candidate& candidate, double alpha) {
  const std::size_t worlds = worlds_of(aim);
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    const study::Goal& wanted = aim.claims[claim];
    for (std::size_t world = 0; world < worlds; ++world) {
      std::vector<double> differences;
      for (std::size_t i = world; i < candidate.machines.size(); i += worlds)
        differences.push_back(1.0 - study::demanded_proportion(wanted) -
                              goal_loss(wanted, candidate.machines[i].claims[claim]));
      if (evidence_of_increase(differences) <= 1.0 / alpha) return false;
    }
  }
  return true;
}

bool surely_misses(const Aim& aim, const Candidate& candidate, const Candidate& reliable, double alpha) {
  const std::size_t worlds = worlds_of(aim);
  const double wanted_evidence = static_cast<double>(worlds * aim.claims.size()) / alpha;
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    const study::Goal& wanted = aim.claims[claim];
    for (std::size_t world = 0; world < worlds; ++world) {
      std::vector<double> beyond_goal;
      std::vector<double> beyond_reliable;
      for (std::size_t i = world; i < common_machines(candidate, reliable); i += worlds) {
        const double loss = goal_loss(wanted, candidate.machines[i].claims[claim]);
        beyond_goal.push_back(loss - (1.0 - study::demanded_proportion(wanted)));
        beyond_reliable.push_back(loss - goal_loss(wanted, reliable.machines[i].claims[claim]));
      }
      if (evidence_of_increase(beyond_goal) > wanted_evidence &&
          evidence_of_increase(beyond_reliable) > wanted_evidence)
        return true;
    }
  }
  return false;
}

bool is_significantly_later(const Aim& aim, const Candidate& candidate, const Candidate& best, double alpha) {
  const std::size_t machines = common_machines(candidate, best);
  const Latest latest = latest_of(aim, std::span(best.machines).first(machines));
  const double wanted_evidence = static_cast<double>(aim.claims.size()) / alpha;
  for (std::size_t claim = 0; claim < aim.claims.size(); ++claim) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < machines; ++i)
      differences.push_back(late_part(candidate.machines[i].claims[claim], latest.value) -
                            late_part(best.machines[i].claims[latest.claim], latest.value));
    if (evidence_of_increase(differences) > wanted_evidence) return true;
  }
  return false;
}

std::vector<TriedPoint> frontier_of(std::span<const TriedPoint> tried, std::int64_t machines) {
  std::vector<TriedPoint> points;
  std::ranges::copy_if(tried, std::back_inserter(points),
                       [machines](const TriedPoint& one) { return one.estimate.machines >= machines; });
  std::ranges::stable_sort(points, [](const TriedPoint& a, const TriedPoint& b) {
    if (a.estimate.criterion != b.estimate.criterion) return a.estimate.criterion < b.estimate.criterion;
    return a.estimate.rate > b.estimate.rate;
  });
  std::vector<TriedPoint> frontier;
  for (TriedPoint& one : points) {
    if (frontier.empty() || one.estimate.rate > frontier.back().estimate.rate)
      frontier.push_back(std::move(one));
  }
  return frontier;
}

bool Landscape::leads() const {
  return varies && telling >= fewest && telling * one_in >= points;
}

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried) {
  Landscape landscape{.points = std::ssize(tried)};
  double highest = 0.0, lowest = 1.0;
  for (const TriedPoint& one : tried) {
    landscape.telling += is_telling(aim, one.estimate) ? 1 : 0;
    if (one.estimate.machines == 0) continue;
    const statistics::ConfidenceInterval bounds = bounds_of(one.estimate);
    highest = std::max(highest, bounds.low);
    lowest = std::min(lowest, bounds.high);
  }
  landscape.varies = highest > lowest;
  return landscape;
}

}  // namespace zerocount::tuning
