#include "analysis/measures/statistic_fields.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace zerocount {
namespace {

using S = const PointSummary&;

std::vector<StatisticField> outcome_and_jerk_fields() {
  return {
      {"", "trials", "1", "trials of the point", true, [](S s) { return to_double(s.trials); }},
      {"", "zero_count", "1", "trials whose worst move ended at zero error", true,
       [](S s) { return to_double(s.outcomes.zero_count); }},
      {"", "one_count", "1", "trials whose worst move ended within one count", true,
       [](S s) { return to_double(s.outcomes.one_count); }},
      {"", "off_target", "1",
       "trials whose worst move ended beyond one count without oscillating: neither stable nor shown "
       "unstable",
       true, [](S s) { return to_double(s.outcomes.off_target); }},
      {"", "oscillating", "1", "trials whose worst move ended beyond one count, oscillating", true,
       [](S s) { return to_double(s.outcomes.oscillating); }},
      {"", "nonfinite", "1", "trials with a move that left the finite numbers", true,
       [](S s) { return to_double(s.outcomes.nonfinite); }},
      {"", "open_loop", "1", "trials with torque levels in place of targets, which are not judged", true,
       [](S s) { return to_double(s.outcomes.open_loop); }},
      {"", "stable", "1", "trials all of whose moves arrived and stayed within one count", true,
       [](S s) { return to_double(s.stable); }},
      {"", "arrived", "1", "trials all of whose moves arrived", true,
       [](S s) { return to_double(s.arrived); }},
      {"", "broke_away", "1", "trials in which the hook slid during any move", true,
       [](S s) { return to_double(s.broke_away); }},
      {"", "saturated", "1", "trials in which the DAC clipped during any move", true,
       [](S s) { return to_double(s.saturated); }},
      {"", "success_rate", "1", "zero_count as a proportion of trials, NaN of an open-loop study", false,
       [](S s) { return s.success_rate.value; }},
      {"", "success_rate_low", "1",
       "lower 95 % bound of success_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](S s) { return s.success_rate.clopper_pearson.low; }},
      {"", "success_rate_high", "1",
       "upper 95 % bound of success_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](S s) { return s.success_rate.clopper_pearson.high; }},
      {"", "success_rate_wilson_low", "1",
       "lower 95 % Wilson bound of success_rate, with rigs for the effective number of trials", false,
       [](S s) { return s.success_rate.wilson.low; }},
      {"", "success_rate_wilson_high", "1",
       "upper 95 % Wilson bound of success_rate, with rigs for the effective number of trials", false,
       [](S s) { return s.success_rate.wilson.high; }},
      {"", "stable_rate", "1", "stable as a proportion of trials, NaN of an open-loop study", false,
       [](S s) { return s.stable_rate.value; }},
      {"", "stable_rate_low", "1",
       "lower 95 % bound of stable_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](S s) { return s.stable_rate.clopper_pearson.low; }},
      {"", "stable_rate_high", "1",
       "upper 95 % bound of stable_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](S s) { return s.stable_rate.clopper_pearson.high; }},
      {"", "stable_rate_wilson_low", "1",
       "lower 95 % Wilson bound of stable_rate, with rigs for the effective number of trials", false,
       [](S s) { return s.stable_rate.wilson.low; }},
      {"", "stable_rate_wilson_high", "1",
       "upper 95 % Wilson bound of stable_rate, with rigs for the effective number of trials", false,
       [](S s) { return s.stable_rate.wilson.high; }},
      {"settling_time", "n", "1", "moves that arrived, of which mean, min and max are", true,
       [](S s) { return to_double(s.settling_time.n); }},
      {"settling_time", "moves", "1", "moves with a target, of which the quantiles are", true,
       [](S s) { return to_double(s.settling_time.moves); }},
      {"settling_time", "mean", "s", "mean settling time of the moves that arrived", false,
       [](S s) { return s.settling_time.mean; }},
      {"settling_time", "min", "s", "shortest settling time of the moves that arrived", false,
       [](S s) { return s.settling_time.min; }},
      {"settling_time", "p05", "s",
       "5 % quantile of the settling time of all moves with a target, NaN if not within the hold", false,
       [](S s) { return s.settling_time.p05.value; }},
      {"settling_time", "p25", "s",
       "25 % quantile of the settling time of all moves with a target, NaN if not within the hold", false,
       [](S s) { return s.settling_time.p25.value; }},
      {"settling_time", "median", "s",
       "median of the settling time of all moves with a target, NaN if not within the hold", false,
       [](S s) { return s.settling_time.median.value; }},
      {"settling_time", "median_low", "s",
       "lower 95 % order-statistic bound of the median of the settling time, NaN if not within the hold",
       false, [](S s) { return s.settling_time.median.low; }},
      {"settling_time", "median_high", "s",
       "upper 95 % order-statistic bound of the median of the settling time, NaN if not within the hold",
       false, [](S s) { return s.settling_time.median.high; }},
      {"settling_time", "p75", "s",
       "75 % quantile of the settling time of all moves with a target, NaN if not within the hold", false,
       [](S s) { return s.settling_time.p75.value; }},
      {"settling_time", "p95", "s",
       "95 % quantile of the settling time of all moves with a target, NaN if not within the hold", false,
       [](S s) { return s.settling_time.p95.value; }},
      {"settling_time", "p95_low", "s",
       "lower 95 % order-statistic bound of the 95 % quantile of the settling time, NaN if not within the "
       "hold",
       false, [](S s) { return s.settling_time.p95.low; }},
      {"settling_time", "p95_high", "s",
       "upper 95 % order-statistic bound of the 95 % quantile of the settling time, NaN if not within the "
       "hold",
       false, [](S s) { return s.settling_time.p95.high; }},
      {"settling_time", "max", "s", "longest settling time of the moves that arrived", false,
       [](S s) { return s.settling_time.max; }},
      {"jerk_count", "n", "1", "trials, of which the jerk counts are", true,
       [](S s) { return to_double(s.jerk_count.n); }},
      {"jerk_count", "mean", "1", "mean number of jerks per trial", false,
       [](S s) { return s.jerk_count.mean; }},
      {"jerk_count", "sd", "1", "standard deviation of the number of jerks per trial", false,
       [](S s) { return s.jerk_count.sd; }},
      {"jerk_count", "median", "1", "median number of jerks per trial", false,
       [](S s) { return s.jerk_count.median; }},
      {"jerk_count", "p95", "1", "95 % quantile of the number of jerks per trial", false,
       [](S s) { return s.jerk_count.p95; }},
      {"jerk_count", "max", "1", "largest number of jerks of a trial", false,
       [](S s) { return s.jerk_count.max; }},
      {"jerk_count", "total", "1", "jerks of all trials", true,
       [](S s) { return to_double(s.jerk_count.total); }},
      {"jerk_interval", "n", "1", "intervals between the onsets of successive jerks of a move", true,
       [](S s) { return to_double(s.jerk_interval.n); }},
      {"jerk_interval", "mean", "s", "mean interval between successive jerks of a move", false,
       [](S s) { return s.jerk_interval.mean; }},
      {"jerk_interval", "median", "s", "median interval between successive jerks of a move", false,
       [](S s) { return s.jerk_interval.median; }},
      {"jerk_slowing", "moves", "1", "moves with 3 jerks or more", true,
       [](S s) { return to_double(s.jerk_slowing.moves); }},
      {"jerk_slowing", "slowing", "1", "moves with 3 jerks or more whose intervals grow (Mann-Kendall S > 0)",
       true, [](S s) { return to_double(s.jerk_slowing.slowing); }},
      {"jerk_slowing", "quickening", "1",
       "moves with 3 jerks or more whose intervals shrink (Mann-Kendall S < 0)", true,
       [](S s) { return to_double(s.jerk_slowing.quickening); }},
      {"jerk_slowing", "share", "1", "slowing moves as a proportion of the moves with 3 jerks or more", false,
       [](S s) { return s.jerk_slowing.proportion; }},
      {"jerk_slowing", "tau", "1",
       "Kendall's tau of jerk interval and its order, over the pairs within moves", false,
       [](S s) { return s.jerk_slowing.tau; }},
      {"", "jerk_agreement", "1", "jerks in the direction of the holding torque as a proportion of all jerks",
       false, [](S s) { return s.jerk_agreement; }},
      {"", "jerk_one_count_share", "1", "jerks of one count as a proportion of all jerks", false,
       [](S s) { return s.jerk_one_count_share; }},
  };
}

/// Of the time from which the error is 0 to the end of the move.
std::vector<StatisticField> final_settling_fields() {
  return {
      {"final_settling_time", "n", "1", "moves that ended at zero error, of which mean, min and max are",
       true, [](S s) { return to_double(s.final_settling_time.n); }},
      {"final_settling_time", "moves", "1", "moves with a target, of which the quantiles are", true,
       [](S s) { return to_double(s.final_settling_time.moves); }},
      {"final_settling_time", "mean", "s",
       "mean time until the error is zero for good, of the moves that ended at zero error", false,
       [](S s) { return s.final_settling_time.mean; }},
      {"final_settling_time", "min", "s", "shortest time until the error is zero for good", false,
       [](S s) { return s.final_settling_time.min; }},
      {"final_settling_time", "p05", "s",
       "5 % quantile of the time until the error is zero for good, of all moves with a target, NaN if not "
       "within the hold",
       false, [](S s) { return s.final_settling_time.p05.value; }},
      {"final_settling_time", "p25", "s",
       "25 % quantile of the time until the error is zero for good, of all moves with a target, NaN if not "
       "within the hold",
       false, [](S s) { return s.final_settling_time.p25.value; }},
      {"final_settling_time", "median", "s",
       "median of the time until the error is zero for good, of all moves with a target, NaN if not within "
       "the hold",
       false, [](S s) { return s.final_settling_time.median.value; }},
      {"final_settling_time", "median_low", "s",
       "lower 95 % order-statistic bound of final_settling_time_median, NaN if not within the hold", false,
       [](S s) { return s.final_settling_time.median.low; }},
      {"final_settling_time", "median_high", "s",
       "upper 95 % order-statistic bound of final_settling_time_median, NaN if not within the hold", false,
       [](S s) { return s.final_settling_time.median.high; }},
      {"final_settling_time", "p75", "s",
       "75 % quantile of the time until the error is zero for good, of all moves with a target, NaN if not "
       "within the hold",
       false, [](S s) { return s.final_settling_time.p75.value; }},
      {"final_settling_time", "p95", "s",
       "95 % quantile of the time until the error is zero for good, of all moves with a target, NaN if not "
       "within the hold",
       false, [](S s) { return s.final_settling_time.p95.value; }},
      {"final_settling_time", "p95_low", "s",
       "lower 95 % order-statistic bound of final_settling_time_p95, NaN if not within the hold", false,
       [](S s) { return s.final_settling_time.p95.low; }},
      {"final_settling_time", "p95_high", "s",
       "upper 95 % order-statistic bound of final_settling_time_p95, NaN if not within the hold", false,
       [](S s) { return s.final_settling_time.p95.high; }},
      {"final_settling_time", "max", "s", "longest time until the error is zero for good", false,
       [](S s) { return s.final_settling_time.max; }},
  };
}

std::vector<StatisticField> rig_fields() {
  return {
      {"rigs", "n", "1", "rigs that the trials ran on", true, [](S s) { return to_double(s.rigs.n); }},
      {"rigs", "success_sd", "1",
       "standard deviation between rigs of the probability of success (beta-binomial, moment estimate)",
       false, [](S s) { return s.rigs.success_sd; }},
      {"rigs", "without_failure", "1", "rigs all of whose trials succeeded, as a proportion of the rigs",
       false, [](S s) { return s.rigs.without_failure; }},
      {"rigs", "without_failure_low", "1", "lower 95 % Clopper-Pearson bound of rigs_without_failure", false,
       [](S s) { return s.rigs.without_failure_bounds.low; }},
      {"rigs", "without_failure_high", "1", "upper 95 % Clopper-Pearson bound of rigs_without_failure", false,
       [](S s) { return s.rigs.without_failure_bounds.high; }},
      {"rigs", "worst_5_percent", "1",
       "mean success rate of the worst 5 % of the rigs (of R rigs the R/20 with the lowest, rounded up)",
       false, [](S s) { return s.rigs.worst_5_percent; }},
  };
}

std::vector<StatisticField> fields_of_all_studies() {
  std::vector<StatisticField> all = outcome_and_jerk_fields();
  const std::vector<StatisticField> final_settling = final_settling_fields();
  all.insert(all.end(), final_settling.begin(), final_settling.end());
  const std::span<const StatisticField> measures = measure_statistic_fields();
  all.insert(all.end(), measures.begin(), measures.end());
  return all;
}

}  // namespace

std::span<const StatisticField> mean_bound_fields() {
  static constexpr std::array<StatisticField, 6> fields{{
      {"settling_time", "mean_low", "s",
       "lower bound of the mean settling time of the moves that arrived: Student and studentised bootstrap",
       false, [](S s) { return s.settling_time.mean_bounds.low; }},
      {"settling_time", "mean_high", "s",
       "upper bound of the mean settling time of the moves that arrived: Student and studentised bootstrap",
       false, [](S s) { return s.settling_time.mean_bounds.high; }},
      {"final_settling_time", "mean_low", "s",
       "lower bound of final_settling_time_mean: Student and studentised bootstrap", false,
       [](S s) { return s.final_settling_time.mean_bounds.low; }},
      {"final_settling_time", "mean_high", "s",
       "upper bound of final_settling_time_mean: Student and studentised bootstrap", false,
       [](S s) { return s.final_settling_time.mean_bounds.high; }},
      {"jerk_count", "mean_low", "1",
       "lower bound of the mean number of jerks per trial: Student and studentised bootstrap, Garwood for "
       "few",
       false, [](S s) { return s.jerk_count.mean_bounds.low; }},
      {"jerk_count", "mean_high", "1",
       "upper bound of the mean number of jerks per trial: Student and studentised bootstrap, Garwood for "
       "few",
       false, [](S s) { return s.jerk_count.mean_bounds.high; }},
  }};
  return fields;
}

std::span<const StatisticField> statistic_fields(const StudyFeatures& features) {
  static const auto fields_with = [](bool stopping, bool rigs) {
    std::vector<StatisticField> all = fields_of_all_studies();
    if (rigs) {
      const std::vector<StatisticField> own = rig_fields();
      all.insert(all.end(), own.begin(), own.end());
    }
    if (stopping) {
      all.push_back({"", "stopped", "1", "trials that were ended early, because a move had diverged", true,
                     [](S s) { return to_double(s.stopped); }});
    }
    return all;
  };
  static const std::array<std::vector<StatisticField>, 4> fields{
      fields_with(false, false), fields_with(true, false), fields_with(false, true), fields_with(true, true)};
  return fields[(features.stopping ? 1U : 0U) + (features.rigs ? 2U : 0U)];
}

}  // namespace zerocount
