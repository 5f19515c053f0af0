#include "analysis/pairs/two_samples/exact_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "analysis/basis/statistics/distributions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::two_samples {
namespace {

/// Tango's score statistic Z(λ) for the hypothesis that the difference of two paired proportions is λ.
double score(const PairedFailures& failures, double difference) {
  const double n = static_cast<double>(failures.pairs);
  const double b = static_cast<double>(failures.only_current);
  const double c = static_cast<double>(failures.only_baseline);
  const double linear = -b - c + (2.0 * n - b + c) * difference;
  const double constant = -c * difference * (1.0 - difference);
  const double root = std::sqrt(std::max(0.0, linear * linear - 8.0 * n * constant));
  // This form of the positive root has no cancellation.
  const double proportion = linear > 0.0 ? -2.0 * constant / (root + linear) : (root - linear) / (4.0 * n);
  const double variance = n * (2.0 * proportion + difference * (1.0 - difference));
  const double distance = b - c - n * difference;
  if (variance > 0.0) return distance / std::sqrt(variance);
  return distance == 0.0 ? 0.0 : std::copysign(1e300, distance);
}

/// The difference λ between `low` and `high` at which Tango's statistic Z, which falls with λ, crosses
/// `level`.
double crossing(const PairedFailures& failures, double level, double low, double high) {
  const auto is_above = [&](double difference) { return score(failures, difference) > level; };
  if (!is_above(low)) return low;
  if (score(failures, high) >= level) return high;
  const auto [above, below] = numerics::bisect({low, high}, is_above, numerics::within(1e-14));
  return 0.5 * (above + below);
}

constexpr std::size_t max_exact_ranks = 200;
constexpr std::int64_t max_exact_lattice = 4'000'000;

/// Ranks of the magnitudes of differences, doubled so that the mean ranks of equal magnitudes are whole
/// numbers. Differences of 0 have none.
struct DoubledRanks {
  std::vector<std::int64_t> ranks;
  std::int64_t positive{0};  ///< Sum of the doubled ranks over the positive differences.
};

DoubledRanks doubled_ranks(std::span<const double> differences) {
  std::vector<double> sorted;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(sorted),
               [](double difference) { return difference != 0.0; });
  std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  DoubledRanks result;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t end = first;
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[first])) ++end;
    const auto rank = static_cast<std::int64_t>(first + 1 + end);
    for (; first < end; ++first) {
      result.ranks.push_back(rank);
      if (sorted[first] > 0.0) result.positive += rank;
    }
  }
  return result;
}

/// Exact p-value of the signed-rank test: P(sum ≥ positive) if every doubled rank is in the sum or not with
/// probability ½.
double exact_tail(const DoubledRanks& doubled) {
  std::int64_t total = 0;
  std::vector<double> probability{1.0};
  for (const std::int64_t rank : doubled.ranks) {
    total += rank;
    probability.resize(static_cast<std::size_t>(total) + 1, 0.0);
    for (std::int64_t sum = total; sum >= 0; --sum) {
      const auto at = static_cast<std::size_t>(sum);
      const double with = sum >= rank ? probability[at - static_cast<std::size_t>(rank)] : 0.0;
      probability[at] = 0.5 * (probability[at] + with);
    }
  }
  double tail = 0.0;
  for (std::int64_t sum = total; sum >= doubled.positive; --sum)
    tail += probability[static_cast<std::size_t>(sum)];
  return std::min(tail, 1.0);
}

double normal_tail(const DoubledRanks& doubled) {
  double mean = 0.0;
  double variance = 0.0;
  for (const std::int64_t rank : doubled.ranks) {
    mean += 0.5 * static_cast<double>(rank);
    variance += 0.25 * static_cast<double>(rank) * static_cast<double>(rank);
  }
  return statistics::normal_upper_tail((static_cast<double>(doubled.positive) - mean - 1.0) /
                                       std::sqrt(variance));
}

/// The groups of equal values in the pooled samples, and the largest excess of the baseline's empirical
/// distribution over the current sample's at the end of a group, in units of 1/(n₁n₂).
struct PooledGroups {
  /// [number k of pooled values, in rising order] True if a group of equal values ends with the k-th value.
  std::vector<bool> ends;
  std::int64_t excess{0};
};

