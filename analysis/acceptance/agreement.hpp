#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/clusters/rig_proportion.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::acceptance {

/// Whether measured machines are like simulated ones.
struct Agreement {
  std::int64_t moves{0};  ///< of each machine that are compared: as many as all have
  std::int64_t met{0};    ///< of the measured machines, by their first so many moves
  double p{1.0};          ///< two-sided
  double lowest_p{1.0};   ///< that so many machines could have
  bool is_lower{false};   ///< fewer moves than simulated meet what is asked
  /// 95 % of as many simulated machines meet it in this proportion of as many moves.
  statistics::ConfidenceInterval predicted{0.0, 1.0};
};

/// If N measured machines are further draws from the machines that were simulated, R, any N of all N + R are
/// as likely as any other to be those. With T the moves that meet the requirement, of N random ones of all,
/// each in n of its moves, and k those of the measured machines,
///
///   p₋ = (1 + #{T ≤ k})/(B + 1),  p₊ = (1 + #{T ≥ k})/(B + 1),  p = min(1, 2·min(p₋, p₊)),  B = 9999:
///
/// a permutation test. The n of a simulated machine are a random choice of its moves. For one machine it is
/// rig_rank_test(), which needs no random choices, where all simulated machines have as many moves.
/// @param met [measured machine] in its first n moves @param simulated with n or more moves each
/// @param seed of the random choices
Agreement agreement_of(std::span<const std::int64_t> met, std::int64_t moves,
                       std::span<const statistics::RigMoves> simulated, std::uint64_t seed);

}  // namespace zerocount::acceptance
