#include "runners/tuning/effects/paired_gain.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::tuning {
namespace {

/// Causes alone and pairs of causes are two families, each with half of the error probability.
constexpr double of_a_family = 0.5 * max_false_cause;

double allowed_error(std::int64_t alternatives) {
  return of_a_family / static_cast<double>(std::max<std::int64_t>(alternatives, 1));
}

}  // namespace

PairedGain paired_gain(const Claim& claim, std::size_t number, std::span<const UnitResult> before,
                       std::span<const UnitResult> after, std::int64_t alternatives) {
  PairedGain gain{.units = std::min(std::ssize(before), std::ssize(after))};
  for (std::size_t unit = 0; unit < static_cast<std::size_t>(gain.units); ++unit) {
    const double loss_before = goal_loss(claim, before[unit].claims[number]);
    const double loss_after = goal_loss(claim, after[unit].claims[number]);
    gain.gained += loss_after < loss_before ? 1 : 0;
    gain.lost += loss_after > loss_before ? 1 : 0;
  }
  if (gain.gained > 0)
    gain.p_value = statistics::binomial_upper_tail(gain.gained + gain.lost, 0.5, gain.gained - 1);
  gain.shown = gain.p_value <= allowed_error(alternatives);
  return gain;
}

std::int64_t units_to_show_a_gain(std::int64_t alternatives) {
  return static_cast<std::int64_t>(std::ceil(-std::log2(allowed_error(alternatives))));
}

}  // namespace zerocount::tuning
