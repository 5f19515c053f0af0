#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount {

/// A wait for the next jerk with the error at 0: the torque is constant, and only creep moves the rotor.
/// Times in s from the start of the move.
struct CreepWait {
  std::int64_t trial{0};  ///< index within its point
  std::int64_t move{0};
  bool first{false};  ///< the first since the arrival
  double since{0.0};  ///< where the state is taken: a dwell after the error became 0
  double onset{std::numeric_limits<double>::quiet_NaN()};     ///< of the jerk that ended it; NaN if none did
  double end{0.0};                                            ///< of the wait: the onset, or the move's end
  double predicted{std::numeric_limits<double>::infinity()};  ///< by the closed form; infinite: never
};

/// Jerks against the closed form for creep at constant torque.
struct CreepComparison {
  std::int64_t trials{0};        ///< run again
  std::string not_applicable{};  ///< why nothing was compared; empty where it could be
  std::vector<CreepWait> waits{};
  std::int64_t too_short{0};  ///< waits of no more than a dwell: left out
  std::int64_t unsteady{0};   ///< waits in which the torque was not constant, or the hook slid: left out
};

/// The waits for jerks in the first `trials` trials of a point (all, where there are fewer), which are run
/// again by the reference engine.
///
/// While the error is 0 the integral stands still, and with it the torque U. Once the rotor has stopped
/// swinging, its spring has the torque U too, and creep alone moves it, as creep_at_constant_torque says:
/// xh → Uⁿ/λ as 1 − exp(−αt). A jerk begins when the rotor has crept the distance d to the edge of its count:
///
///   t = −ln(1 − d/(Uⁿ/λ − xh))/α,   or never where d ≥ Uⁿ/λ − xh.
///
/// The state is taken a `verdict.dwell` after the error became 0. A jerk changes the torque by the integral,
/// so that the form holds for each wait by itself, and not from one to the next. It does not apply where the
/// friction does not creep, encoder or converter have noise, the encoder has errors, or a creep parameter
/// varies along the rotor.
CreepComparison compare_with_creep(const Study& study, std::int64_t point, std::int64_t trials);

/// How a comparison came out.
struct CreepAgreement {
  std::int64_t ended{0};     ///< waits that a jerk ended
  std::int64_t foretold{0};  ///< of them, within two samples and 1 % of the time from `since` foretold
  std::int64_t lasting{0};   ///< waits without a jerk
  std::int64_t lasting_foretold{0};  ///< of them, whose jerk was foretold for later or never, alike
  double median_deviation{std::numeric_limits<double>::quiet_NaN()};   ///< of |onset − predicted|, s
  double largest_deviation{std::numeric_limits<double>::quiet_NaN()};  ///< likewise; infinite: never foretold
};

/// @param sample_time s.
CreepAgreement agreement_of(const CreepComparison& comparison, double sample_time);

}  // namespace zerocount
