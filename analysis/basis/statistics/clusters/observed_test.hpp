#pragma once

#include <cstdint>
#include <span>

/// Whether counts on a real machine are consistent with a simulation. Exact, two-sided.
namespace zerocount::statistics {

/// Number k of successes in n independent trials.
struct Successes {
  std::int64_t successes{0};  ///< Number k of successes.
  std::int64_t trials{0};     ///< Number n of trials.
};

struct ObservedTest {
  /// p-value: probability of counts at least as unlikely as those observed, if real and simulated trials have
  /// the same cause.
  double p{1.0};
  /// Lowest p-value that any result with the same number of observed trials could have.
  double lowest_p{1.0};
};

/// Fisher's exact test of k successes in n observed trials against K successes in N simulated ones, all
/// independent. Given k + K successes among all, k has the hypergeometric distribution if both have the same
/// success probability;
///
///   p = Σ P(x) over all x with P(x) ≤ P(k)
///
/// (Fisher, Statistical Methods for Research Workers, 1934, section 21.02; the two-sided form of Freeman and
/// Halton, Biometrika 38 (1951) 141). It allows for the finite number of simulated trials.
/// @throws Failure (bad_data) for impossible counts.
ObservedTest fisher_test(const Successes& observed, const Successes& simulated);

/// Test of k of n trials on one real machine against R simulated machines that differ, of m ≥ n trials each.
/// If the real machine is one more draw from the distribution of the machines, it is as likely to have any
/// rank among them as any other. Machine i with K_i successes has H_i in n of its m trials, which is
/// hypergeometric. With
///
///   p₋ = (1 + Σ P(H_i ≤ k))/(R + 1),  p₊ = (1 + Σ P(H_i ≥ k))/(R + 1),  p = min(1, 2·min(p₋, p₊)).
///
/// This is the rank test of exchangeable observations (Vovk, Gammerman and Shafer, Algorithmic Learning in a
/// Random World, 2005, section 2.2), averaged over the choice of the n trials. p is never below 2/(R + 1): it
/// takes 39 machines to find a difference at 5 %.
/// @param successes [machine] number K_i of successful trials
/// @param trials number m of trials of each simulated machine
/// @throws Failure (bad_data) for impossible counts, or n > m.
ObservedTest machine_rank_test(const Successes& observed, std::span<const std::int64_t> successes,
                               std::int64_t trials);

}  // namespace zerocount::statistics
