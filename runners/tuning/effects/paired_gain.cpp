#include <algorithm>
#include <cmath>

#include "analysis/basis/statistics/distributions.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
namespace {

/// Error probability of one family of significance tests. Tests of single causes and tests of pairs of causes
/// are two families, each with half of max_false_cause.
constexpr double of_a_family = 0.5 * max_false_cause;

double allowed_error(std::int64_t alternatives) {
  return of_a_family / static_cast<double>(std::max<std::int64_t>(alternatives, 1));
}

}  // namespace

PairedGain paired_gain(const study::Goal& claim, std::size_t number, std::span<const MachineResult> before,
                       std::span<const MachineResult> after, std::int64_t alternatives) {
  PairedGain gain{.machines = std::min(std::ssize(before), std::ssize(after))};
  for (std::size_t machine = 0; machine < static_cast<std::size_t>(gain.machines); ++machine) {
    const double loss_before = goal_loss(claim, before[machine].claims[number]);
    const double loss_after = goal_loss(claim, after[machine].claims[number]);
    gain.gained += loss_after < loss_before ? 1 : 0;
    gain.lost += loss_after > loss_before ? 1 : 0;
  }
  if (gain.gained > 0)
    gain.p_value = statistics::binomial_upper_tail(gain.gained + gain.lost, 0.5, gain.gained - 1);
  gain.shown = gain.p_value <= allowed_error(alternatives);
  return gain;
}

std::int64_t machines_to_show_a_gain(std::int64_t alternatives) {
  return static_cast<std::int64_t>(std::ceil(-std::log2(allowed_error(alternatives))));
}

}  // namespace zerocount::tuning