PooledGroups pooled_groups(std::span<const double> baseline, std::span<const double> current) {
  std::vector<double> one(baseline.begin(), baseline.end());
  std::vector<double> two(current.begin(), current.end());
  std::sort(one.begin(), one.end());
  std::sort(two.begin(), two.end());
  PooledGroups groups{std::vector<bool>(one.size() + two.size() + 1, false), 0};
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < one.size() || j < two.size()) {
    const double value = j == two.size() || (i < one.size() && one[i] <= two[j]) ? one[i] : two[j];
    while (i < one.size() && one[i] == value) ++i;
    while (j < two.size() && two[j] == value) ++j;
    groups.ends[i + j] = true;
    groups.excess = std::max(
        groups.excess, static_cast<std::int64_t>(i * two.size()) - static_cast<std::int64_t>(j * one.size()));
  }
  return groups;
}

/// The proportion of the lattice paths to (n₁, n₂), all orders of the pooled values, in which the excess is
/// reached at the end of a group: Smirnov's exact p-value.
double proportion_of_paths(const PooledGroups& groups, std::int64_t n1, std::int64_t n2) {
  std::vector<double> proportion(static_cast<std::size_t>(n2) + 1, 0.0);
  for (std::int64_t i = 0; i <= n1; ++i) {
    for (std::int64_t j = 0; j <= n2; ++j) {
      double& here = proportion[static_cast<std::size_t>(j)];
      if (groups.ends[static_cast<std::size_t>(i + j)] && i * n2 - j * n1 >= groups.excess) {
        here = 1.0;
        continue;
      }
      const double all = static_cast<double>(i + j);
      const double below = i > 0 ? here * static_cast<double>(i) : 0.0;
      const double left = j > 0 ? proportion[static_cast<std::size_t>(j - 1)] * static_cast<double>(j) : 0.0;
      here = i + j > 0 ? (below + left) / all : 0.0;
    }
  }
  return proportion.back();
}

}  // namespace

double mcnemar(const PairedFailures& failures) {
  if (failures.only_current == 0) return 1.0;
  const std::int64_t differing = failures.only_current + failures.only_baseline;
  return statistics::binomial_upper_tail(differing, 0.5, failures.only_current - 1);
}

statistics::ConfidenceInterval tango(const PairedFailures& failures, double confidence) {
  if (failures.pairs == 0) return {-1.0, 1.0};
  const double z = statistics::normal_quantile(confidence);
  const double difference = static_cast<double>(failures.only_current - failures.only_baseline) /
                            static_cast<double>(failures.pairs);
  return {crossing(failures, z, -1.0, difference), crossing(failures, -z, difference, 1.0)};
}

double fisher(const FailureCounts& failures) {
  if (failures.current_failures == 0) return 1.0;
  return statistics::hypergeometric_at_least(
      failures.baseline_failures + failures.current_failures, failures.current_trials,
      failures.baseline_trials + failures.current_trials, failures.current_failures);
}

statistics::ConfidenceInterval newcombe(const FailureCounts& failures, double confidence) {
  if (failures.baseline_trials == 0 || failures.current_trials == 0) return {-1.0, 1.0};
  const double two_sided = 2.0 * confidence - 1.0;
  const statistics::ConfidenceInterval one =
      statistics::wilson(failures.baseline_failures, failures.baseline_trials, two_sided);
  const statistics::ConfidenceInterval two =
      statistics::wilson(failures.current_failures, failures.current_trials, two_sided);
  const double p1 = statistics::rate(failures.baseline_failures, failures.baseline_trials);
  const double p2 = statistics::rate(failures.current_failures, failures.current_trials);
  return {p2 - p1 - std::hypot(p2 - two.low, one.high - p1),
          p2 - p1 + std::hypot(two.high - p2, p1 - one.low)};
}

double signed_rank(std::span<const double> differences) {
  const DoubledRanks doubled = doubled_ranks(differences);
  if (doubled.ranks.empty()) return 1.0;
  return doubled.ranks.size() <= max_exact_ranks ? exact_tail(doubled) : normal_tail(doubled);
}

double smirnov(std::span<const double> baseline, std::span<const double> current) {
  if (baseline.empty() || current.empty()) return 1.0;
  const auto n1 = static_cast<std::int64_t>(baseline.size());
  const auto n2 = static_cast<std::int64_t>(current.size());
  const PooledGroups groups = pooled_groups(baseline, current);
  if (groups.excess <= 0) return 1.0;
  if (n1 <= max_exact_lattice / n2) return proportion_of_paths(groups, n1, n2);
  const double product = static_cast<double>(n1) * static_cast<double>(n2);
  const double distance = static_cast<double>(groups.excess) / product;
  return std::exp(-2.0 * distance * distance * product / static_cast<double>(n1 + n2));
}

}  // namespace zerocount::two_samples
