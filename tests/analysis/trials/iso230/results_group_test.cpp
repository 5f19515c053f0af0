#include "analysis/trials/iso230/results_group.hpp"

#include <nlohmann/json.hpp>

#include "analysis/basis/statistics/sums/histogram.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "analysis/trials/iso230/repeatability.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/analysis/trials/iso230/sequence_studies.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::iso230 {
namespace {

/// Whether two numbers are equal; NaN is equal to NaN.
bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(ValueStatistics, EqualThoseOfAHistogram) {
  std::mt19937_64 random(3);
  for (const std::size_t n : {1U, 2U, 5U, 6U, 40U, 73U, 74U, 500U}) {
    std::vector<double> values(n);
    statistics::Histogram<double> histogram;
    for (double& value : values) {
      value = 0.25 * static_cast<double>(random() % 64) - 3.0;
      histogram.add(value);
    }
    const ValueStatistics result = statistics_of(values);
    EXPECT_EQ(result.n, std::ssize(values));
    EXPECT_DOUBLE_EQ(result.mean, statistics::mean(histogram));
    EXPECT_EQ(result.max, statistics::largest(histogram));
    for (const auto& [actual, expected] : {std::pair{result.median, statistics::quantile(histogram, 0.5)},
                                           {result.p95, statistics::quantile(histogram, 0.95)}}) {
      EXPECT_EQ(actual.value, expected.value);
      EXPECT_TRUE(same(actual.low, expected.low));
      EXPECT_TRUE(same(actual.high, expected.high));
    }
  }
}

TEST(ValueStatistics, BoundsHaveTheRequestedConfidence) {
  std::vector<double> values;
  statistics::Histogram<double> histogram;
  for (int i = 0; i < 90; ++i) {
    values.push_back(i * i % 97);
    histogram.add(values.back());
  }
  const ValueStatistics result = statistics_of(values, 0.5);
  EXPECT_EQ(result.median.low, statistics::quantile(histogram, 0.5, 0.5).low);
  EXPECT_EQ(result.p95.high, statistics::quantile(histogram, 0.95, 0.5).high);
  EXPECT_GT(result.median.low, statistics_of(values).median.low);
}

TEST(ValueStatistics, UndefinedValuesAreLeftOut) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const ValueStatistics result = statistics_of({none, 3.0, none, 1.0, 2.0});
  EXPECT_EQ(result.n, 3);
  EXPECT_EQ(result.mean, 2.0);
  EXPECT_EQ(result.median.value, 2.0);
  const ValueStatistics empty = statistics_of({none});
  EXPECT_EQ(empty.n, 0);
  for (const ValueStatisticField& field : value_statistic_fields())
    EXPECT_TRUE(std::isnan(field.value(empty))) << field.name;
}

