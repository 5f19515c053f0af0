#include "analysis/basis/statistics/clusters/machine_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"

namespace zerocount::statistics {
namespace {

constexpr double min_allowance = 0.25;  // δ
constexpr std::int64_t machines_per_worst = 20;

/// Rank r of the observed proportion that machine_tolerance() uses, and the error probability δ (allowance)
/// that it leaves for the machine's own moves.
struct RankAndAllowance {
  std::int64_t rank{0};  ///< Rank r of the observed proportion that is used, from 1; 0: too few machines.
  double allowance{0.0};
};

RankAndAllowance rank_and_allowance(std::int64_t machines, double content, double confidence) {
  const auto allowance_of = [&](std::int64_t rank) {
    return 1.0 - proportion_at_most(rank - 1, machines, confidence) / (1.0 - content);
  };
  RankAndAllowance chosen{1, machines > 0 ? allowance_of(1) : 0.0};
  if (!(chosen.allowance > 0.0)) return {};
  while (chosen.rank < machines) {
    const double next = allowance_of(chosen.rank + 1);
    if (next < min_allowance) break;
    chosen = {chosen.rank + 1, next};
  }
  return chosen;
}

/// Chernoff–Hoeffding lower bound: the q < y with trials·KL(y‖q) = −ln(allowance).
/// @param y observed mean
/// @param allowance probability of an error
double chernoff_lower(double y, std::int64_t trials, double allowance) {
  const double limit = -std::log(allowance) / static_cast<double>(trials);
  if (!(y > 0.0)) return 0.0;
  if (!(y < 1.0)) return std::exp(-limit);
  const auto excess = [&](double q) { return bernoulli_divergence(y, q) - limit; };
  constexpr double min_q = 1e-300;
  if (!(excess(min_q) > 0.0)) return 0.0;
  std::uintmax_t iterations = 200;
  return boost::math::tools::toms748_solve(excess, min_q, y, boost::math::tools::eps_tolerance<double>(48),
                                           iterations)
      .first;
}

double zero_proportion(const MachineTrials& machine) {
  return rate(machine.zero_moves, machine.moves);
}

double lower_bound_of(const MachineTrials& machine, double allowance) {
  if (machine.moves == machine.trials)
    return proportion_at_least(machine.zero_moves, machine.moves, 1.0 - allowance);
  return chernoff_lower(zero_proportion(machine), machine.trials, allowance);
}

double success_sd_of(std::span<const MachineTrials> machines) {
  const auto n = static_cast<double>(machines.size());
  const auto trials = static_cast<double>(machines.front().trials);
  if (machines.size() < 2 || machines.front().trials < 2) return unknown;
  double sum = 0.0, squares = 0.0, within = 0.0;
  for (const MachineTrials& machine : machines) {
    const double p = rate(machine.successes, machine.trials);
    sum += p;
    squares += p * p;
    within += p * (1.0 - p);
  }
  const double between = (squares - sum * sum / n) / (n - 1.0);
  return std::sqrt(std::max(0.0, between - within / (n * (trials - 1.0))));
}

double worst_of(std::span<const MachineTrials> machines) {
  std::vector<double> rates;
  for (const MachineTrials& machine : machines) rates.push_back(rate(machine.successes, machine.trials));
  std::sort(rates.begin(), rates.end());
  const auto worst = (rates.size() + machines_per_worst - 1) / machines_per_worst;
  double sum = 0.0;
  for (std::size_t i = 0; i < worst; ++i) sum += rates[i];
  return sum / static_cast<double>(worst);
}

}  // namespace

std::int64_t min_machines_for_tolerance(double content, double confidence) {
  // Rank 1 needs content^R < 1 − confidence.
  auto machines = static_cast<std::int64_t>(std::floor(std::log1p(-confidence) / std::log(content)));
  while (rank_and_allowance(machines, content, confidence).rank == 0) ++machines;
  return machines;
}

double tolerance_allowance(std::int64_t machines, double content, double confidence) {
  return rank_and_allowance(machines, content, confidence).allowance;
}

MachineTrials& MachineTrials::operator+=(const MachineTrials& other) {
  trials += other.trials;
  successes += other.successes;
  moves += other.moves;
  zero_moves += other.zero_moves;
  return *this;
}

MachineTolerance machine_tolerance(std::span<const MachineTrials> machines, double content,
                                   double confidence) {
  MachineTolerance result{.content = content, .confidence = confidence};
  result.min_machines = min_machines_for_tolerance(content, confidence);
  const RankAndAllowance chosen = rank_and_allowance(std::ssize(machines), content, confidence);
  if (chosen.rank == 0) return result;
  std::vector<MachineTrials> sorted(machines.begin(), machines.end());
  const auto place = sorted.begin() + (chosen.rank - 1);
  std::nth_element(sorted.begin(), place, sorted.end(), [](const MachineTrials& a, const MachineTrials& b) {
    return zero_proportion(a) < zero_proportion(b);
  });
  result.zero_at_least = lower_bound_of(*place, chosen.allowance);
  return result;
}

std::string tolerance_sentence(const MachineTolerance& tolerance) {
  const std::string level = fmt::format("{} confidence", text::percent(tolerance.confidence));
  if (std::isnan(tolerance.zero_at_least)) {
    return fmt::format("with {}, it takes {} machines to say in how many moves {} of machines hold zero",
                       level, tolerance.min_machines, text::percent(tolerance.content));
  }
  if (!(tolerance.zero_at_least > 0.0)) {
    return fmt::format("with {} nothing is shown of the moves in which {} of machines hold zero", level,
                       text::percent(tolerance.content));
  }
  return fmt::format("with {} at least {} of machines hold zero in at least {} of moves", level,
                     text::percent(tolerance.content), text::percent_at_least(tolerance.zero_at_least));
}

MachineStatistics machine_statistics(std::span<const MachineTrials> machines, double confidence) {
  require_confidence(confidence);
  MachineStatistics result;
  if (machines.empty()) return result;
  result.n = std::ssize(machines);
  result.success_sd = success_sd_of(machines);
  const std::int64_t faultless =
      std::count_if(machines.begin(), machines.end(),
                    [](const MachineTrials& machine) { return machine.successes == machine.trials; });
  result.without_failure = rate(faultless, result.n);
  result.without_failure_bounds = clopper_pearson(faultless, result.n, confidence);
  result.worst_5_percent = worst_of(machines);
  result.trials_of_machine = machines.front().trials;
  for (const MachineTrials& machine : machines) {
    result.successes.add(machine.successes, machine.trials);
    result.successes_of_machines.push_back(machine.successes);
  }
  result.tolerance = machine_tolerance(machines, result.tolerance.content, confidence);
  return result;
}

SuccessClaim success_claim_on_machines(const ClusterSums& sums, double confidence) {
  const double at_least = clustered_at_least(sums, confidence);
  return {sums.events,  sums.events - sums.hits, confidence,
          at_least,     1.0 - at_least,          clustered_at_most(sums, confidence),
          sums.clusters};
}

}  // namespace zerocount::statistics
