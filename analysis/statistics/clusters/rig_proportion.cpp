#include "analysis/statistics/clusters/rig_proportion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/statistics/distributions.hpp"
#include "core/numerics/bisection.hpp"

namespace zerocount::statistics {
namespace {

/// The n moves of a rig, of which the proportion q is asked for.
struct MovesOfRig {
  double trials;
  std::int64_t moves;
  double q;

  bool one_move_each() const { return trials == static_cast<double>(moves); }
  double mean(std::int64_t met) const { return static_cast<double>(met) / static_cast<double>(moves); }
};

/// exp(−m·KL(y‖q)).
double chernoff_bound(const MovesOfRig& rig, double y) {
  return std::exp(-rig.trials * bernoulli_divergence(y, rig.q));
}

/// ε(c): how probably a rig below q shows `met` or more.
double false_pass(const MovesOfRig& rig, std::int64_t met) {
  if (met <= 0) return 1.0;
  if (!rig.one_move_each()) return rig.mean(met) > rig.q ? chernoff_bound(rig, rig.mean(met)) : 1.0;
  return binomial_upper_tail(rig.moves, rig.q, met - 1);
}

/// δ(c): how probably a rig at q or above shows fewer than `met`.
double false_fail(const MovesOfRig& rig, std::int64_t met) {
  if (met <= 0) return 0.0;
  if (!rig.one_move_each()) return rig.mean(met - 1) < rig.q ? chernoff_bound(rig, rig.mean(met - 1)) : 1.0;
  return binomial_cdf(rig.moves, rig.q, met - 1);
}

std::int64_t passing(std::span<const RigMoves> rigs, std::int64_t met) {
  return std::count_if(rigs.begin(), rigs.end(), [met](const RigMoves& rig) { return rig.met >= met; });
}

/// As if all moves of a rig beyond the first `moves` met the requirement, and were left out.
std::vector<RigMoves> without_further_moves(std::span<const RigMoves> rigs, std::int64_t moves) {
  std::vector<RigMoves> shortened(rigs.begin(), rigs.end());
  for (RigMoves& rig : shortened) rig.met -= rig.moves - moves;
  return shortened;
}

}  // namespace

RigThresholds rig_thresholds(const RigMoves& rig, std::int64_t rigs, double proportion, double wanted,
                             double confidence) {
  const MovesOfRig moves{static_cast<double>(rig.trials), rig.moves, proportion};
  const double allowed_pass = (proportion_at_least(rigs, rigs, confidence) - wanted) / (2.0 * (1.0 - wanted));
  const double allowed_fail = 0.5 * (1.0 - wanted);
  RigThresholds thresholds;
  thresholds.low = numerics::first_where(
      0, rig.moves, [&](std::int64_t met) { return false_pass(moves, met) <= allowed_pass; });
  const std::int64_t beyond = numerics::first_where(
      0, rig.moves + 1, [&](std::int64_t met) { return false_fail(moves, met) > allowed_fail; });
  thresholds.high = std::max<std::int64_t>(beyond - 1, 0);
  thresholds.false_pass = false_pass(moves, thresholds.low);
  thresholds.false_fail = false_fail(moves, thresholds.high);
  return thresholds;
}

double rigs_at_least(const RigThresholds& thresholds, std::int64_t passing, std::int64_t rigs,
                     double confidence) {
  const double wrong = thresholds.false_pass;
  if (!(wrong < 1.0)) return 0.0;
  return std::max(0.0, (proportion_at_least(passing, rigs, confidence) - wrong) / (1.0 - wrong));
}

double rigs_at_most(const RigThresholds& thresholds, std::int64_t passing, std::int64_t rigs,
                    double confidence) {
  return std::min(1.0, proportion_at_most(passing, rigs, confidence) / (1.0 - thresholds.false_fail));
}

RigProportion rig_proportion(std::span<const RigMoves> rigs, double proportion, double wanted,
                             double confidence) {
  if (rigs.empty()) return {};
  // In a run that has not ended, rigs may differ by a trial. Both bounds then allow for the further moves.
  const RigMoves fewest = *std::min_element(
      rigs.begin(), rigs.end(), [](const RigMoves& a, const RigMoves& b) { return a.moves < b.moves; });
  if (fewest.moves == 0) return {};
  const auto meeting = std::count_if(
      rigs.begin(), rigs.end(), [&](const RigMoves& one) { return rate(one.met, one.moves) >= proportion; });
  const std::int64_t count = std::ssize(rigs);
  const RigThresholds thresholds = rig_thresholds(fewest, count, proportion, wanted, confidence);
  const std::int64_t passing_low = passing(without_further_moves(rigs, fewest.moves), thresholds.low);
  return {meeting, rigs_at_least(thresholds, passing_low, count, confidence),
          rigs_at_most(thresholds, passing(rigs, thresholds.high), count, confidence)};
}

}  // namespace zerocount::statistics
