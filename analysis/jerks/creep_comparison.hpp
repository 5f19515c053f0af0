#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/statistics/unknown.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::jerks {

/// An interval of zero error up to the next jerk. The torque is constant, and only creep moves the rotor.
/// Times are in s from the start of the move.
struct CreepWait {
  std::int64_t trial{0};              ///< Index of the trial within the design point.
  std::int64_t move{0};               ///< Index of the move within the trial.
  bool first{false};                  ///< True for the first wait after arrival.
  double since{0.0};                  ///< Start of the prediction: one dwell after the error became 0.
  double onset{statistics::unknown};  ///< Onset of the jerk that ended the wait; NaN if no jerk did.
  double end{0.0};                    ///< End of the wait: the onset of the jerk, or the end of the move.
  /// Onset predicted by the closed form; infinite if no jerk is predicted.
  double predicted{std::numeric_limits<double>::infinity()};
};

/// Comparison of the jerks with the closed form of creep at constant torque.
struct CreepComparison {
  std::int64_t trials{0};        ///< Number of trials that were simulated again.
  std::string not_applicable{};  ///< reason why the closed form does not apply; empty if it does
  std::vector<CreepWait> waits{};
  std::int64_t too_short{0};  ///< excluded waits: not longer than a dwell
  std::int64_t unsteady{0};   ///< excluded waits: the torque was not constant, or the hook slid
};

/// Simulates the first `trials` trials of a point (or all, if there are fewer) again with the reference
/// engine and collects their waits.
///
/// While the error is 0, the integral and the torque U are constant. When
/// the residual oscillation has decayed, the spring torque is also U, and only creep moves the rotor
/// (creep_at_constant_torque): xh approaches Uⁿ/λ as 1 − exp(−αt). A jerk begins when the rotor has crept the
/// distance d to the edge of its count:
///
///   t = −ln(1 − d/(Uⁿ/λ − xh))/α,   or never if d ≥ Uⁿ/λ − xh.
///
/// The prediction starts from the state at `verdict.dwell` after the error became 0. A jerk changes the
/// torque through the integral, so each wait is predicted separately. The closed form does not apply if the
/// friction does not creep, the encoder or the converter has noise, the encoder has errors, or a creep
/// parameter varies along the rotor.
CreepComparison compare_with_creep(const study::Study& study, std::int64_t point, std::int64_t trials);

/// Summary of a comparison.
struct CreepAgreement {
  std::int64_t ended{0};  ///< waits that ended with a jerk
  /// Number of ended waits whose onset is predicted to within two samples and 1 % of the time from
  /// CreepWait::since.
  std::int64_t predicted{0};
  std::int64_t lasting{0};  ///< waits without a jerk
  /// Number of waits without a jerk that are predicted to last as long as they did.
  std::int64_t lasting_predicted{0};
  double median_deviation{statistics::unknown};   ///< median of |onset − predicted|, s
  double largest_deviation{statistics::unknown};  ///< largest |onset − predicted|, s
};

/// @param sample_time s.
CreepAgreement agreement_of(const CreepComparison& comparison, double sample_time);

}  // namespace zerocount::jerks
