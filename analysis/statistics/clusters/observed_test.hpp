#pragma once

#include <cstdint>
#include <span>

/// Whether counts on a real machine are consistent with a simulation. Exact, two-sided.
namespace zerocount::statistics {

/// k successes in n trials.
struct Successes {
  std::int64_t successes{0};  ///< k
  std::int64_t trials{0};     ///< n
};

struct ObservedTest {
  double p{1.0};         ///< probability of counts as unlikely as those observed, if both have the same cause
  double lowest_p{1.0};  ///< lowest p that as many observed trials could have
};

/// Fisher's exact test of k of n observed trials against K of N simulated ones, all independent. Given k + K
/// successes among all, k has the hypergeometric distribution if both have the same success probability;
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
/// @param successes [machine] K_i, @param trials m
/// @throws Failure (bad_data) for impossible counts, or n > m.
ObservedTest machine_rank_test(const Successes& observed, std::span<const std::int64_t> successes,
                               std::int64_t trials);

}  // namespace zerocount::statistics
