#include <cstdint>
#include <vector>

#include "analysis/measures/statistic_fields.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount {
namespace {

using Point = const PointSummary&;

const std::vector<StatisticField>& fields_of_measures() {
  static const std::vector<StatisticField> list{
      {"overshoot", "n", "1", "moves with a target, of which the overshoots are", true,
       [](Point s) { return to_double(s.overshoot.n); }},
      {"overshoot", "mean", "count", "mean overshoot of the moves", false,
       [](Point s) { return s.overshoot.mean; }},
      {"overshoot", "max", "count", "largest overshoot of the moves", false,
       [](Point s) { return s.overshoot.max; }},
      {"holding_torque", "n", "1", "moves with a finite holding torque, of which these are", true,
       [](Point s) { return to_double(s.holding_torque.n); }},
      {"holding_torque", "mean", "N m", "mean holding torque of the moves", false,
       [](Point s) { return s.holding_torque.mean; }},
      {"holding_torque", "min", "N m", "smallest holding torque of the moves", false,
       [](Point s) { return s.holding_torque.min; }},
      {"holding_torque", "max", "N m", "largest holding torque of the moves", false,
       [](Point s) { return s.holding_torque.max; }},
      {"peak_torque", "n", "1", "moves with a finite peak torque, of which these are", true,
       [](Point s) { return to_double(s.peak_torque.n); }},
      {"peak_torque", "mean", "N m", "mean peak torque of the moves", false,
       [](Point s) { return s.peak_torque.mean; }},
      {"peak_torque", "max", "N m", "largest peak torque of the moves", false,
       [](Point s) { return s.peak_torque.max; }},
      {"creep", "n", "1", "moves with a finite creep, of which these are", true,
       [](Point s) { return to_double(s.creep.n); }},
      {"creep", "mean", "rad", "mean creep of the moves", false, [](Point s) { return s.creep.mean; }},
      {"creep", "min", "rad", "smallest creep of the moves", false, [](Point s) { return s.creep.min; }},
      {"creep", "max", "rad", "largest creep of the moves", false, [](Point s) { return s.creep.max; }},
      {"", "reversal_depth_max", "1", "largest number of reversal points on the stack", true,
       [](Point s) { return to_double(s.reversal_depth); }},
      {"final_error", "n", "1", "moves whose motion was not lost, of which the final errors are", true,
       [](Point s) { return to_double(s.final_error.n); }},
      {"final_error", "mean", "count", "mean absolute error at the last sample of the moves", false,
       [](Point s) { return s.final_error.mean; }},
      {"final_error", "median", "count", "median of the absolute error at the last sample", false,
       [](Point s) { return s.final_error.median.value; }},
      {"final_error", "median_low", "count",
       "lower 95 % order-statistic bound of the median of the final error", false,
       [](Point s) { return s.final_error.median.low; }},
      {"final_error", "median_high", "count",
       "upper 95 % order-statistic bound of the median of the final error", false,
       [](Point s) { return s.final_error.median.high; }},
      {"final_error", "p95", "count", "95 % quantile of the absolute error at the last sample", false,
       [](Point s) { return s.final_error.p95.value; }},
      {"final_error", "p95_low", "count",
       "lower 95 % order-statistic bound of the 95 % quantile of the final error", false,
       [](Point s) { return s.final_error.p95.low; }},
      {"final_error", "p95_high", "count",
       "upper 95 % order-statistic bound of the 95 % quantile of the final error", false,
       [](Point s) { return s.final_error.p95.high; }},
      {"final_error", "max", "count", "largest absolute error at the last sample", false,
       [](Point s) { return s.final_error.max; }},
      {"zero_fraction", "n", "1", "moves that arrived, of which the zero fractions are", true,
       [](Point s) { return to_double(s.zero_fraction.n); }},
      {"zero_fraction", "mean", "1", "mean fraction of the samples since arrival with an error of 0", false,
       [](Point s) { return s.zero_fraction.mean; }},
      {"oscillation", "n", "1", "moves that oscillated to their end", true,
       [](Point s) { return to_double(s.oscillation.n); }},
      {"oscillation", "amplitude_median", "count", "median amplitude of these moves in their last half",
       false, [](Point s) { return s.oscillation.amplitude_median; }},
      {"oscillation", "period_median", "s", "median period of those of these moves that have one", false,
       [](Point s) { return s.oscillation.period_median; }},
      {"true_error", "n", "1", "moves with a target whose motion was not lost, of which the true errors are",
       true, [](Point s) { return to_double(s.true_error.n); }},
      {"true_error", "mean", "count",
       "mean distance from the rotor to the middle of the target's count at the last sample", false,
       [](Point s) { return s.true_error.mean; }},
      {"true_error", "rms", "count",
       "root mean square distance from the rotor to the middle of the target's count", false,
       [](Point s) { return s.true_error.rms(); }},
      {"true_error", "max", "count", "largest distance from the rotor to the middle of the target's count",
       false, [](Point s) { return s.true_error.max; }},
      {"travel_time", "mean", "s",
       "mean time until the reference or the torque is where it is held, of the moves", false,
       [](Point s) { return s.travel_time.mean; }},
      {"travel_time", "max", "s", "longest time until the reference or the torque is where it is held", false,
       [](Point s) { return s.travel_time.max; }},
      {"phase_changes", "trials", "1", "trials in which the control changed its phase", true,
       [](Point s) { return to_double(s.phase_changes.trials); }},
      {"phase_changes", "mean", "1", "mean number of phase changes per trial", false,
       [](Point s) { return rate(s.phase_changes.total, s.trials); }},
      {"phase_changes", "max", "1", "largest number of phase changes of a trial", true,
       [](Point s) { return to_double(s.phase_changes.max); }},
      {"encoder_disagreement", "trials", "1",
       "trials with samples at which the fine count made the coarse one impossible", true,
       [](Point s) { return to_double(s.encoder_disagreement.trials); }},
      {"encoder_disagreement", "mean", "1", "mean number of such samples per trial", false,
       [](Point s) { return rate(s.encoder_disagreement.total, s.trials); }},
      {"encoder_disagreement", "max", "1", "largest number of such samples of a trial", true,
       [](Point s) { return to_double(s.encoder_disagreement.max); }},
  };
  return list;
}

}  // namespace

std::span<const StatisticField> measure_statistic_fields() {
  return fields_of_measures();
}

}  // namespace zerocount
