#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/record/sliding_identification/sliding_fit.hpp"

namespace zerocount::sliding_identification {

/// Quantity with which a torque that the law lacks varies.
enum class TorqueCause { lag, speed, direction, load, position, time };

std::string_view to_string(TorqueCause cause);

/// The words for all causes ("lag", "speed", …), in the order of TorqueCause.
std::vector<std::string> cause_words();

/// A torque against the drive that the identified sliding law lacks and that the residuals of the fit show.
///
/// For each window the response of the position to a unit of the torque is added to the fit as a column
/// (added_column()). The tried torques are, with d = ±1 the direction, v the velocity, x and t the position
/// and the time (−1 to 1 over the record), u the torque, p the torques of the position, and n the part of u
/// that accelerates:
///
///   lag         u_k − u_{k−1}: its coefficient is the delay of the torque in samples
///   speed       d·v², d·|v|³, d·exp(−|v|/w) with w = 1/4, 1/10 and 1/30 of the largest speed
///   direction   |v|, v²
///   load        d·|u + u0 + p|, d·(u + u0 + p)²: friction that grows with the torque that is carried
///   position    x, x², d·x, d·x², v·x, n·x, and sin and cos of π, 2π and 3π times x, also times d
///   time        t, d·t, v·t, n·t
///
/// One is shown if its coefficient exceeds its error by what chance does once in 1000 records, in any of
/// them. Both parts of strokes of 64 samples or more and, of 12 strokes or more, the strokes are taken for
/// independent, and the larger error counts.
struct MissingTorque {
  TorqueCause cause{};
  std::string name{};       ///< Name, such as "drag that grows with the square of the speed".
  double coefficient{0.0};  ///< Coefficient of the tried torque, in units of the torque.
  /// Ratio of the coefficient to its standard error, divided by the ratio that chance reaches once in 1000
  /// records. From 1 on the torque is significant.
  double visibility{0.0};
  /// Proportion of the sum of squares of the residuals that the torque explains.
  double explained{0.0};
  /// Largest change of a fitted parameter when the torque is added to the fit, in its standard errors.
  double shift{0.0};
};

/// All torques that were tried in addition to the law, in order of MissingTorque::visibility, the most
/// visible first.
std::vector<MissingTorque> tried_torques(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
