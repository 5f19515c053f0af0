#include "results/layout/measure_table.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/sensitivity/sensitivity.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/fields.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::measures {
namespace {

constexpr layout::ValidValues any_reserve{.expected = "a finite torque", .low = -1e9, .high = 1e9};

double torque_reserve(const trial::MoveOutcome& move) {
  return move.peak_torque - std::abs(move.holding_torque);
}

/// The table of measures with one more measure, which is described by a single row.
layout::MeasureTable with_torque_reserve(const layout::ValidValues& valid = any_reserve) {
  using enum layout::Statistic;
  layout::MeasureTable table = layout::measure_table();
  table.push_back({.field = layout::field<trial::MoveOutcome>(
                       "torque_reserve", "N m", "peak torque less holding torque", &torque_reserve, valid),
                   .reduction = layout::MoveReduction::largest,
                   .point = {"torque_reserve",
                             {{{n}, "moves, of which the reserves are"},
                              {{mean}, "mean torque reserve"},
                              {{median_low, median}, "{0} of the torque reserve"}}},
                   .level = {"torque_reserve", {{{student_low}, "{0} torque reserve"}}},
                   .summary = {.columns = {{"reserve (N m)", mean}}, .legend = "reserve: of the torque\n"},
                   .output = {{"torque_reserve", "largest torque reserve"}},
                   .gate = {{"torque_reserve", layout::Worse::less, 0.001, 0.0}}});
  return table;
}

/// A results file of one design point that has one more measure than the program's table.
class AddedMeasure : public ::testing::Test {
 protected:
  AddedMeasure() {
    for (std::int64_t row = 0; row < study.trials; ++row) trials.push_back(testing::random_trial(row, 2));
    testing::write_study_file(
        path, study, trials,
        [&](const reading::AllTrialsFile& file) {
          const std::vector<PointSummary> points = summary::study_statistics(file, study);
          return layout::StoredStatistics{point_columns(points, {}, file.table()), {}, {}};
        },
        table);
  }

  comparison::PointTrials read_trials() const {
    return comparison::read_point_trials(reading::AllTrialsFile(path, reading::Require::complete, &table), 0,
                                         study.trials);
  }

  double mean_reserve() const {
    double sum = 0.0;
    for (const testing::TrialRecord& trial : trials)
      sum += torque_reserve(trial.outcome.moves[0]) + torque_reserve(trial.outcome.moves[1]);
    return sum / (2.0 * static_cast<double>(trials.size()));
  }

