#include "analysis/trials/summary/study_statistics.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::summary {
namespace {

std::vector<testing::TrialRecord> random_trials(const study::Study& study) {
  std::vector<testing::TrialRecord> trials;
  for (std::int64_t row = 0; row < study::trial_count(study); ++row)
    trials.push_back(testing::random_trial(row, study.moves));
  return trials;
}

/// Every number of the statistics of a study as text: equal texts mean equal statistics.
std::string text_of(const study::Study& study, const std::vector<measures::PointSummary>& points) {
  StudySummary summary;
  summary.name = study.name;
  summary.labels = study.points.labels;
  summary.axes = study.points.axes;
  summary.points = points;
  nlohmann::ordered_json json = testing::summary_json(summary);
  for (auto& point : json["points"]) point.erase("undecided");  // is found out with the study
  return json.dump();
}

void expect_refused(const study::Study& study, const std::vector<testing::TrialRecord>& trials,
                    const std::string& place) {
  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, trials);
  const reading::AllTrialsFile file(folder / "study.h5");
  try {
    study_statistics(file, study);
    FAIL() << "expected a failure that names " << place;
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    EXPECT_NE(std::string(failure.what()).find("study.h5"), std::string::npos) << failure.what();
    EXPECT_NE(std::string(failure.what()).find(place), std::string::npos) << failure.what();
  }
}

TEST(StudyStatistics, FromAFileEqualThoseOfItsTrials) {
  // More trials and more jerks than are read at once, and points that do not end where a block does.
  const study::Study study = testing::plain_study(5, 1700, 2);
  const std::vector<testing::TrialRecord> trials = random_trials(study);
  std::vector<measures::PointSummary> expected;
  std::size_t jerks = 0;
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    measures::PointAccumulator accumulator;
    for (std::int64_t index = 0; index < study.trials; ++index) {
      const testing::TrialRecord& trial = trials[static_cast<std::size_t>(point * study.trials + index)];
      accumulator.add(trial.outcome, trial.jerks);
      jerks += trial.jerks.size();
    }
    expected.push_back(accumulator.statistics());
  }
  ASSERT_GT(jerks, 65536U);

  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, trials);
  EXPECT_EQ(text_of(study, study_statistics(reading::AllTrialsFile(folder / "study.h5"), study)),
            text_of(study, expected));
}

// A chunk of the file is decoded once for several ranges. Single measures are read without it.
TEST(AllTrialsFile, SmallRangesHaveTheOutcomesOfTheirTrials) {
  const study::Study study = testing::plain_study(3, 300, 64);  // 4 chunks of 256 trials
  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, random_trials(study));
  const reading::AllTrialsFile file(folder / "study.h5");
  std::mt19937 random(12);
  for (int i = 0; i < 200; ++i) {
    const auto count = std::uniform_int_distribution<std::int64_t>(1, i % 4 == 0 ? 300 : 5)(random);
    const auto first = std::uniform_int_distribution<std::int64_t>(0, 900 - count)(random);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes({first, count});
    const std::vector<double> counts = file.measure("jerk_count", {first, count});
    ASSERT_EQ(outcomes.size(), counts.size());
    for (std::size_t move = 0; move < counts.size(); ++move)
      ASSERT_EQ(static_cast<double>(outcomes[move].jerk_count), counts[move]) << first << " " << count;
  }
}

