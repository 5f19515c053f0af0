#pragma once

#include <string>
#include <vector>

namespace zerocount::sliding_identification {

struct SlidingFit;

/// How far the torque that the law leaves unexplained repeats with something.
struct RepeatingForce {
  std::string with;  ///< "position", "position and direction", "speed and direction", "acceleration"
  /// Part of its variance that the means over the other strokes predict; at most 1, 0 or negative where it
  /// does not repeat.
  double predicted{0.0};
  double low{0.0};   ///< smallest and largest mean over a class with windows of several strokes, N m or N,
  double high{0.0};  ///< as a torque against the drive
};

/// What the unexplained torque of the windows repeats with: classes of ten equal parts of the range, each
/// direction apart where it is said.
///
/// Windows of one stroke depend on each other, so the variance within a sample says nothing. Each window is
/// predicted by the mean of its class over all *other strokes*; predicted = 1 − Σ(r − r̂)²/Σ(r − r̄)² with r̄
/// the mean over all windows of other strokes. Classes that one stroke alone has are predicted by r̄. Empty
/// with fewer than 4 strokes.
std::vector<RepeatingForce> repeating_forces(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
