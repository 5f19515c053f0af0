#include "analysis/statistics/clusters/rig_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount::statistics {
namespace {

constexpr double min_allowance = 0.25;  // δ
constexpr std::int64_t rigs_per_worst = 20;

/// r and δ of rig_tolerance().
struct RankAndAllowance {
  std::int64_t rank{0};  ///< 0: too few rigs
  double allowance{0.0};
};

RankAndAllowance rank_and_allowance(std::int64_t rigs, double content, double confidence) {
  const auto allowance_of = [&](std::int64_t rank) {
    return 1.0 - proportion_at_most(rank - 1, rigs, confidence) / (1.0 - content);
  };
  RankAndAllowance chosen{1, rigs > 0 ? allowance_of(1) : 0.0};
  if (!(chosen.allowance > 0.0)) return {};
  while (chosen.rank < rigs) {
    const double next = allowance_of(chosen.rank + 1);
    if (next < min_allowance) break;
    chosen = {chosen.rank + 1, next};
  }
  return chosen;
}

/// The q < y for which trials·KL(y‖q) = −ln(allowance).
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

double zero_proportion(const RigTrials& rig) {
  return rate(rig.zero_moves, rig.moves);
}

double lower_bound_of(const RigTrials& rig, double allowance) {
  if (rig.moves == rig.trials) return proportion_at_least(rig.zero_moves, rig.moves, 1.0 - allowance);
  return chernoff_lower(zero_proportion(rig), rig.trials, allowance);
}

double success_sd_of(std::span<const RigTrials> rigs) {
  const auto n = static_cast<double>(rigs.size());
  const auto trials = static_cast<double>(rigs.front().trials);
  if (rigs.size() < 2 || rigs.front().trials < 2) return unknown;
  double sum = 0.0, squares = 0.0, within = 0.0;
  for (const RigTrials& rig : rigs) {
    const double p = rate(rig.successes, rig.trials);
    sum += p;
    squares += p * p;
    within += p * (1.0 - p);
  }
  const double between = (squares - sum * sum / n) / (n - 1.0);
  return std::sqrt(std::max(0.0, between - within / (n * (trials - 1.0))));
}

double worst_of(std::span<const RigTrials> rigs) {
  std::vector<double> rates;
  for (const RigTrials& rig : rigs) rates.push_back(rate(rig.successes, rig.trials));
  std::sort(rates.begin(), rates.end());
  const auto worst = (rates.size() + rigs_per_worst - 1) / rigs_per_worst;
  double sum = 0.0;
  for (std::size_t i = 0; i < worst; ++i) sum += rates[i];
  return sum / static_cast<double>(worst);
}

}  // namespace

std::int64_t min_rigs_for_tolerance(double content, double confidence) {
  // Rank 1 needs content^R < 1 − confidence.
  auto rigs = static_cast<std::int64_t>(std::floor(std::log1p(-confidence) / std::log(content)));
  while (rank_and_allowance(rigs, content, confidence).rank == 0) ++rigs;
  return rigs;
}

double tolerance_allowance(std::int64_t rigs, double content, double confidence) {
  return rank_and_allowance(rigs, content, confidence).allowance;
}

RigTrials& RigTrials::operator+=(const RigTrials& other) {
  trials += other.trials;
  successes += other.successes;
  moves += other.moves;
  zero_moves += other.zero_moves;
  return *this;
}

RigTolerance rig_tolerance(std::span<const RigTrials> rigs, double content, double confidence) {
  RigTolerance result{.content = content, .confidence = confidence};
  result.min_rigs = min_rigs_for_tolerance(content, confidence);
  const RankAndAllowance chosen = rank_and_allowance(std::ssize(rigs), content, confidence);
  if (chosen.rank == 0) return result;
  std::vector<RigTrials> sorted(rigs.begin(), rigs.end());
  const auto place = sorted.begin() + (chosen.rank - 1);
  std::nth_element(sorted.begin(), place, sorted.end(), [](const RigTrials& a, const RigTrials& b) {
    return zero_proportion(a) < zero_proportion(b);
  });
  result.zero_at_least = lower_bound_of(*place, chosen.allowance);
  return result;
}

std::string tolerance_sentence(const RigTolerance& tolerance) {
  const std::string level = fmt::format("{} confidence", text::percent(tolerance.confidence));
  if (std::isnan(tolerance.zero_at_least)) {
    return fmt::format("with {}, it takes {} machines to say in how many moves {} of machines hold zero",
                       level, tolerance.min_rigs, text::percent(tolerance.content));
  }
  if (!(tolerance.zero_at_least > 0.0)) {
    return fmt::format("with {} nothing is shown of the moves in which {} of machines hold zero", level,
                       text::percent(tolerance.content));
  }
  return fmt::format("with {} at least {} of machines hold zero in at least {} of moves", level,
                     text::percent(tolerance.content), text::percent_at_least(tolerance.zero_at_least));
}

RigStatistics rig_statistics(std::span<const RigTrials> rigs, double confidence) {
  require_confidence(confidence);
  RigStatistics result;
  if (rigs.empty()) return result;
  result.n = std::ssize(rigs);
  result.success_sd = success_sd_of(rigs);
  const std::int64_t faultless = std::count_if(
      rigs.begin(), rigs.end(), [](const RigTrials& rig) { return rig.successes == rig.trials; });
  result.without_failure = rate(faultless, result.n);
  result.without_failure_bounds = clopper_pearson(faultless, result.n, confidence);
  result.worst_5_percent = worst_of(rigs);
  result.trials_of_rig = rigs.front().trials;
  for (const RigTrials& rig : rigs) {
    result.successes.add(rig.successes, rig.trials);
    result.successes_of_rigs.push_back(rig.successes);
  }
  result.tolerance = rig_tolerance(rigs, result.tolerance.content, confidence);
  return result;
}

SuccessClaim success_claim_on_rigs(const ClusterSums& sums, double confidence) {
  const double at_least = clustered_at_least(sums, confidence);
  return {sums.events,  sums.events - sums.hits, confidence,
          at_least,     1.0 - at_least,          clustered_at_most(sums, confidence),
          sums.clusters};
}

}  // namespace zerocount::statistics