TEST(StudyStatistics, FromAFileAgreeWithNumPyAndSciPy) {
  const study::Study study = testing::plain_study(3, 400, 2);
  const testing::TemporaryFolder folder;
  testing::write_study_file(
      folder / "study.h5", study, random_trials(study), [&](const reading::AllTrialsFile& file) {
        return layout::StoredStatistics{measures::point_columns(study_statistics(file, study)), {}, {}};
      });
  const std::string command =
      fmt::format("{} {} loop {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "study.h5").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), "3 points\n");
}

TEST(StudyStatistics, EachPointHasExactlyItsTrials) {
  const study::Study study = testing::plain_study(7, 3, 1);
  std::vector<testing::TrialRecord> trials(21);
  for (std::int64_t row = 0; row < 21; ++row) {
    trial::MoveOutcome move;
    move.outcome = row / 3 == 4 ? trial::Outcome::zero_count : trial::Outcome::oscillating;
    trials[static_cast<std::size_t>(row)].outcome.moves = {move};
  }
  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, trials);
  const std::vector<measures::PointSummary> points =
      study_statistics(reading::AllTrialsFile(folder / "study.h5"), study);
  ASSERT_EQ(points.size(), 7U);
  for (std::size_t point = 0; point < 7; ++point) {
    EXPECT_EQ(points[point].trials, 3);
    EXPECT_EQ(points[point].outcomes.zero_count, point == 4 ? 3 : 0);
  }
}

TEST(StudyStatistics, AContradictoryTrialIsRefusedByNumber) {
  const study::Study study = testing::plain_study(2, 10, 1);
  std::vector<testing::TrialRecord> trials = random_trials(study);
  for (testing::TrialRecord& trial : trials) {
    trial.jerks.clear();
    trial.outcome.moves[0].jerk_count = 0;
  }
  const trial::Jerk jerk{0, 0.5, 0.01, 1, 1};

  std::vector<testing::TrialRecord> missing = trials;
  missing[13].outcome.moves[0].jerk_count = 1;
  expect_refused(study, missing, "trial 13");

  std::vector<testing::TrialRecord> shifted = missing;
  shifted[14].jerks = {jerk};
  expect_refused(study, shifted, "trial 13");

  std::vector<testing::TrialRecord> left_over = trials;
  left_over[19].jerks = {jerk};
  expect_refused(study, left_over, "beyond those");

  std::vector<testing::TrialRecord> unordered = trials;
  unordered[5].outcome.moves[0].jerk_count = 2;
  unordered[5].jerks = {jerk, jerk};
  expect_refused(study, unordered, "trial 5");
}

study::Study two_gains() {
  return manifest::parse_study(
      "zerocount: 1\n"
      "name: two gains\n"
      "seed: 5\n"
      "trials: 30\n"
      "command: {targets: [10], hold: 0.2}\n"
      "friction: {k1: {choice: [100, 120]}}\n"
      "sweep: {cases: {low: {controller.ki: 3.85e-5}, high: {controller.ki: 4.0e-4}}}\n"
      "observed: {low: stable in all tests}\n",
      "test");
}

TEST(Summarise, AddsNameLabelsAndAxesFromTheManifest) {
  const study::Study study = two_gains();
  const std::vector<testing::TrialRecord> trials = random_trials(study);
  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, trials,
                            measures::prediction_columns(theory::study_predictions(study)));
  const reading::AllTrialsFile file(folder / "study.h5");
  const StudySummary summary = summarise(file);

  EXPECT_EQ(summary.name, "two gains");
  EXPECT_EQ(summary.labels, study.points.labels);
  EXPECT_EQ(text_of(study, summary.points), text_of(study, study_statistics(file, study)));
  EXPECT_EQ(observed_at(summary, 0), "stable in all tests");
  EXPECT_EQ(observed_at(summary, 1), "");

  // (6) at k1 = 100 is 3.50e-5, at 120 it is 4.20e-5: it holds for the proportion of trials with the stiffer
  // spring.
  ASSERT_EQ(summary.predictions.size(), 2U);
  std::int64_t stiff = 0;
  for (std::int64_t i = 0; i < study.trials; ++i) {
    stiff += study::study_trial(study, 0, i).parameters.friction.uniform.k1 == 120.0;
  }
  EXPECT_GT(stiff, 0);
  EXPECT_LT(stiff, study.trials);
  EXPECT_EQ(summary.predictions[0].trials, 30);
  EXPECT_EQ(summary.predictions[0].stable, stiff);
  EXPECT_EQ(theory::verdict(summary.predictions[1]), "unstable");

  const nlohmann::ordered_json json = testing::summary_json(summary);
  EXPECT_EQ(json["points"][0]["axes"]["case"], "low");
}

