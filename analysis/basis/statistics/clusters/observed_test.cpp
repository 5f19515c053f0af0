#include "analysis/basis/statistics/clusters/observed_test.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::statistics {
namespace {

constexpr std::int64_t max_trials = 1'000'000'000;  // products of two numbers of trials fit 64 bits

void require_counts(const Successes& counts) {
  if (counts.successes >= 0 && counts.successes <= counts.trials && counts.trials <= max_trials) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{} successes in {} trials; expected 0 ≤ successes ≤ trials ≤ {}",
                            counts.successes, counts.trials, max_trials));
}

/// Probabilities P(x), x = 0 … n, that x of n trials succeed which are taken at random, without replacement,
/// from the trials `all` (hypergeometric).
///
/// The ratio of neighbours, P(x + 1)/P(x) = (K − x)·(n − x)/((x + 1)·(N − K − n + x + 1)), gives each term
/// from the one before. The computation starts at the mode and goes outwards, where the terms fall, so that
/// nothing overflows; at the end all terms are divided by their sum. This takes one multiplication per x. A
/// library's probability function evaluates factorials of N for each x, which takes seconds for large
/// studies.
std::vector<double> hypergeometric(std::int64_t n, const Successes& all) {
  const std::int64_t failures = all.trials - all.successes;
  const std::int64_t first = std::max<std::int64_t>(0, n - failures);
  const std::int64_t last = std::min(n, all.successes);
  const auto ratio = [&](std::int64_t x) {
    return static_cast<double>((all.successes - x) * (n - x)) /
           static_cast<double>((x + 1) * (failures - n + x + 1));
  };
  const std::int64_t mode = std::clamp((n + 1) * (all.successes + 1) / (all.trials + 2), first, last);
  std::vector<double> probabilities(static_cast<std::size_t>(n) + 1, 0.0);
  const auto at = [&](std::int64_t x) -> double& { return probabilities[static_cast<std::size_t>(x)]; };
  at(mode) = 1.0;
  for (std::int64_t x = mode; x < last; ++x) at(x + 1) = at(x) * ratio(x);
  for (std::int64_t x = mode; x > first; --x) at(x - 1) = at(x) / ratio(x - 1);
  const double total = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  for (double& probability : probabilities) probability /= total;
  return probabilities;
}

double fisher_p(const Successes& observed, const Successes& simulated) {
  const std::vector<double> probabilities = hypergeometric(
      observed.trials, {observed.successes + simulated.successes, observed.trials + simulated.trials});
  constexpr double rounding = 1.0 + 1e-7;  // equal probabilities are equal
  const double limit = rounding * probabilities[static_cast<std::size_t>(observed.successes)];
  double p = 0.0;
  for (const double probability : probabilities) p += probability <= limit ? probability : 0.0;
  return std::min(1.0, p);
}

/// [x] Sum over the machines of the probability P(H_i = x) that x of n of its trials succeed, x = 0 … n.
/// @param successes [machine] successful trials
/// @param trials number of trials per machine
std::vector<double> mixture(std::int64_t n, std::span<const std::int64_t> successes, std::int64_t trials) {
  std::map<std::int64_t, double> machines;  // with so many successes
  for (const std::int64_t each : successes) machines[each] += 1.0;
  std::vector<double> sums(static_cast<std::size_t>(n) + 1, 0.0);
  for (const auto& [each, count] : machines) {
    const std::vector<double> of_machine = hypergeometric(n, {each, trials});
    for (std::size_t x = 0; x < sums.size(); ++x) sums[x] += count * of_machine[x];
  }
  return sums;
}

double rank_p(const std::vector<double>& sums, std::int64_t k) {
  const auto at = sums.begin() + k;
  const double low = std::accumulate(sums.begin(), at + 1, 0.0);
  const double high = std::accumulate(at, sums.end(), 0.0);
  const double machines = std::accumulate(sums.begin(), sums.end(), 0.0);
  return std::min(1.0, 2.0 * (1.0 + std::min(low, high)) / (machines + 1.0));
}

}  // namespace

ObservedTest fisher_test(const Successes& observed, const Successes& simulated) {
  require_counts(observed);
  require_counts(simulated);
  return {fisher_p(observed, simulated), std::min(fisher_p({0, observed.trials}, simulated),
                                                  fisher_p({observed.trials, observed.trials}, simulated))};
}

ObservedTest machine_rank_test(const Successes& observed, std::span<const std::int64_t> successes,
                               std::int64_t trials) {
  require_counts(observed);
  if (observed.trials > trials) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{} observed trials against {} on each simulated machine; expected "
                              "no more than those",
                              observed.trials, trials));
  }
  for (const std::int64_t each : successes) require_counts({each, trials});
  const std::vector<double> sums = mixture(observed.trials, successes, trials);
  return {rank_p(sums, observed.successes), std::min(rank_p(sums, 0), rank_p(sums, observed.trials))};
}

}  // namespace zerocount::statistics
