#pragma once

#include <optional>
#include <string>

#include "experiments/guides/guide_friction.hpp"

namespace zerocount::guides {

/// The axis of a new study.
struct GuideAxis {
  GuideLoad load;
  double resolution{1e-8};                 ///< m per count; of a linear axis
  std::optional<MeasuredSpring> spring{};  ///< in place of that of the guide
};

/// A manifest of an axis on this guide, for machines that each draw their friction from its ranges. Every
/// number of the friction has its origin in a comment. The rest of the loop follows from k1 and the mass m:
///
///     kp = m·w², w = 2π·sample_rate / 100       the frequency of m on kp alone
///     kd = 1.4·m·w                              damping 0.7 of m on kp alone
///     ki = (c + kd)·(k1 + kp) / (4·m)           a quarter of criterion (6), with the lowest k1 and c
///
/// A linear axis has a converter up to 2·breakaway + m·1 m/s², with codes of at most k1·resolution/2
/// (practical issue 4 of the paper asks for less than k1·resolution) and 12 to 24 bits.
std::string guide_manifest(const Guide& guide, const GuideAxis& axis);

}  // namespace zerocount::guides
