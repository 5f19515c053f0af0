#include <limits>
#include <utility>

#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::layout {
namespace {

using M = trial::MoveOutcome;
using enum Statistic;

constexpr double margin_of_rates = 0.02;

constexpr ValidValues a_count{"a count, not negative"};
constexpr ValidValues a_fraction_or_nan{"a fraction, or NaN", 0.0, 1.0, true};
constexpr ValidValues a_time_or_nan{.expected = "a finite time, not negative, or NaN", .nan = true};
constexpr ValidValues an_error_or_nan{.expected = "a finite number, not negative, or NaN", .nan = true};

/// The statistics that are reported for a measure of the true motion: number of moves that have it, mean,
/// maximum and bounds of the mean.
/// @param name JSON object that holds the statistics.
ReportedStatistics mean_of_motion(std::string_view name) {
  return {name,
          {{{n}, "moves that have this measure, of which its statistics are"},
           {{mean, max}, "{0} of this measure over the moves"},
           {{bootstrap_low, bootstrap_high}, "{0} of this measure: Student and studentised bootstrap"}}};
}

SummaryColumn bounded_mean(std::string head) {
  return {std::move(head), mean, CellText::number, BoundStatistics{bootstrap_low, bootstrap_high}};
}

/// Presentation of a measure of the true motion in summaries and sensitivity analyses.
struct ShownMotion {
  std::string head{};         ///< Head of the measure's column in the summary; empty: it has no column
  std::string legend{};       ///< Explanation of that column below the summary's table
  std::string_view output{};  ///< Meaning as an output of a trial in a sensitivity analysis; empty: it is not
                              /// < an output
};

/// Describes a measure of the true motion. A move has the measure if its value is not NaN. The value of a
/// trial is the largest of its moves.
/// @param use the feature without which no file has the measure.
/// @param missing meaning of a move without the measure.
Measure of_motion(bool study::StudyFeatures::*use, Missing missing, const char* name, const char* unit,
                  const char* long_name, double M::*member, const ShownMotion& shown = {}) {
  Measure measure{.field = field<M>(name, unit, long_name, member, an_error_or_nan),
                  .only_with = use,
                  .values = {.missing = missing},
                  .reduction = MoveReduction::largest,
                  .point = mean_of_motion(name)};
  if (!shown.head.empty()) measure.summary = {use, {bounded_mean(shown.head)}, shown.legend};
  if (!shown.output.empty()) measure.output = {name, shown.output};
  return measure;
}

/// Appends the measures of the position error of one mass, whether or not its encoder closes the loop.
/// @param error, overshoot names of the two measures.
void add_measures_of_mass(MeasureTable& measures, bool study::StudyFeatures::*use, const char* error,
                          const char* overshoot) {
  measures.push_back({.field = field<M>(error, "count", "true_error of this mass", &M::other_true_error),
                      .only_with = use,
                      .values = {.magnitude = true},
                      .reduction = MoveReduction::largest,
                      .point = {error,
                                {{{n}, "moves that have it, of which its statistics are"},
                                 {{mean, rms, max}, "{0} of the true error of this mass"}}},
                      .output = {{error, "largest true error of this mass"}}});
  measures.push_back({.field = field<M>(overshoot, "rad", "true_overshoot of this mass",
                                        &M::other_true_overshoot, an_error_or_nan),
                      .only_with = use,
                      .values = {.needs_target = true},
                      .reduction = MoveReduction::largest,
                      .point = {overshoot,
                                {{{n}, "moves that have it, of which its statistics are"},
                                 {{mean, p95, max}, "{0} of the true overshoot of this mass"}}},
                      .output = {{overshoot, "largest true overshoot of this mass"}}});
}

MeasureTable own_measures() {
  using F = study::StudyFeatures;
  return {
      {.field = field<M>("outcome", "1", "verdict on the last window of the move", &M::outcome,
                         {"0 to 5", 0.0, 5.0}, outcome_labels()),
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point = {"",
                 {{{rate}, "zero_count as a proportion of trials, NaN of an open-loop study"},
                  {{rate_low, rate_high},
                   "{1} of success_rate: Clopper-Pearson, with machines Korn-Graubard"},
                  {{rate_wilson_low, rate_wilson_high},
                   "{1} of success_rate, with machines for the effective number of trials"}},
                 "success"},
       .output = {{"success", "all moves ended at zero counts"}},
       .gate = {{"success_rate", Worse::less, margin_of_rates}}},
      {.field = field<M>("arrived", "1", "the error was 0 for a whole dwell", &M::arrived),
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point = {"", {{{count}, "trials all of whose moves arrived"}}},
       .output = {{"arrived", "all moves arrived"}},
       .gate = {{"arrival_rate", Worse::less, margin_of_rates}}},
      {.field = field<M>("arrival", "1",
                         "first sample of the arrival dwell from the start of the move, -1 if never",
                         &M::arrival, {"a sample, or -1", -1.0}),
       .values = {.negative_is_missing = true}},
      {.field = field<M>("arrival_time", "s", "time of arrival from the start of the move, NaN if never",
                         &M::arrival_time, a_time_or_nan),
       .values = {.needs_target = true, .missing = Missing::late},
       .reduction = MoveReduction::largest,
       .point = {"arrival_time",
                 {{{n}, "moves that arrived, of which mean, min and max are"},
                  {{all}, "moves with a target, of which the quantiles are"},
                  {{mean}, "mean time until arrival of the moves that arrived"},
                  {{min}, "shortest time until arrival of the moves that arrived"},
                  {{p05, p25, median, p75, p95},
                   "{0} of the time until arrival of all moves with a target, NaN if not within the hold"},
                  {{median_low, median_high, p95_low, p95_high},
                   "{0} of the time until arrival, NaN if not within the hold"},
                  {{max}, "longest time until arrival of the moves that arrived"},
                  {{bootstrap_low, bootstrap_high},
                   "{0} time until arrival of the moves that arrived: Student and studentised bootstrap"}}},
       .summary = {.columns = {{"arrival median (s)", median, CellText::settling_time},
                               {"p95 (s)", p95, CellText::settling_time},
                               {"arrived", n, CellText::proportion_of_moves}},
                   .legend =
                       "arrival: the error is first 0 for the whole dwell; "
                       "median and p95 of all moves, those that never arrived being later than any time; "
                       "arrived: proportion of moves\n"},
       .output =
           {{"arrival_time",
             "time until arrival, the longest of the trial's moves; a move that never arrived counts with its duration"}},
       .gate = {{"arrival_time", Worse::more, 0.0005, 0.05}}},
      {.field = field<M>("final_settling_time", "s",
                         "settling time at zero error, from the start of the move, NaN if never",
                         &M::final_settling_time, a_time_or_nan),
       .values = {.needs_target = true, .missing = Missing::late},
       .point =
           {"final_settling_time",
            {{{n}, "moves that ended at zero error, of which mean, min and max are"},
             {{all}, "moves with a target, of which the quantiles are"},
             {{mean}, "mean time until the error is zero for good, of the moves that ended at zero error"},
             {{min}, "shortest time until the error is zero for good"},
             {{p05, p25, median, p75, p95},
              "{0} of the time until the error is zero for good, of all moves with a target, NaN if not within the hold"},
             {{median_low, median_high}, "{1} of final_settling_time_median, NaN if not within the hold"},
             {{p95_low, p95_high}, "{1} of final_settling_time_p95, NaN if not within the hold"},
             {{max}, "longest time until the error is zero for good"},
             {{bootstrap_low, bootstrap_high},
              "{1} of final_settling_time_mean: Student and studentised bootstrap"}}}},
      {.field = field<M>(
           "zero_fraction", "1",
           "fraction of the samples from arrival to the end with an error of 0, NaN if never arrived",
           &M::zero_fraction, a_fraction_or_nan),
       .values = {.worse = Worse::less},
       .point = {"zero_fraction",
                 {{{n}, "moves that arrived, of which the zero fractions are"},
                  {{mean}, "mean fraction of the samples since arrival with an error of 0"}}}},
      {.field = field<M>("stable", "1", "arrived, and the error within one count from then to the end",
                         &M::stable),
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point = {"",
                 {{{count}, "trials all of whose moves arrived and stayed within one count"},
                  {{rate}, "stable as a proportion of trials, NaN of an open-loop study"},
                  {{rate_low, rate_high}, "{1} of stable_rate: Clopper-Pearson, with machines Korn-Graubard"},
                  {{rate_wilson_low, rate_wilson_high},
                   "{1} of stable_rate, with machines for the effective number of trials"}}},
       .output = {{"stable", "all moves arrived and stayed within one count"}},
       .gate = {{"stable_rate", Worse::less, margin_of_rates}}},
      {.field = field<M>("broke_away", "1", "the hook slid during the move", &M::broke_away),
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials in which the hook slid during any move"}}},
       .level = {"", {{{count}, "trials in which the hook slid during the level"}}},
       .output = {{"broke_away", "the hook slid in some move"}}},
      {.field = field<M>("saturated", "1", "the DAC clipped", &M::saturated),
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials in which the DAC clipped during any move"}}}},
      {.field = field<M>("overshoot", "count",
                         "largest excursion beyond the target, seen from the first count of the move",
                         &M::overshoot, a_count),
       .values = {.needs_target = true},
       .reduction = MoveReduction::largest,
       .point = {"overshoot",
                 {{{n}, "moves with a target, of which the overshoots are"},
                  {{mean, max}, "{0} overshoot of the moves"}}},
       .output = {{"overshoot", "largest excursion beyond a target"}}},
      {.field = field<M>(
           "true_overshoot", "rad",
           "largest position error beyond the target in the direction of the move, at least 0, NaN of a move that was stopped or lost its motion",
           &M::true_overshoot, an_error_or_nan),
       .only_with = &F::position_error,
       .values = {.needs_target = true},
       .reduction = MoveReduction::largest,
       .point = {"true_overshoot",
                 {{{n}, "moves that have a true overshoot, of which its statistics are"},
                  {{mean, p95, max}, "{0} of the true overshoot over the moves"}}},
       .output = {{"true_overshoot", "largest position error beyond a target"}}},
      {.field = field<M>("holding_torque", "N m", "$torque decided at the last sample", &M::holding_torque),
       .values = {.mirrored = true},
       .point = {"holding_torque",
                 {{{n}, "moves with a finite holding $torque, of which these are"},
                  {{mean, min, max}, "{0} holding $torque of the moves"}}},
       .level = {"", {{{mean}, "mean $torque at the end of the level", "torque"}}},
       .output = {{"holding_torque", "$torque decided at the last sample of the last move"}}},
      {.field = field<M>("peak_torque", "N m", "largest absolute $torque decided", &M::peak_torque),
       .reduction = MoveReduction::largest,
       .point = {"peak_torque",
                 {{{n}, "moves with a finite peak $torque, of which these are"},
                  {{mean, max}, "{0} peak $torque of the moves"}}},
       .output = {{"peak_torque", "largest absolute $torque decided"}}},
      {.field = field<M>("creep", "rad", "plastic extension xp at the last sample", &M::creep),
       .values = {.mirrored = true},
       .point = {"creep",
                 {{{n}, "moves with a finite creep, of which these are"},
                  {{mean, min, max}, "{0} creep of the moves"}}},
       .level = {"creep",
                 {{{mean}, "mean plastic extension at the end of the level"},
                  {{student_low, student_high}, "{0} plastic extension (Student's t)"},
                  {{sd}, "standard deviation of the plastic extension"},
                  {{min, max}, "{0} plastic extension"}}},
       .output = {{"creep", "plastic extension at the last sample of the last move"}}},
      {.field = field<M>("final_position", "rad", "$rotor_angle at the last sample", &M::final_position),
       .level = {"position",
                 {{{mean}, "mean $rotor_angle at the end of the level"},
                  {{student_low, student_high}, "{0} $rotor_angle (Student's t)"},
                  {{sd}, "standard deviation of the $rotor_angle"},
                  {{min, max}, "{0} $rotor_angle"}}},
       .output = {{"final_position", "$rotor_angle at the last sample of the last move"}}},
      {.field =
           field<M>("midway_error", "count",
                    "target minus count at the first sample of the last half of the move", &M::midway_error),
       .values = {.mirrored = true}},
      {.field = field<M>("final_error", "count", "target minus count at the last sample", &M::final_error),
       .values = {.needs_target = true, .needs_motion = true, .magnitude = true},
       .point = {"final_error",
                 {{{n}, "moves whose motion was not lost, of which the final errors are"},
                  {{mean}, "mean absolute error at the last sample of the moves"},
                  {{median, p95}, "{0} of the absolute error at the last sample"},
                  {{median_low, median_high, p95_low, p95_high}, "{0} of the final error"},
                  {{max}, "largest absolute error at the last sample"}}},
       .summary = {&F::final_error,
                   {{"|e| median", median}, {"|e| p95", p95}},
                   "|e|: error at the last sample of the moves, in counts\n"}},
      {.field = field<M>(
           "true_error", "count",
           "distance from the $rotor to the middle of the target's count at the last sample, NaN if none",
           &M::true_error),
       .values = {.magnitude = true},
       .reduction = MoveReduction::largest,
       .point = {"true_error",
                 {{{n}, "moves with a target whose motion was not lost, of which the true errors are"},
                  {{mean},
                   "mean distance from the $rotor to the middle of the target's count at the last sample"},
                  {{rms, max}, "{0} distance from the $rotor to the middle of the target's count"}}},
       .summary =
           {&F::encoder_errors,
            {{"|true e| mean", mean}, {"|true e| max", max}},
            "|true e|: distance from the rotor to the middle of the target's count at the last sample of the moves,\n"
            "whatever the encoder says, in counts\n"},
       .output = {{"true_error",
                   "largest distance from the middle of a target's count at the end of a move"}}},
      {.field = field<M>("travel_time", "s", "time until the reference or the $torque is where it is held",
                         &M::travel_time, a_time_or_nan),
       .values = {.missing = Missing::none},
       .point = {"travel_time",
                 {{{mean}, "mean time until the reference or the $torque is where it is held, of the moves"},
                  {{max}, "longest time until the reference or the $torque is where it is held"}}},
       .summary = {&F::travel,
                   {{"travel (s)", mean}},
                   "travel: mean time that the reference takes to its target\n"}},
      {.field = field<M>("phase_changes", "1", "changes of the control from coarse to fine or back",
                         &M::phase_changes, a_count),
       .reduction = MoveReduction::sum,
       .point = {"phase_changes",
                 {{{trials}, "trials in which the control changed its phase"},
                  {{mean}, "mean number of phase changes per trial"},
                  {{whole_max}, "largest number of phase changes of a trial"}}},
       .summary = {&F::phases,
                   {{"phase changes", mean}},
                   "phase changes: from coarse to fine control or back, mean over all trials\n"}},
      {.field = field<M>("encoder_disagreement", "1",
                         "samples at which the fine count made the coarse one impossible",
                         &M::encoder_disagreement, a_count),
       .reduction = MoveReduction::sum,
       .point = {"encoder_disagreement",
                 {{{trials}, "trials with samples at which the fine count made the coarse one impossible"},
                  {{mean}, "mean number of such samples per trial"},
                  {{whole_max}, "largest number of such samples of a trial"}}},
       .summary =
           {&F::coarse_errors,
            {{"disagreeing", trials, CellText::proportion_of_trials}},
            "disagreeing: proportion of trials in which the coarse count was ever impossible given the fine one\n"}},
      {.field = field<M>(
           "oscillation_amplitude", "count",
           "half of the largest minus the smallest count in the last half of an oscillating move, NaN of others",
           &M::oscillation_amplitude, {.expected = "a finite amplitude, not negative, or NaN", .nan = true}),
       .values = {.missing = Missing::none},
       .point = {"oscillation",
                 {{{n}, "moves that oscillated to their end"},
                  {{median}, "median amplitude of these moves in their last half", "amplitude_median"}}}},
      {.field =
           field<M>("oscillation_period", "s",
                    "mean time between upward crossings of the middle of these counts, NaN if fewer than two",
                    &M::oscillation_period, a_time_or_nan),
       .values = {.missing = Missing::none},
       .point = {"oscillation",
                 {{{median}, "median period of those of these moves that have one", "period_median"}}}},
      {.field = field<M>("reversal_depth", "1", "largest number of reversal points on the stack",
                         &M::reversal_depth, a_count),
       .reduction = MoveReduction::largest,
       .point = {"", {{{whole_max}, "largest number of reversal points on the stack"}}},
       .level = {"", {{{whole_max}, "largest number of reversal points on the stack during the level"}}}},
      {.field = field<M>("jerk_count", "1", "excursions of the error from zero after arrival", &M::jerk_count,
                         a_count),
       .values = {.needs_target = true},
       .reduction = MoveReduction::sum,
       .point = {"jerk_count",
                 {{{n}, "trials, of which the jerk counts are"},
                  {{mean, median}, "{0} number of jerks per trial"},
                  {{sd, p95}, "{0} of the number of jerks per trial"},
                  {{max}, "largest number of jerks of a trial"},
                  {{total}, "jerks of all trials"},
                  {{bootstrap_low, bootstrap_high},
                   "{0} number of jerks per trial: Student and studentised bootstrap, Garwood for few"}}},
       .summary = {.columns = {{"jerks/trial", mean}}, .legend = "jerks/trial: mean over all trials\n"},
       .output = {{"jerk_count", "jerks of all moves"}},
       .gate = {{"jerk_count", Worse::more, 0.05, 0.1}}},
      {.field = field<M>("jerk_agreement", "1",
                         "proportion of the jerks in the direction of the holding $torque, NaN if none",
                         &M::jerk_agreement, {"a proportion, or NaN", 0.0, 1.0, true}),
       .values = {.missing = Missing::none}},
      {.field = field<M>("stopped", "1",
                         "the move had diverged and was ended there, or was not run after one that was",
                         &M::stopped),
       .only_with = &F::stopping,
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials that were ended early, because a move had diverged"}}},
       .summary = {&F::stopping,
                   {{"stopped", count, CellText::proportion_of_trials}},
                   "stopped: proportion of trials that were ended where a move had diverged; "
                   "they count as oscillating, and what is measured of their moves is up to there\n"}},
      {.field = field<M>("controller_failed", "1",
                         "the controller gave no finite $torque, in this move or one before: it is nonfinite",
                         &M::controller_failed),
       .only_with = &F::own_controller,
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials that the controller ended by giving no finite $torque"}}},
       .summary =
           {&F::own_controller,
            {{"controller failed", count, CellText::proportion_of_trials}},
            "controller failed: proportion of trials that the controller ended by giving no finite torque; they count as nonfinite\n"}},
      of_motion(
          &F::motion, Missing::never, "rest_error_rms", "count",
          "rms of the true error at rest, NaN if never at rest", &M::rest_error_rms,
          {"rest rms",
           "rest rms, rest p-p: of the true error (counts) from the entry into the rest band to the end of the move, mean over moves\n",
           "rms of the true error at rest, the largest of the trial's moves"}),
      of_motion(&F::motion, Missing::never, "rest_error_range", "count",
                "peak to peak of the true error at rest, NaN if never at rest", &M::rest_error_range,
                {"rest p-p"}),
      of_motion(&F::motion, Missing::never, "rest_motion_rms", "rad",
                "rms of the true error at rest, NaN if never at rest", &M::rest_motion_rms),
      of_motion(&F::motion, Missing::never, "rest_motion_range", "rad",
                "peak to peak of the true error at rest, NaN if never at rest", &M::rest_motion_range),
      of_motion(
          &F::motion, Missing::never, "rest_torque_power", "(N m)^2",
          "mean square of the $torque at rest, NaN if never at rest", &M::rest_torque_power,
          {"$torque power",
           "$torque power, $torque noise: mean square of the $torque at rest, and of its changes from sample to sample, mean over moves\n",
           "mean square of the $torque at rest, the largest of the moves"}),
      of_motion(
          &F::motion, Missing::never, "rest_torque_noise", "(N m)^2",
          "mean square of the changes of the $torque from sample to sample at rest, NaN if never at rest",
          &M::rest_torque_noise, {"$torque noise"}),
      {.field = field<M>("step_motion", "count",
                         "mean true position in the window minus that of the move before", &M::step_motion,
                         {.expected = "a finite motion, or NaN",
                          .low = std::numeric_limits<double>::lowest(),
                          .nan = true}),
       .only_with = &F::steps,
       .values = {.needs_motion = true, .mirrored = true},
       .point = mean_of_motion("step_motion")},
      {.field = field<M>("step_made", "1", "that motion is within half of the commanded step", &M::step_made),
       .only_with = &F::steps,
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point =
           {"step_made",
            {{{moves_rate},
              "moves whose mean true motion is within half of the commanded step, as a proportion of the moves",
              "rate"},
             {{moves_rate_low}, "{1} of that proportion (Korn-Graubard)", "rate_low"},
             {{moves_rate_high}, "{1} of that proportion (Korn-Graubard)", "rate_high"}}},
       .summary =
           {&F::steps,
            {{"steps made", moves_rate, CellText::percent, BoundStatistics{moves_rate_low, moves_rate_high}}},
            "steps made: proportion of moves whose mean true motion is within half of the commanded step\n"},
       .output = {{"step_made", "all moves went the commanded step, to half of it"}}},
      of_motion(
          &F::following, Missing::none, "following_error_rms", "count",
          "rms of the true following error, NaN of a step", &M::following_error_rms,
          {"following rms", "following rms, peak: of the true following error (counts), mean over moves\n",
           "rms of the true following error, the largest of the moves"}),
      of_motion(&F::following, Missing::none, "following_error_peak", "count",
                "largest magnitude of the true following error, NaN of a step", &M::following_error_peak,
                {"following peak", "", "largest magnitude of the true following error"}),
      of_motion(
          &F::reversals, Missing::none, "reversal_spike", "count",
          "largest magnitude of the true following error in the quarter of a period after a reversal of the sine, NaN if none",
          &M::reversal_spike,
          {"reversal spike",
           "reversal spike: largest magnitude of the true following error (counts) in the quarter of a period after a reversal, mean over moves\n"}),
  };
}

}  // namespace

MeasureTable move_measures() {
  using F = study::StudyFeatures;
  MeasureTable measures = own_measures();
  add_measures_of_mass(measures, &F::load_error, "load_true_error", "load_true_overshoot");
  add_measures_of_mass(measures, &F::motor_error, "motor_true_error", "motor_true_overshoot");
  return measures;
}

}  // namespace zerocount::layout