TEST(ValueStatistics, DoNotDependOnTheOrderOfTheTrials) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(1e-6, 1e-7);
  std::vector<double> values(999);
  std::generate(values.begin(), values.end(), [&] { return normal(random); });
  const double mean_before = statistics_of(values).mean;
  for (int i = 0; i < 20; ++i) {
    std::shuffle(values.begin(), values.end(), random);
    EXPECT_EQ(statistics_of(values).mean, mean_before);
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The lines that begin with `label`, each as its words.
std::vector<std::vector<std::string>> rows_of(const std::string& text, const std::string& label) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : lines_of(text)) {
    if (line.rfind(label + " ", 0) != 0) continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

/// The summary of trials that end `offset` counts from the middle of their target's count.
template <typename Offset>
summary::StudySummary summary_of(const study::Study& study, const Offset& offset) {
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (shards::TrialResult& result : results) {
    const trial::TrialParameters p =
        study::study_trial(study, result.row / study.trials, result.row % study.trials).parameters;
    for (std::size_t i = 0; i < study.sequence.size(); ++i) {
      const double counts = offset(study.sequence[i], result.row);
      const double place = static_cast<double>(p.command.targets[i]) + 0.5 + counts;
      trial::MoveOutcome& move = result.outcome.moves[i];
      move.final_position = (place - p.initial.encoder_phase) * 2.0 * std::numbers::pi / p.encoder.fine;
      move.final_error = -static_cast<std::int64_t>(std::floor(0.5 + counts));
    }
  }
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  return summary::summarise(reading::AllTrialsFile(folder / "study.h5"));
}

/// Offset of the end of a move, counts: every approach from above ends one count higher than from below.
double one_count_of_reversal(const study::SequenceMove& move, std::int64_t) {
  return move.direction > 0 ? 0.0 : 1.0;
}

TEST(RepeatabilitySummary, HasTheAxisInArcsecAndCounts) {
  const std::string text =
      testing::summary_text(summary_of(testing::sequence_study(), one_count_of_reversal));
  EXPECT_TRUE(
      says(text, "\nrepeatability after ISO 230-2: 3 targets approached from both sides in 3 cycles:\n"));
  const auto rows = rows_of(text, "fine");
  ASSERT_EQ(rows.size(),
            1U + 1U + 2U + 6U);  // the usual table, what is shown of all axes, the axis, three targets
  // A count is 0.8 arcsec: point, from, (unit), trials, then B, R↑, R↓, R, E, M, A as median (p95).
  const std::vector<std::string> truly(rows[2].begin() + 3, rows[2].begin() + 6);
  EXPECT_EQ(truly, (std::vector<std::string>{"80", "0.8", "(0.8)"}));
  EXPECT_EQ(rows[2][2], "(arcsec)");
  const std::vector<std::string> encoder(rows[3].begin() + 1, rows[3].begin() + 6);
  EXPECT_EQ(encoder, (std::vector<std::string>{"encoder", "(count)", "80", "1", "(1)"}));
}

TEST(RepeatabilitySummary, AOneSidedSequenceHasOnlyUnidirectionalValues) {
  const study::Study study = testing::sequence_study("cycles: 2, approach: negative");
  const std::string text = testing::summary_text(summary_of(study, one_count_of_reversal));
  EXPECT_TRUE(says(text, "3 targets approached from above in 2 cycles:\n"));
  const auto heads = rows_of(text, "point");
  ASSERT_EQ(heads.size(), 4U) << text;
  EXPECT_EQ(heads[3], (std::vector<std::string>{"point", "target", "from", "x̄↓", "R↓"}));
  EXPECT_NE(text.find("at most 3.7 % of axes do not"),  // 1 − 0.05^(1/80) = 0.0368
            std::string::npos)
      << text;
}

// Where R is not defined, no trial has it, and none has it at 0 either: that is not 0 trials of 80.
TEST(RepeatabilitySummary, ASingleCycleHasNoCountOfZeroRepeatability) {
  const nlohmann::ordered_json json =
      testing::summary_json(summary_of(testing::sequence_study("cycles: 1"), one_count_of_reversal));
  const nlohmann::ordered_json& point = json["points"][0]["repeatability"];
  EXPECT_EQ(point["trials"], 80);
  for (const char* name : {"zero_repeatability", "zero_repeatability_rate"})
    EXPECT_TRUE(point.at(name).is_null()) << name;
}

TEST(RepeatabilitySummary, DeviationsOfManyCountsAreShownInFull) {
  const auto far = [](const study::SequenceMove& move, std::int64_t row) {
    return move.target == 2 ? 12345.0 : static_cast<double>(row % 2) * 0.0;
  };
  const std::string text = testing::summary_text(summary_of(testing::sequence_study(), far));
  EXPECT_EQ(rows_of(text, "fine")[9][4], "12345");
}

TEST(RepeatabilitySummary, IsASectionOfTheJson) {
  const nlohmann::ordered_json json =
      testing::summary_json(summary_of(testing::sequence_study(), one_count_of_reversal));
  const auto& point = json["points"][0]["repeatability"];
  EXPECT_TRUE(point["trials"].is_number_integer());
  EXPECT_EQ(point["evaluated"], 80);
  EXPECT_EQ(point["zero_repeatability"], 0);
  EXPECT_EQ(point["true"]["unit"], "rad");
  EXPECT_NEAR(point["true"]["axis"]["reversal"]["median"].get<double>(), 2.0 * std::numbers::pi / 1620000.0,
              1e-15);
  EXPECT_EQ(point["encoder"]["axis"]["mean_reversal"]["max"], -1.0);
  EXPECT_EQ(point["encoder"]["targets"][2]["reversal"]["p95"], -1.0);
}

/// The summary of a study with two masses whose moves end with the motor `motor` counts and the load `load`
/// counts from the middle of the target's count.
/// @param closing mass whose encoder closes the loop
summary::StudySummary summary_of_masses(const std::string& closing, double motor, double load) {
  const study::Study study = testing::sequence_study(
      "cycles: 3", 20, "plant: {load: {inertia: 1.0e-4, encoder: " + closing + "}}\n");
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (shards::TrialResult& result : results) {
    const trial::TrialParameters p =
        study::study_trial(study, result.row / study.trials, result.row % study.trials).parameters;
    for (std::size_t i = 0; i < study.sequence.size(); ++i) {
      const double side =
          study.sequence[i].direction > 0 ? 0.5 : -0.5;  // reversal of one for an offset of one
      const double place = static_cast<double>(p.command.targets[i]) + 0.5 + side * motor;
      trial::MoveOutcome& move = result.outcome.moves[i];
      move.final_position = (place - p.initial.encoder_phase) * 2.0 * std::numbers::pi / p.encoder.fine;
      move.true_error = -side * (closing == "load" ? load : motor);
      move.other_true_error = closing == "load" ? statistics::unknown : -side * load;
    }
  }
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  return summary::summarise(reading::AllTrialsFile(folder / "study.h5"));
}

TEST(RepeatabilitySummary, HasTheValuesOfBothMassesAndNamesEach) {
  constexpr double arcsec = 360.0 * 3600.0 / 1620000.0;  // of a count
  for (const bool load_closes : {false, true}) {
    const summary::StudySummary summary = summary_of_masses(load_closes ? "load" : "motor", 3.0, 250.0);
    const nlohmann::ordered_json json = testing::summary_json(summary);
    const auto& point = json["points"][0]["repeatability"];
    const auto& closing = point["true"];
    const auto& other = point[load_closes ? "motor_true" : "load_true"];
    const auto& motor = load_closes ? other : closing;
    const auto& load = load_closes ? closing : other;
    EXPECT_EQ(motor["of"], "motor");
    EXPECT_EQ(load["of"], "load");
    EXPECT_EQ(point["encoder"]["of"], closing["of"]);
    constexpr double count = 2.0 * std::numbers::pi / 1620000.0;
    EXPECT_NEAR(motor["axis"]["reversal"]["median"].get<double>(), 3.0 * count, 1e-9 * count);
    EXPECT_NEAR(load["axis"]["reversal"]["median"].get<double>(), 250.0 * count, 1e-6 * count);
    EXPECT_FALSE(point.contains(load_closes ? "load_true" : "motor_true"));
    const std::string text = testing::summary_text(summary);
    EXPECT_TRUE(says(text, "true, motor (arcsec)", "true, load (arcsec)",
                     load_closes ? "encoder, load (count)" : "encoder, motor (count)"))
        << text;
    EXPECT_TRUE(says(text, fmt::format("{:.3g} ({:.3g})", 3.0 * arcsec, 3.0 * arcsec),
                     fmt::format("{:.3g} ({:.3g})", 250.0 * arcsec, 250.0 * arcsec)))
        << text;
    // Without a goal the headline speaks of zero counts, and of whose.
    EXPECT_TRUE(says(text.substr(0, text.find('\n')),
                     load_closes ? "zero counts of the load" : "zero counts of the motor"))
        << text;
  }
}

/// Everything that the independent Python check gets to know about the study; the results are not included.
nlohmann::json facts_of(const study::Study& study) {
  nlohmann::json facts{{"points", study::point_count(study)}, {"trials", study.trials}};
  for (const study::SequenceMove& move : study.sequence)
    facts["sequence"].push_back({move.target, move.direction});
  for (std::int64_t row = 0; row < study::trial_count(study); ++row) {
    const trial::TrialParameters p =
        study::study_trial(study, row / study.trials, row % study.trials).parameters;
    facts["rows"].push_back({{"targets", p.command.targets},
                             {"phase", p.initial.encoder_phase},
                             {"resolution", 2.0 * std::numbers::pi / p.encoder.fine}});
  }
  return facts;
}

/// Lets an independent Python check judge the group /repeatability, the summary and the documentation of a
/// file.
void expect_judged_right(const study::Study& study, const std::vector<shards::TrialResult>& results) {
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  const summary::StudySummary summary = summary::summarise(reading::AllTrialsFile(folder / "study.h5"));
  folder.write("facts.json", facts_of(study).dump());
  folder.write("summary.json", testing::summary_json(summary).dump());
  folder.write("summary.csv", testing::summary_csv(summary));
  const std::string command =
      fmt::format("{} {} file {} {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_REPEATABILITY_JUDGE,
                  folder.path().string(), ZEROCOUNT_FORMAT_DOCUMENTATION, (folder / "output").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("output");
}

TEST(RepeatabilityFile, AgreesWithAPythonJudgeOfTheWholeFile) {
  const study::Study study = testing::sequence_study("cycles: 3", 40);
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  results[5].outcome.moves[9].outcome = trial::Outcome::nonfinite;
  results[5].outcome.moves[9].final_position = std::numeric_limits<double>::quiet_NaN();
  results[8].outcome.moves[0].outcome = trial::Outcome::nonfinite;  // a move that only goes to the other side
  results[11].outcome.moves[4].outcome = trial::Outcome::oscillating;
  expect_judged_right(study, results);
}

TEST(RepeatabilityFile, AOneSidedSequenceAgreesWithThePythonJudge) {
  for (const char* approach : {"positive", "negative"}) {
    const study::Study study = testing::sequence_study(fmt::format("cycles: 3, approach: {}", approach), 30);
    expect_judged_right(study, testing::sequence_results(study));
  }
}

TEST(RepeatabilityFile, OneCycleAndOneTrialAgreeWithThePythonJudge) {
  const study::Study one_cycle = testing::sequence_study("cycles: 1", 30);
  expect_judged_right(one_cycle, testing::sequence_results(one_cycle));
  const study::Study one_trial = testing::sequence_study("cycles: 2", 1);
  expect_judged_right(one_trial, testing::sequence_results(one_trial));
}

TEST(RepeatabilityFile, CountsTrialsWithZeroRepeatabilityOfTheEncoder) {
  const study::Study study = testing::sequence_study("cycles: 3", 60);
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (std::size_t row = 60; row < 120; ++row) {
    for (trial::MoveOutcome& move : results[row].outcome.moves) move.final_error = 0;
  }
  // Everywhere one count beside the target is as repeatable as on it; one move beside it is not.
  for (trial::MoveOutcome& move : results[7].outcome.moves) --move.final_error;
  results[61].outcome.moves[3].final_error = 1;
  // Beyond the ends nothing is measured.
  results[62].outcome.moves[0].final_error = 99;
  // What was lost did not repeat.
  results[63].outcome.moves[3].outcome = trial::Outcome::nonfinite;
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  const auto points = study_repeatability(reading::AllTrialsFile(folder / "study.h5"), study).points;
  EXPECT_EQ(points[0].zero_repeatability, 9);  // trials 0, 7, … 56
  EXPECT_EQ(points[0].evaluated, 60);
  EXPECT_EQ(points[1].zero_repeatability, 58);
  EXPECT_EQ(points[1].evaluated, 59);
  EXPECT_DOUBLE_EQ(points[1].zero_rate, 58.0 / 60.0);
  EXPECT_DOUBLE_EQ(points[1].zero_bounds.high, statistics::clopper_pearson(58, 60).high);
}

// All trials of one of six machines repeat exactly, those of the others do not: one event of six, not ten
// of 60.
TEST(RepeatabilityFile, TrialsOfOneMachineCountAsOneEventInTheBounds) {
  const study::Study study = testing::sequence_study("cycles: 3", 60, "machines: 6\n");
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (std::size_t row = 0; row < 60; ++row)
    for (trial::MoveOutcome& move : results[row].outcome.moves)
      move.final_error =
          row % 6 == 0 ? 0 : static_cast<std::int64_t>(&move - results[row].outcome.moves.data());
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  const PointRepeatability point =
      study_repeatability(reading::AllTrialsFile(folder / "study.h5"), study).points[0];
  EXPECT_EQ(point.zero_repeatability, 10);
  EXPECT_GT(point.zero_bounds.high, statistics::clopper_pearson(1, 6).high - 0.02);
}

TEST(RepeatabilityFile, WithoutAnyUsableTrialOnlyCountsRemain) {
  const study::Study study = testing::sequence_study("cycles: 2", 4);
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (shards::TrialResult& result : results) result.outcome.moves[1].outcome = trial::Outcome::nonfinite;
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  const PointRepeatability point =
      study_repeatability(reading::AllTrialsFile(folder / "study.h5"), study).points[0];
  EXPECT_EQ(point.trials, 4);
  EXPECT_EQ(point.evaluated, 0);
  EXPECT_EQ(point.zero_rate, 0.0);
  EXPECT_EQ(point.sources[0].axis[0].n, 0);
  EXPECT_TRUE(std::isnan(point.sources[0].axis[0].median.value));
}

TEST(RepeatabilityFile, DoesNotDependOnTheBlocksInWhichTrialsAreRead) {
  // More rows than are read at once, and not a multiple: 16384/8 = 2048 rows of 8 moves.
  const study::Study study = testing::sequence_study("cycles: 1, approach: positive", 2049);
  const std::vector<shards::TrialResult> results = testing::sequence_results(study);
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  const hdf5::File file = hdf5::File::open_to_read(folder / "study.h5");
  const hdf5::Dataset values = file.open_dataset("repeatability/trial/true/systematic_positive");
  ASSERT_EQ(values.extent(), (std::vector<hdf5::Size>{4098}));
  for (const std::int64_t row : {0LL, 4095LL, 4096LL, 4097LL}) {
    const trial::TrialParameters parameters = study::study_trial(study, row / 2049, row % 2049).parameters;
    double value = 0.0;
    values.read(row, 1, &value);
    const auto expected =
        trial_repeatability(study.sequence, parameters, results[static_cast<std::size_t>(row)].outcome.moves);
    EXPECT_EQ(value, expected->from_position.axis.systematic_positive) << row;
  }
}

TEST(RepeatabilityFile, IsExportedAsCsv) {
  const study::Study study = testing::sequence_study("cycles: 2", 3);
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, testing::sequence_results(study));
  const reading::AllTrialsFile file(folder / "study.h5");
  const auto paths = reading::export_csv(file, folder / "csv", repeatability_exports(file));
  ASSERT_EQ(paths.size(), 8U);
  const std::vector<std::string> trials = lines_of(folder.read("csv/repeatability_trials.csv"));
  ASSERT_EQ(trials.size(), 7U);
  EXPECT_EQ(trials[0].rfind("trial,evaluated,true_reversal [rad],true_mean_reversal [rad],", 0), 0U);
  EXPECT_EQ(trials[6].rfind("5,1,", 0), 0U);
  const std::vector<std::string> targets = lines_of(folder.read("csv/repeatability_trial_targets.csv"));
  ASSERT_EQ(targets.size(), 1U + 6U * 3U);
  EXPECT_EQ(targets[0].rfind("trial,target,position [count],true_mean_positive [rad],", 0), 0U);
  double value = 0.0;
  hdf5::File::open_to_read(folder / "study.h5")
      .open_dataset("repeatability/trial/true/reversal")
      .read(4, 1, &value);
  EXPECT_EQ(trials[5].rfind("4,1," + reading::number_text(value) + ",", 0), 0U) << trials[5];
  EXPECT_EQ(targets[1 + 3 * 4 + 2].rfind("4,2,700,", 0), 0U);
  EXPECT_EQ(lines_of(folder.read("csv/repeatability_points.csv")).size(), 3U);
  EXPECT_EQ(lines_of(folder.read("csv/repeatability_point_targets.csv")).size(), 7U);
}

TEST(RepeatabilityFile, AStudyWithoutASequenceHasNoRepeatability) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: plain\nseed: 1\ntrials: 3\ncommand: {targets: [1, 2], hold: 0.1}\n", "test");
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, testing::sequence_results(study));
  EXPECT_FALSE(hdf5::File::open_to_read(folder / "study.h5").contains("repeatability"));
  EXPECT_FALSE(summary::summarise(reading::AllTrialsFile(folder / "study.h5")).repeatability);
  EXPECT_TRUE(repeatability_exports(reading::AllTrialsFile(folder / "study.h5")).empty());
}

TEST(RepeatabilityFile, AFileOfAnotherSequenceIsRefused) {
  const study::Study study = testing::sequence_study("cycles: 2", 4);
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, testing::sequence_results(study));
  const reading::AllTrialsFile file(folder / "study.h5");
  const auto expect_bad = [&](const study::Study& other, const std::string& words) {
    EXPECT_TRUE(says(refusal_by([&] { study_repeatability(file, other); }, ExitCode::bad_data), words));
  };
  expect_bad(testing::sequence_study("cycles: 2", 5), "it does not hold all trials of the study");
  study::Study fewer = study;
  for (study::SequenceMove& move : fewer.sequence) move.target = std::min<std::int64_t>(move.target, 1);
  expect_bad(fewer, "it has another number of targets");
}

}  // namespace
}  // namespace zerocount::iso230
