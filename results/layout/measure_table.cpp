#include "results/layout/measure_table.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "results/layout/fields.hpp"

namespace zerocount::layout {
namespace {

using M = trial::MoveOutcome;
using enum Statistic;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double margin_of_rates = 0.02;

constexpr ValidValues a_count{"a count, not negative"};
constexpr ValidValues a_fraction_or_nan{"a fraction, or NaN", 0.0, 1.0, true};
constexpr ValidValues a_time_or_nan{.expected = "a finite time, not negative, or NaN", .nan = true};
constexpr ValidValues an_error_or_nan{.expected = "a finite number, not negative, or NaN", .nan = true};

/// The statistics of a measure of the true motion.
ReportedStatistics mean_of_motion(std::string_view name) {
  return {name,
          {{{n}, "moves that have this measure, of which its statistics are"},
           {{mean, max}, "{0} of this measure over the moves"},
           {{bootstrap_low, bootstrap_high}, "{0} of this measure: Student and studentised bootstrap"}}};
}

SummaryColumn bounded_mean(std::string head) {
  return {std::move(head), mean, CellText::number, BoundStatistics{bootstrap_low, bootstrap_high}};
}

MeasureTable all_measures() {
  return {
      {.field = field<M>("outcome", "1", "verdict on the last window of the move", &M::outcome,
                         {"0 to 5", 0.0, 5.0}, outcome_labels()),
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point = {"",
                 {{{rate}, "zero_count as a proportion of trials, NaN of an open-loop study"},
                  {{rate_low, rate_high}, "{1} of success_rate: Clopper-Pearson, with rigs Korn-Graubard"},
                  {{rate_wilson_low, rate_wilson_high},
                   "{1} of success_rate, with rigs for the effective number of trials"}},
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
                         &M::arrival, {"a sample, or -1", -1.0})},
      {.field = field<M>("settling_time", "s", "time of arrival from the start of the move, NaN if never",
                         &M::settling_time, a_time_or_nan),
       .values = {.needs_target = true, .nan_is_late = true},
       .reduction = MoveReduction::largest,
       .point = {"settling_time",
                 {{{n}, "moves that arrived, of which mean, min and max are"},
                  {{all}, "moves with a target, of which the quantiles are"},
                  {{mean}, "mean settling time of the moves that arrived"},
                  {{min}, "shortest settling time of the moves that arrived"},
                  {{p05, p25, median, p75, p95},
                   "{0} of the settling time of all moves with a target, NaN if not within the hold"},
                  {{median_low, median_high, p95_low, p95_high},
                   "{0} of the settling time, NaN if not within the hold"},
                  {{max}, "longest settling time of the moves that arrived"},
                  {{bootstrap_low, bootstrap_high},
                   "{0} settling time of the moves that arrived: Student and studentised bootstrap"}}},
       .summary = {.columns = {{"arrival median (s)", median, CellText::settling_time},
                               {"p95 (s)", p95, CellText::settling_time},
                               {"arrived", n, CellText::proportion_of_moves}},
                   .legend =
                       "arrival: the error is first 0 for the whole dwell; median and p95 of all moves, "
                       "those that never arrived being later than any time; arrived: proportion of "
                       "moves\n"},
       .output = {{"settling_time",
                   "time until arrival, the longest of the trial's moves; a move that never arrived counts "
                   "with its duration"}},
       .gate = {{"settling_time", Worse::more, 0.0005, 0.05}}},
      {.field = field<M>("final_settling_time", "s",
                         "time from which the error is 0 to the end, from the start of the move, NaN if none",
                         &M::final_settling_time, a_time_or_nan),
       .file = {.since = 3, .before = unknown},
       .values = {.needs_target = true, .nan_is_late = true},
       .point =
           {"final_settling_time",
            {{{n}, "moves that ended at zero error, of which mean, min and max are"},
             {{all}, "moves with a target, of which the quantiles are"},
             {{mean}, "mean time until the error is zero for good, of the moves that ended at zero error"},
             {{min}, "shortest time until the error is zero for good"},
             {{p05, p25, median, p75, p95},
              "{0} of the time until the error is zero for good, of all moves with a target, NaN if not "
              "within the hold"},
             {{median_low, median_high}, "{1} of final_settling_time_median, NaN if not within the hold"},
             {{p95_low, p95_high}, "{1} of final_settling_time_p95, NaN if not within the hold"},
             {{max}, "longest time until the error is zero for good"},
             {{bootstrap_low, bootstrap_high},
              "{1} of final_settling_time_mean: Student and studentised bootstrap"}}}},
      {.field = field<M>(
           "zero_fraction", "1",
           "fraction of the samples from arrival to the end with an error of 0, NaN if never arrived",
           &M::zero_fraction, a_fraction_or_nan),
       .file = {.since = 3, .before = unknown},
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
                  {{rate_low, rate_high}, "{1} of stable_rate: Clopper-Pearson, with rigs Korn-Graubard"},
                  {{rate_wilson_low, rate_wilson_high},
                   "{1} of stable_rate, with rigs for the effective number of trials"}}},
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
      {.field = field<M>("true_overshoot", "rad",
                         "largest position error beyond the target in the direction of the move, at least 0, "
                         "NaN of a move that was stopped or lost its motion",
                         &M::true_overshoot, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::position_error},
       .values = {.needs_target = true},
       .reduction = MoveReduction::largest,
       .point = {"true_overshoot",
                 {{{n}, "moves that have a true overshoot, of which its statistics are"},
                  {{mean, p95, max}, "{0} of the true overshoot over the moves"}}},
       .output = {{"true_overshoot", "largest position error beyond a target"}}},
      {.field = field<M>("holding_torque", "N m", "$torque decided at the last sample", &M::holding_torque),
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
       .file = {.since = 3, .before = unknown}},
      {.field = field<M>("final_error", "count", "target minus count at the last sample", &M::final_error),
       .file = {.since = 2, .before = unknown},
       .values = {.needs_target = true, .needs_motion = true, .magnitude = true},
       .point = {"final_error",
                 {{{n}, "moves whose motion was not lost, of which the final errors are"},
                  {{mean}, "mean absolute error at the last sample of the moves"},
                  {{median, p95}, "{0} of the absolute error at the last sample"},
                  {{median_low, median_high, p95_low, p95_high}, "{0} of the final error"},
                  {{max}, "largest absolute error at the last sample"}}},
       .summary = {&study::StudyFeatures::final_error,
                   {{"|e| median", median}, {"|e| p95", p95}},
                   "|e|: error at the last sample of the moves, in counts\n"}},
      {.field = field<M>(
           "true_error", "count",
           "distance from the $rotor to the middle of the target's count at the last sample, NaN if none",
           &M::true_error),
       .file = {.since = 2, .before = unknown},
       .values = {.magnitude = true},
       .reduction = MoveReduction::largest,
       .point = {"true_error",
                 {{{n}, "moves with a target whose motion was not lost, of which the true errors are"},
                  {{mean},
                   "mean distance from the $rotor to the middle of the target's count at the last sample"},
                  {{rms, max}, "{0} distance from the $rotor to the middle of the target's count"}}},
       .summary = {&study::StudyFeatures::encoder_errors,
                   {{"|true e| mean", mean}, {"|true e| max", max}},
                   "|true e|: distance from the rotor to the middle of the target's count at the last sample "
                   "of the moves,\nwhatever the encoder says, in counts\n"},
       .output = {{"true_error",
                   "largest distance from the middle of a target's count at the end of a "
                   "move"}}},
      {.field = field<M>("travel_time", "s", "time until the reference or the $torque is where it is held",
                         &M::travel_time, a_time_or_nan),
       .file = {.since = 2},
       .point = {"travel_time",
                 {{{mean}, "mean time until the reference or the $torque is where it is held, of the moves"},
                  {{max}, "longest time until the reference or the $torque is where it is held"}}},
       .summary = {&study::StudyFeatures::travel,
                   {{"travel (s)", mean}},
                   "travel: mean time that the reference takes to its target\n"}},
      {.field = field<M>("phase_changes", "1", "changes of the control from coarse to fine or back",
                         &M::phase_changes, a_count),
       .file = {.since = 2},
       .reduction = MoveReduction::sum,
       .point = {"phase_changes",
                 {{{trials}, "trials in which the control changed its phase"},
                  {{mean}, "mean number of phase changes per trial"},
                  {{whole_max}, "largest number of phase changes of a trial"}}},
       .summary = {&study::StudyFeatures::phases,
                   {{"phase changes", mean}},
                   "phase changes: from coarse to fine control or back, mean over all trials\n"}},
      {.field = field<M>("encoder_disagreement", "1",
                         "samples at which the fine count made the coarse one impossible",
                         &M::encoder_disagreement, a_count),
       .file = {.since = 2},
       .reduction = MoveReduction::sum,
       .point = {"encoder_disagreement",
                 {{{trials}, "trials with samples at which the fine count made the coarse one impossible"},
                  {{mean}, "mean number of such samples per trial"},
                  {{whole_max}, "largest number of such samples of a trial"}}},
       .summary =
           {&study::StudyFeatures::encoder_errors,
            {{"disagreeing", trials, CellText::proportion_of_trials}},
            "disagreeing: proportion of trials in which the coarse count was ever impossible given the "
            "fine one\n"}},
      {.field = field<M>("oscillation_amplitude", "count",
                         "half of the largest minus the smallest count in the last half of an oscillating "
                         "move, NaN of others",
                         &M::oscillation_amplitude,
                         {.expected = "a finite amplitude, not negative, or NaN", .nan = true}),
       .file = {.since = 3, .before = unknown},
       .point = {"oscillation",
                 {{{n}, "moves that oscillated to their end"},
                  {{median}, "median amplitude of these moves in their last half", "amplitude_median"}}}},
      {.field = field<M>("oscillation_period", "s",
                         "mean time between upward crossings of the middle of these counts, NaN if fewer "
                         "than two",
                         &M::oscillation_period, a_time_or_nan),
       .file = {.since = 3, .before = unknown},
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
                         &M::jerk_agreement, {"a proportion, or NaN", 0.0, 1.0, true})},
      {.field = field<M>("stopped", "1",
                         "the move had diverged and was ended there, or was not run after one that was",
                         &M::stopped),
       .file = {.only_with = &study::StudyFeatures::stopping},
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials that were ended early, because a move had diverged"}}},
       .summary = {&study::StudyFeatures::stopping,
                   {{"stopped", count, CellText::proportion_of_trials}},
                   "stopped: proportion of trials that were ended where a move had diverged; they count as "
                   "oscillating, and what is measured of their moves is up to there\n"}},
      {.field = field<M>("controller_failed", "1",
                         "the controller gave no finite $torque, in this move or one before: it is nonfinite",
                         &M::controller_failed),
       .file = {.only_with = &study::StudyFeatures::own_controller},
       .reduction = MoveReduction::any,
       .point = {"", {{{count}, "trials that the controller ended by giving no finite $torque"}}},
       .summary =
           {&study::StudyFeatures::own_controller,
            {{"controller failed", count, CellText::proportion_of_trials}},
            "controller failed: proportion of trials that the controller ended by giving no finite torque; "
            "they count as nonfinite\n"}},
      {.field = field<M>("rest_error_rms", "count", "rms of the true error at rest, NaN if never at rest",
                         &M::rest_error_rms, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_error_rms"),
       .summary = {&study::StudyFeatures::motion,
                   {bounded_mean("rest rms")},
                   "rest rms, rest p-p: of the true error (counts) from the entry into the rest band to the "
                   "end of the move, mean over moves\n"},
       .output = {{"rest_error_rms", "rms of the true error at rest, the largest of the trial's moves"}}},
      {.field = field<M>("rest_error_range", "count",
                         "peak to peak of the true error at rest, NaN if never at rest", &M::rest_error_range,
                         an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_error_range"),
       .summary = {&study::StudyFeatures::motion, {bounded_mean("rest p-p")}}},
      {.field = field<M>("rest_motion_rms", "rad", "rms of the true error at rest, NaN if never at rest",
                         &M::rest_motion_rms, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_motion_rms")},
      {.field = field<M>("rest_motion_range", "rad",
                         "peak to peak of the true error at rest, NaN if never at rest",
                         &M::rest_motion_range, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_motion_range")},
      {.field = field<M>("rest_torque_power", "(N m)^2",
                         "mean square of the $torque at rest, NaN if never at rest", &M::rest_torque_power,
                         an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_torque_power"),
       .summary =
           {&study::StudyFeatures::motion,
            {bounded_mean("$torque power")},
            "$torque power, $torque noise: mean square of the $torque at rest, and of its changes from "
            "sample to sample, mean over moves\n"},
       .output = {{"rest_torque_power", "mean square of the $torque at rest, the largest of the moves"}}},
      {.field =
           field<M>("rest_torque_noise", "(N m)^2",
                    "mean square of the changes of the $torque from sample to sample at rest, NaN if never "
                    "at rest",
                    &M::rest_torque_noise, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::motion},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("rest_torque_noise"),
       .summary = {&study::StudyFeatures::motion, {bounded_mean("$torque noise")}}},
      {.field = field<M>("step_motion", "count",
                         "mean true position in the window minus that of the move before", &M::step_motion,
                         {.expected = "a finite motion, or NaN",
                          .low = std::numeric_limits<double>::lowest(),
                          .nan = true}),
       .file = {.only_with = &study::StudyFeatures::steps},
       .values = {.needs_motion = true},
       .point = mean_of_motion("step_motion")},
      {.field = field<M>("step_made", "1", "that motion is within half of the commanded step", &M::step_made),
       .file = {.only_with = &study::StudyFeatures::steps},
       .values = {.needs_target = true},
       .reduction = MoveReduction::all,
       .point = {"step_made",
                 {{{moves_rate},
                   "moves whose mean true motion is within half of the commanded step, as a "
                   "proportion of the moves",
                   "rate"},
                  {{moves_rate_low}, "{1} of that proportion (Korn-Graubard)", "rate_low"},
                  {{moves_rate_high}, "{1} of that proportion (Korn-Graubard)", "rate_high"}}},
       .summary = {&study::StudyFeatures::steps,
                   {{"steps made", moves_rate, CellText::percent,
                     BoundStatistics{moves_rate_low, moves_rate_high}}},
                   "steps made: proportion of moves whose mean true motion is within half of the commanded "
                   "step\n"},
       .output = {{"step_made", "all moves went the commanded step, to half of it"}}},
      {.field = field<M>("following_error_rms", "count", "rms of the true following error, NaN of a step",
                         &M::following_error_rms, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::following},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("following_error_rms"),
       .summary = {&study::StudyFeatures::following,
                   {bounded_mean("following rms")},
                   "following rms, peak: of the true following error (counts), mean over moves\n"},
       .output = {{"following_error_rms", "rms of the true following error, the largest of the moves"}}},
      {.field = field<M>("following_error_peak", "count",
                         "largest magnitude of the true following error, NaN of a step",
                         &M::following_error_peak, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::following},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("following_error_peak"),
       .summary = {&study::StudyFeatures::following, {bounded_mean("following peak")}},
       .output = {{"following_error_peak", "largest magnitude of the true following error"}}},
      {.field = field<M>("reversal_spike", "count",
                         "largest magnitude of the true following error in the quarter of a period after a "
                         "reversal of the sine, NaN if none",
                         &M::reversal_spike, an_error_or_nan),
       .file = {.only_with = &study::StudyFeatures::reversals},
       .reduction = MoveReduction::largest,
       .point = mean_of_motion("reversal_spike"),
       .summary = {&study::StudyFeatures::reversals,
                   {bounded_mean("reversal spike")},
                   "reversal spike: largest magnitude of the true following error (counts) in the quarter of "
                   "a period after a "
                   "reversal, mean over moves\n"}},
  };
}

template <double trial::BandOutcome::*Member, std::size_t Band>
double value_of_band(const M& move) {
  return move.bands[Band].*Member;
}

/// [band] the functions of a move that give this measure of its error bands.
template <double trial::BandOutcome::*Member>
constexpr auto values_of_bands() {
  return []<std::size_t... Band>(std::index_sequence<Band...>) {
    return std::array<double (*)(const M&), sizeof...(Band)>{&value_of_band<Member, Band>...};
  }
  (std::make_index_sequence<trial::max_error_bands>());
}

/// A measure of an error band as a measure of the move.
RecordField<M> field_of_band(const RecordField<trial::BandOutcome>& field, std::int64_t band,
                             double (*value)(const M&)) {
  Column column = field.column;
  column.name = name_of_band(column.name, band);
  column.long_name += fmt::format(" (band of {} count{})", band, band == 1 ? "" : "s");
  return {std::move(column), value, field.valid};
}

/// The measures of the error band number `slot`, in the order of band_fields().
std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot) {
  using B = trial::BandOutcome;
  const std::int64_t band = bands.values()[slot];
  const FileHistory history{.since = 4, .before = unknown};
  const CountedValues times{.needs_target = true, .nan_is_late = true};
  std::vector<Measure> measures;
  measures.push_back(
      {.field = field_of_band(band_fields()[0], band, values_of_bands<&B::entry_time>()[slot]),
       .band = band,
       .file = history,
       .values = times,
       .reduction = MoveReduction::largest,
       .point = {"entry_time",
                 {{{n}, "moves that entered the error band, of which mean, min and max are"},
                  {{all}, "moves with a target, of which the quantiles are"},
                  {{mean, min, max}, "{0} time of entry into the error band of the moves that entered it"},
                  {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
                   "{0} of the time of entry into the error band of all moves with a target, NaN if not "
                   "within the hold"}}}});
  measures.push_back(
      {.field = field_of_band(band_fields()[1], band, values_of_bands<&B::settling_time>()[slot]),
       .band = band,
       .file = history,
       .values = times,
       .reduction = MoveReduction::largest,
       .point = {"settling_time",
                 {{{n}, "moves that ended within the error band, of which mean, min and max are"},
                  {{all}, "moves with a target, of which the quantiles are"},
                  {{mean, min, max},
                   "{0} time until the error is within the band for good, of the moves that ended within it"},
                  {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
                   "{0} of the time until the error is within the band for good, of all moves with a target, "
                   "NaN if not within the hold"},
                  {{bootstrap_low, bootstrap_high},
                   "{1} of the mean settling time: Student and studentised bootstrap"}}},
       .summary = {.columns = {{fmt::format("settled ±{} p95 (s)", band), p95, CellText::settling_time}},
                   .legend = slot > 0 ? ""
                                      : "settled ±b: the error stays within b counts from then to the end of "
                                        "the move; p95 of all moves, those that end outside being later "
                                        "than any time\n"},
       .output = {{name_of_band("band_settling_time", band),
                   "time until the error is within the band for good, the longest of the trial's moves; a "
                   "move that ends outside counts with its duration"}}});
  measures.push_back({.field = field_of_band(band_fields()[2], band, values_of_bands<&B::exits>()[slot]),
                      .band = band,
                      .file = history,
                      .values = {.needs_target = true},
                      .reduction = MoveReduction::sum,
                      .point = {"exits",
                                {{{n}, "trials, of which the numbers of exits are"},
                                 {{mean, sd, p95, max}, "{0} of the exits from the error band per trial"},
                                 {{total}, "exits from the error band of all trials"},
                                 {{bootstrap_low, bootstrap_high},
                                  "{1} of the mean number of exits: Student and studentised bootstrap, "
                                  "Garwood for few"}}}});
  return measures;
}

template <std::size_t Tolerance>
double value_of_tolerance(const M& move) {
  return move.tolerance_settling_times[Tolerance];
}

/// [tolerance] the functions of a move that give its settling time.
constexpr auto values_of_tolerances() {
  return []<std::size_t... Tolerance>(std::index_sequence<Tolerance...>) {
    return std::array<double (*)(const M&), sizeof...(Tolerance)>{&value_of_tolerance<Tolerance>...};
  }
  (std::make_index_sequence<trial::max_tolerances>());
}

Measure measure_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot) {
  const double tolerance = tolerances.values()[slot];
  const RecordField<ToleranceRecord>& field = tolerance_fields().front();
  Column column = field.column;
  const std::string name = name_of_tolerance(column.name, tolerance);
  column.name = name;
  return {
      .field = {std::move(column), values_of_tolerances()[slot], field.valid},
      .tolerance = tolerance,
      .values = {.needs_target = true, .nan_is_late = true},
      .reduction = MoveReduction::largest,
      .point = {"settling_time",
                {{{n}, "moves that ended within the tolerance, of which mean, min and max are"},
                 {{all}, "moves with a target, of which the quantiles are"},
                 {{mean, min, max},
                  "{0} time until the position error is within the tolerance for good, of the moves that "
                  "ended within it"},
                 {{p05, p25, median, p75, p95, median_low, median_high, p95_low, p95_high},
                  "{0} of the time until the position error is within the tolerance for good, of all moves "
                  "with a target, NaN if not within the hold"},
                 {{bootstrap_low, bootstrap_high},
                  "{1} of the mean settling time: Student and studentised bootstrap"}}},
      .summary = {.columns = {{fmt::format("within ±{:g} p95 (s)", tolerance), p95, CellText::settling_time}},
                  .legend = slot > 0 ? ""
                                     : "within ±t: the position error stays within the tolerance t from "
                                       "then to the end of the move; p95 of all moves\n"},
      .output = {{name,
                  "time until the position error is within the tolerance for good, the longest of the "
                  "trial's moves; a move that ends outside counts with its duration"}}};
}

MeasureTable measures_with(const trial::ErrorBands& bands, const trial::Tolerances& tolerances) {
  MeasureTable measures = all_measures();
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    for (Measure& measure : measures_of_band(bands, slot)) measures.push_back(std::move(measure));
  }
  for (std::size_t slot = 0; slot < tolerances.count; ++slot)
    measures.push_back(measure_of_tolerance(tolerances, slot));
  return measures;
}

/// The measures that come first; none of them twice.
std::vector<std::string_view> first_of(ReportOrder order) {
  switch (order) {
    case ReportOrder::statistics:
      return {"outcome",           "stable",         "arrived",       "broke_away",
              "saturated",         "settling_time",  "jerk_count",    "final_settling_time",
              "overshoot",         "holding_torque", "peak_torque",   "creep",
              "reversal_depth",    "final_error",    "zero_fraction", "oscillation_amplitude",
              "oscillation_period"};
    case ReportOrder::levels:
      return {"holding_torque", "final_position", "creep"};
    case ReportOrder::summary:
      return {"settling_time", "jerk_count", "stopped", "travel_time", "final_error", "phase_changes"};
    case ReportOrder::outputs:
      return {"outcome",    "settling_time", "arrived",    "stable",     "broke_away",
              "jerk_count", "overshoot",     "true_error", "peak_torque"};
  }
  return {};
}

}  // namespace

const MeasureTable& measure_table(const study::StudyFeatures& features) {
  // References into a map stay valid. Programs use few different limits.
  using Limits = std::pair<std::vector<std::int64_t>, std::vector<double>>;
  static std::mutex mutex;
  static std::map<Limits, MeasureTable> tables;
  const std::lock_guard lock(mutex);
  const trial::ErrorBands& bands = features.bands;
  const trial::Tolerances& tolerances = features.tolerances;
  const Limits limits{{bands.values().begin(), bands.values().end()},
                      {tolerances.values().begin(), tolerances.values().end()}};
  const auto found = tables.find(limits);
  return found != tables.end() ? found->second
                               : tables.emplace(limits, measures_with(bands, tolerances)).first->second;
}

std::string name_of_band(std::string_view name, std::int64_t band) {
  return fmt::format("{}[{}]", name, band);
}

std::string name_of_tolerance(std::string_view name, double tolerance) {
  return fmt::format("{}[{}]", name, tolerance);
}

bool is_in_file(const Measure& measure, std::int64_t version, const study::StudyFeatures& features) {
  return measure.file.since <= version &&
         (measure.file.only_with == nullptr || features.*measure.file.only_with);
}

bool is_quality(const Measure& measure) {
  return measure.reduction == MoveReduction::all || measure.reduction == MoveReduction::any;
}

bool has_quality(const Measure& measure, const trial::MoveOutcome& move) {
  const double value = value_of(measure.field, move);
  if (std::holds_alternative<trial::Outcome M::*>(measure.field.member))
    return trial::is_success(static_cast<trial::Outcome>(static_cast<std::int8_t>(value)));
  return value != 0.0;
}

std::vector<const Measure*> measures_of(const MeasureTable& measures, ReportOrder order,
                                        bool (*belongs)(const Measure&)) {
  std::vector<const Measure*> found;
  const auto add = [&](const Measure& measure) {
    if (belongs(measure) && std::find(found.begin(), found.end(), &measure) == found.end())
      found.push_back(&measure);
  };
  for (const std::string_view name : first_of(order)) {
    for (const Measure& measure : measures) {
      if (measure.field.column.name == name) add(measure);
    }
  }
  for (const Measure& measure : measures) add(measure);
  return found;
}

}  // namespace zerocount::layout
