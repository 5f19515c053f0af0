// The meaning of a value that a move lacks: an event that never came misses every limit, nothing to measure
// meets it.
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/move_event.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/fields.hpp"

namespace zerocount::measures {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

const std::set<std::string> nothing_to_measure{
    "oscillation_amplitude", "oscillation_period",   "jerk_agreement", "travel_time",
    "following_error_rms",   "following_error_peak", "reversal_spike"};

study::Study study_with(const std::string& more) {
  return manifest::parse_study(
      "zerocount: 1\nname: limits\nseed: 7\ntrials: 20\n"
      "command: {targets: [{integers: [5, 40]}], hold: 0.3}\n"
      "initial: {encoder_phase: {uniform: [0, 1]}}\n" +
          more,
      "test.yaml");
}

study::Study study_with_limit(const std::string& measure) {
  return study_with(
      fmt::format("verdict: {{motion: true, bands: [1, 3]}}\n"
                  "goal: {{band: 1, within: 0.1, moves: 0.9, limits: {{\"{}\": 1.0e+9}}}}\n",
                  measure));
}

/// The outcome of a move that is within every error band at once, and has no other measure.
trial::MoveOutcome settled_move() {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::one_count;
  move.travel_time = missing;  // of a sine
  for (trial::BandOutcome& band : move.bands) band = {missing, 0.01, missing};
  return move;
}

/// Names of the measures that the outcome of settled_move() lacks.
std::vector<std::string> lacking_measures() {
  std::vector<std::string> names;
  const study::Study study = study_with_limit("tolerance_settling_time[1.0e-6]");
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    const double value = layout::value_of(measure.field, settled_move());
    const bool is_of_other_mass =
        measure.field.column.name.find("load_") == 0 || measure.field.column.name.find("motor_") == 0;
    if ((std::isnan(value) || measure.values.negative_is_missing) && !is_of_other_mass)
      names.push_back(measure.tolerance ? "tolerance_settling_time[1.0e-6]" : measure.field.column.name);
  }
  return names;
}

bool meets_limit(const std::string& measure, const trial::MoveOutcome& move) {
  const study::Study study = study_with_limit(measure);
  return meets(criteria_of_goals(study).front(), move);
}

TEST(MissingValues, MeetALimitOnlyIfThereIsNothingToMeasure) {
  std::set<std::string> met;
  const std::vector<std::string> all = lacking_measures();
  EXPECT_GT(all.size(), 20U);
  for (const std::string& measure : all) {
    if (meets_limit(measure, settled_move())) met.insert(measure);
  }
  EXPECT_EQ(met, nothing_to_measure);
}

TEST(MissingValues, AStoppedMoveMissesEveryLimit) {
  for (const std::string& measure : lacking_measures()) {
    trial::MoveOutcome stopped = settled_move();
    stopped.stopped = true;
    stopped.outcome = trial::Outcome::oscillating;
    EXPECT_FALSE(meets_limit(measure, stopped)) << measure;
    trial::MoveOutcome lost = settled_move();
    lost.outcome = trial::Outcome::nonfinite;
    EXPECT_FALSE(meets_limit(measure, lost)) << measure;
  }
  trial::MoveOutcome not_run = trial::move_not_run();
  not_run.bands.front().settling_time = 0.01;
  EXPECT_FALSE(meets_limit("oscillation_amplitude", not_run));
}

TEST(MissingValues, AreAnEventOnlyIfSomethingNeverHappened) {
  const study::Study study = study_with_limit("tolerance_settling_time[1.0e-6]");
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    const std::string& name = measure.field.column.name;
    if (!std::isnan(layout::value_of(measure.field, settled_move())) ||
        !layout::is_in_file(measure, study.features))
      continue;
    const bool smaller_is_worse = name == "zero_fraction";
    const bool never_came = !nothing_to_measure.contains(name);
    for (const double limit : {0.0, 0.5, 1.0e+6}) {
      EXPECT_EQ(happens(parse_event(study, fmt::format("{} > {}", name, limit)), settled_move()),
                never_came && !smaller_is_worse)
          << name;
      EXPECT_EQ(happens(parse_event(study, fmt::format("{} < {}", name, limit)), settled_move()),
                never_came && smaller_is_worse)
          << name;
    }
  }
}

TEST(MissingValues, AMoveWithoutAValueDoesNotHideTheValuesOfOtherMoves) {
  const layout::MeasureTable& table = layout::measure_table();
  for (const layout::Measure& measure : table) {
    if (measure.field.column.name != "following_error_peak") continue;
    std::vector<trial::MoveOutcome> moves(3, settled_move());
    EXPECT_TRUE(std::isnan(value_of_trial(measure, moves)));
    moves[1].following_error_peak = 7.0;
    EXPECT_EQ(value_of_trial(measure, moves), 7.0);
    moves[2].outcome = trial::Outcome::nonfinite;
    EXPECT_TRUE(std::isnan(value_of_trial(measure, moves)));
  }
}

TEST(MissingValues, ALimitOnOscillationIsMetByMovesThatDoNotOscillate) {
  const study::Study without = study_with("goal: {band: 1, within: 0.2, moves: 0.9}\n");
  const study::Study limited = study_with(
      "goal: {band: 1, within: 0.2, moves: 0.9, limits: {oscillation_amplitude: 5, oscillation_period: "
      "1}}\n");
  std::int64_t met = 0;
  for (std::int64_t index = 0; index < without.trials; ++index) {
    for (const trial::MoveOutcome& move :
         trial::run_trial(study::study_trial(limited, 0, index).parameters).moves) {
      const bool settled = meets(criteria_of_goals(without).front(), move);
      EXPECT_EQ(meets(criteria_of_goals(limited).front(), move), settled) << index;
      met += settled;
    }
  }
  EXPECT_GT(met, 10);
}

}  // namespace
}  // namespace zerocount::measures