TEST(Summarise, TakesPredictionsFromTheFile) {
  const study::Study study = two_gains();
  const testing::TemporaryFolder folder;
  const std::vector<layout::PointColumn> stored =
      measures::prediction_columns(std::vector<theory::PointPrediction>{{30, 7, 2}, {30, 0, 30}});
  testing::write_study_file(folder / "stored.h5", study, random_trials(study), stored);
  const StudySummary summary = summarise(reading::AllTrialsFile(folder / "stored.h5"));
  EXPECT_EQ(summary.predictions[0].stable, 7);
  EXPECT_EQ(summary.predictions[0].unstable, 2);
  EXPECT_EQ(summary.predictions[1].unstable, 30);
}

TEST(Summarise, RefusesAFileWhoseManifestHasAnotherNumberOfMoves) {
  study::Study study = two_gains();
  ++study.moves;
  const testing::TemporaryFolder folder;
  testing::write_study_file(folder / "study.h5", study, random_trials(study),
                            measures::prediction_columns(theory::study_predictions(study)));
  testing::expect_failure(ExitCode::bad_data,
                          "study.h5: damaged: its trials have 2 moves, and its manifest 1",
                          [&] { summarise(reading::AllTrialsFile(folder / "study.h5")); });
}

TEST(Summarise, RefusesAFileWithMissingOrWrongPredictions) {
  const study::Study study = two_gains();
  const testing::TemporaryFolder folder;
  const auto expect_bad = [&](const std::vector<layout::PointColumn>& columns, const std::string& words) {
    std::filesystem::remove(folder / "bad.h5");
    testing::write_study_file(folder / "bad.h5", study, random_trials(study), columns);
    try {
      summarise(reading::AllTrialsFile(folder / "bad.h5"));
      ADD_FAILURE() << "expected a failure: " << words;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_data);
      EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
    }
  };
  std::vector<layout::PointColumn> columns = measures::prediction_columns(theory::study_predictions(study));
  columns[0].values[1] = 1.5;
  expect_bad(columns, "bad.h5: damaged: /point/predicted_stable_share: 1.5 is not a proportion");
  columns.erase(columns.begin());
  expect_bad(columns, "bad.h5: damaged: /point/predicted_stable_share: the dataset is missing");
}

TEST(Predictions, PointsOutsideTheCriteriaReadBackAsNotApplicable) {
  const std::vector<theory::PointPrediction> predictions{{30, 0, 0, 30}, {30, 12, 3, 0}};
  const std::vector<layout::PointColumn> columns = measures::prediction_columns(predictions);
  EXPECT_TRUE(std::isnan(columns[0].values[0]) && std::isnan(columns[1].values[0]));
  const std::vector<theory::PointPrediction> back = measures::predictions_of(columns, 30, "file");
  EXPECT_EQ(back[0].outside, 30);
  EXPECT_EQ(theory::verdict(back[0]), "not applicable");
  EXPECT_EQ(back[1].outside, 0);
  EXPECT_EQ(back[1].stable, 12);
}

TEST(Predictions, ReadBackFromTheirColumnsExactly) {
  for (const std::int64_t trials : {1LL, 3LL, 7LL, 1000LL, 999983LL, 4000000007LL}) {
    std::vector<theory::PointPrediction> predictions;
    for (std::int64_t k = 0; k < 200; ++k) {
      const std::int64_t stable = k * 7919 * 104729 % (trials + 1);
      predictions.push_back({trials, stable, trials - stable});
    }
    const std::vector<theory::PointPrediction> back =
        measures::predictions_of(measures::prediction_columns(predictions), trials, "file");
    ASSERT_EQ(back.size(), predictions.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
      EXPECT_EQ(back[i].trials, trials);
      EXPECT_EQ(back[i].stable, predictions[i].stable);
      EXPECT_EQ(back[i].unstable, predictions[i].unstable);
    }
  }
}

}  // namespace
}  // namespace zerocount::summary
