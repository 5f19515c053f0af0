#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/basis/statistics/unknown.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::jerks {

/// A wait: an interval of zero error up to the next jerk (the next sample whose error is not 0). The torque
/// is constant, and only creep moves the rotor. Times are in s from the start of the move.
struct CreepWait {
  std::int64_t trial{0};  ///< Index of the trial within the design point.
  std::int64_t move{0};   ///< Index of the move within the trial.
  bool first{false};      ///< True if this is the first wait after the arrival of the move at its target.
  /// Time from which the closed form predicts, s: one arrival dwell after the error became 0.
  double since{0.0};
  /// Time at which the jerk that ended the wait began, s; NaN if the move ended without one.
  double onset{statistics::unknown};
  double end{0.0};  ///< End of the wait, s: the onset of the jerk, or the end of the move.
  /// Time at which the closed form predicts the beginning of a jerk, s; infinite if it predicts none.
  double predicted{std::numeric_limits<double>::infinity()};
};

/// Comparison of the jerks in simulated trials with the closed form of creep at constant torque.
struct CreepComparison {
  std::int64_t trials{0};  ///< Number of trials that were simulated again for the comparison.
  /// Reason why the closed form does not apply to these trials; empty if it applies.
  std::string not_applicable{};
  std::vector<CreepWait> waits{};
  /// Number of waits excluded because they were not longer than the arrival dwell.
  std::int64_t too_short{0};
  /// Number of waits excluded because the torque was not constant or the friction contact slid.
  std::int64_t unsteady{0};
};

/// Simulates the first `trials` trials of a design point (or all, if there are fewer) again with the
/// reference engine, and collects their waits (intervals of zero error up to the next jerk).
///
/// While the error is 0, the integral and the torque U are constant. When the residual oscillation has
/// decayed, the spring torque is also U, and only creep moves the rotor (creep_at_constant_torque): the creep
/// displacement xh approaches Uⁿ/λ as 1 − exp(−αt). A jerk begins when the rotor has crept the distance d to
/// the edge of its count:
///
///   t = −ln(1 − d/(Uⁿ/λ − xh))/α,   or never if d ≥ Uⁿ/λ − xh.
///
/// The prediction starts from the state one arrival dwell (`verdict.dwell`) after the error became 0. A jerk
/// changes the torque through the integral, so each wait is predicted separately. The closed form does not
/// apply if the friction does not creep, the encoder or the converter has noise, the encoder has errors, or a
/// creep parameter varies along the rotor.
CreepComparison compare_with_creep(const study::Study& study, std::int64_t point, std::int64_t trials);

/// Summary of how well the closed form of creep predicts the waits of a comparison.
struct CreepAgreement {
  std::int64_t ended{0};  ///< Number of waits that ended with a jerk.
  /// Number of waits that ended with a jerk whose onset is predicted to within two samples plus 1 % of the
  /// time from CreepWait::since.
  std::int64_t predicted{0};
  std::int64_t lasting{0};  ///< Number of waits that lasted to the end of the move without a jerk.
  /// Number of waits without a jerk for which the closed form predicts no jerk before their end.
  std::int64_t lasting_predicted{0};
  /// Median of |onset − predicted| over the waits that ended with a jerk, s.
  double median_deviation{statistics::unknown};
  /// Largest |onset − predicted| of the waits that ended with a jerk, s.
  double largest_deviation{statistics::unknown};
};

/// Summarises a comparison: counts the waits that the closed form predicts, and their deviations.
/// @param sample_time sampling interval of the loop, s
CreepAgreement agreement_of(const CreepComparison& comparison, double sample_time);

}  // namespace zerocount::jerks