  const layout::MeasureTable table = with_torque_reserve();
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder / "study.h5";
  const study::Study study = testing::plain_study(1, 60, 2);
  std::vector<testing::TrialRecord> trials;
};

TEST_F(AddedMeasure, StandsInTheResultsFileWithItsStatistics) {
  const reading::AllTrialsFile file(path, reading::Require::complete, &table);
  const hdf5::Dataset column = file.root().open_group("outcome").open_dataset("torque_reserve");
  EXPECT_EQ(column.text("units"), "N m");
  EXPECT_EQ(column.text("long_name"), "peak torque less holding torque");
  std::vector<double> values(120);
  column.read(0, 60, values.data());
  EXPECT_EQ(values[7], torque_reserve(trials[3].outcome.moves[1]));
  EXPECT_EQ(file.measure("torque_reserve", file.rows()), values);
  const std::vector<layout::PointColumn> statistics = file.statistics();
  const auto median = std::find_if(
      statistics.begin(), statistics.end(),
      [](const layout::PointColumn& statistic) { return statistic.name == "torque_reserve_median_low"; });
  ASSERT_NE(median, statistics.end());
  EXPECT_EQ(median->unit, "N m");
  EXPECT_EQ(median->long_name, "lower 95 % order-statistic bound of the median of the torque reserve");
}

TEST_F(AddedMeasure, IsCheckedWhenItIsRead) {
  const layout::MeasureTable strict = with_torque_reserve({.expected = "more than there is", .low = 1.0});
  EXPECT_THROW(reading::AllTrialsFile(path, reading::Require::complete, &strict).outcomes({0, 60}), Failure);
  EXPECT_NO_THROW(reading::AllTrialsFile(path, reading::Require::complete, &table).outcomes({0, 60}));
}

TEST_F(AddedMeasure, IsInEveryFormOfTheSummary) {
  summary::StudySummary summary;
  summary.name = study.name;
  summary.labels = study.points.labels;
  summary.axes = study.points.axes;
  summary.points =
      summary::study_statistics(reading::AllTrialsFile(path, reading::Require::complete, &table), study);
  const nlohmann::ordered_json json = testing::summary_json(summary)["points"][0]["torque_reserve"];
  EXPECT_EQ(json["n"], 120);
  EXPECT_NEAR(json["mean"].get<double>(), mean_reserve(), 1e-12);
  EXPECT_LE(json["median_low"].get<double>(), json["median"].get<double>());
  EXPECT_NE(testing::summary_csv(summary).find("torque_reserve_mean"), std::string::npos);
  EXPECT_NE(testing::summary_text(summary).find("reserve (N m)"), std::string::npos);
  EXPECT_NE(testing::summary_text(summary, {.legend = true}).find("reserve: of the torque"),
            std::string::npos);
}

TEST_F(AddedMeasure, IsAnOutputOfTheSensitivityAnalysis) {
  const reading::AllTrialsFile file(path, reading::Require::complete, &table);
  const sensitivity::TrialOutputs outputs = sensitivity::trial_outputs(
      file, study, 0, study.trials, sensitivity::find_sensitivity_output("torque_reserve", file.table()));
  const auto known = std::find_if(outputs.values.begin(), outputs.values.end(),
                                  [](double value) { return !std::isnan(value); });
  ASSERT_NE(known, outputs.values.end());
  const std::vector<trial::MoveOutcome>& moves =
      trials[static_cast<std::size_t>(known - outputs.values.begin())].outcome.moves;
  EXPECT_EQ(*known, std::max(torque_reserve(moves[0]), torque_reserve(moves[1])));
}

TEST_F(AddedMeasure, IsJudgedByTheGate) {
  const comparison::PointTrials before = read_trials();
  comparison::PointTrials after = before;
  for (double& reserve : after.values.at("torque_reserve")) reserve -= 0.01;
  for (const bool paired : {true, false}) {
    const std::vector<comparison::Judgement> measures =
        comparison::compare_measures({}, "", {before, after, paired});
    ASSERT_EQ(measures.back().measure, "torque_reserve");
    EXPECT_EQ(measures.back().unit, "N m");
    EXPECT_NEAR(measures.back().baseline, mean_reserve(), 1e-12);
    EXPECT_NEAR(measures.back().effect, 0.01, 1e-12) << "less is worse";
    EXPECT_LT(measures.back().p, 0.01);
    EXPECT_EQ(measures.back().margin, 0.001);
  }
}

TEST_F(AddedMeasure, TheValueOfATrialIsThatOfItsWorstMove) {
  const comparison::PointTrials read = read_trials();
  const std::vector<double> worst = comparison::worst_of_moves(read, comparison::gate_measures(table).back());
  ASSERT_EQ(worst.size(), trials.size());
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const std::vector<trial::MoveOutcome>& moves = trials[i].outcome.moves;
    EXPECT_EQ(worst[i], std::min(torque_reserve(moves[0]), torque_reserve(moves[1])));
  }
}

TEST(AddedQuality, IsJudgedByTheTrialsThatHaveItAndMoreIsWorse) {
  layout::MeasureTable table = layout::measure_table();
  for (layout::Measure& measure : table) {
    if (measure.field.column.name == "broke_away")
      measure.gate = {"breakaway_rate", layout::Worse::more, 0.02, 0.0};
  }
  std::vector<trial::MoveOutcome> moves(100);
  const comparison::PointTrials before = comparison::gather_trials(moves, 1, {}, table);
  for (std::size_t i = 0; i < 30; ++i) moves[i].broke_away = true;
  const comparison::PointTrials after = comparison::gather_trials(moves, 1, {}, table);
  for (const bool paired : {true, false}) {
    const std::vector<comparison::Judgement> measures =
        comparison::compare_measures({}, "", {before, after, paired});
    const auto found = std::find_if(measures.begin(), measures.end(), [](const comparison::Judgement& one) {
      return one.measure == "breakaway_rate";
    });
    ASSERT_NE(found, measures.end());
    EXPECT_EQ(found->baseline, 0.0);
    EXPECT_EQ(found->current, 0.3);
    EXPECT_NEAR(found->effect, 0.3, 1e-15);
    EXPECT_LT(found->p, 1e-6);
  }
}

TEST(MeasureTable, NamesAreUnique) {
  std::set<std::string> names;
  for (const layout::Measure& measure : layout::measure_table())
    EXPECT_TRUE(names.insert(measure.field.column.name).second) << measure.field.column.name;
  for (const layout::ReportOrder order : {layout::ReportOrder::statistics, layout::ReportOrder::levels,
                                          layout::ReportOrder::summary, layout::ReportOrder::outputs}) {
    const std::vector<const layout::Measure*> ordered =
        layout::measures_of(layout::measure_table(), order, [](const layout::Measure&) { return true; });
    EXPECT_EQ(std::set<const layout::Measure*>(ordered.begin(), ordered.end()).size(), names.size());
    EXPECT_EQ(ordered.size(), names.size());
  }
}

}  // namespace
}  // namespace zerocount::measures
