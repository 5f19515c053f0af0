#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// Probability at most of naming a cause, or a pair of causes, where nothing that is tried raises the rate.
inline constexpr double max_false_cause = 0.05;

/// Units that meet a claim in more of their moves after a change than before it, and in fewer, on the same
/// draws. A unit is a machine, or a trial where no trials share a machine.
struct PairedGain {
  std::int64_t units{0};  ///< that are compared
  std::int64_t gained{0};
  std::int64_t lost{0};
  /// Probability of as many gained, of those that differ, if each were as likely to lose: the sign test,
  /// which is McNemar's exact test where a unit meets the claim or not.
  double p_value{1.0};
  bool shown{false};  ///< below a half of max_false_cause, divided by the number of alternatives (Bonferroni)
};

/// @param number of the claim in Aim::claims @param alternatives causes, or pairs of causes, that are tried
PairedGain paired_gain(const Claim& claim, std::size_t number, std::span<const UnitResult> before,
                       std::span<const UnitResult> after, std::int64_t alternatives);

/// The smallest number of units that can show a gain: all of them gain.
std::int64_t units_to_show_a_gain(std::int64_t alternatives);

}  // namespace zerocount::tuning
