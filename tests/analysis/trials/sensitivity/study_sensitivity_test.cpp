// From a results file to what drives its outputs. The outcomes are made up, so that it is known what does.
#include <nlohmann/json.hpp>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/sensitivity/sensitivity.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/shards/shard.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sensitivity {
namespace {

using testing::TemporaryFolder;
using Outcomes = std::function<std::vector<trial::MoveOutcome>(std::span<const double> inputs)>;

// Three factors at two points; k1, k2 and α are 1 more than uniform numbers. The hold has 200 samples.
std::string manifest(const std::string& more = "") {
  return "zerocount: 1\nname: made up\nseed: 5\ntrials: 2000\ndesign: saltelli\n"
         "friction: {k1: {uniform: [1, 2]}, k2: {uniform: [1, 2]}, alpha: {uniform: [1, 2]}}\n"
         "command: {targets: [5, 0], hold: 0.1}\n"
         "sweep: {cases: {a: {controller.ki: 1.0e-5}, b: {controller.ki: 2.0e-5}}}\n" +
         more;
}

// Columns of /trial/input in the order of the table of parameters.
constexpr std::size_t k1 = 0;
constexpr std::size_t k2 = 1;

trial::MoveOutcome move_with(bool success) {
  trial::MoveOutcome move;
  move.outcome = success ? trial::Outcome::zero_count : trial::Outcome::oscillating;
  move.arrived = success;
  if (success) {
    move.arrival = 20;
    move.arrival_time = 0.01;
  }
  return move;
}

// The second of two moves succeeds where k1 and k2 are both in their upper half; the first always does.
std::vector<trial::MoveOutcome> both_in_upper_half(std::span<const double> inputs) {
  return {move_with(true), move_with(inputs[k1] > 1.5 && inputs[k2] > 1.5)};
}

class MadeUpStudy {
 public:
  MadeUpStudy(const std::string& text, const Outcomes& outcomes) {
    const study::Study study = manifest::parse_study(text, "made-up.yaml");
    std::vector<shards::TrialResult> results(static_cast<std::size_t>(study::trial_count(study)));
    for (std::size_t row = 0; row < results.size(); ++row) {
      const auto index = static_cast<std::int64_t>(row);
      results[row].row = index;
      results[row].inputs = study::study_trial(study, index / study.trials, index % study.trials).inputs;
      results[row].outcome.moves = outcomes(results[row].inputs);
    }
    const layout::RowRange rows{0, study::trial_count(study)};
    shards::write_shard(folder_ / "shard.h5", study, {0, std::ssize(results)}, results);
    const std::vector<shards::ShardInfo> shards{{folder_ / "shard.h5", rows}};
    testing::merge_shards(shards, study, folder_ / "study.h5", rows,
                          [](const reading::AllTrialsFile&) { return layout::StoredStatistics{}; });
  }

  StudySensitivity ask(const SensitivityQuestion& question = {}) const {
    return study_sensitivity(reading::AllTrialsFile(folder_ / "study.h5"), question);
  }
  OutputSensitivity about(const std::string& output) const {
    return ask({.points = {1}, .outputs = {output}}).points.at(0).outputs.at(0);
  }

 private:
  TemporaryFolder folder_;
};

const FactorSensitivity& factor(const OutputSensitivity& output, const std::string& name) {
  const auto found = std::find_if(output.factors.begin(), output.factors.end(),
                                  [&](const FactorSensitivity& one) { return one.name == name; });
  if (found == output.factors.end()) throw std::runtime_error("no factor " + name);
  return *found;
}

bool encloses(const BoundedNumber& number, double truth) {
  return number.low <= truth && truth <= number.high;
}

// p = ¼, so V = 3/16; the mean given one factor is 0 or ½, its variance 1/16.
TEST(StudySensitivity, ASaltelliDesignGivesFirstOrderAndTotalIndices) {
  const OutputSensitivity success = MadeUpStudy(manifest(), both_in_upper_half).about("success");
  EXPECT_EQ(success.trials, 2000);
  EXPECT_NEAR(success.mean, 0.25, 0.05);
  ASSERT_TRUE(success.estimated);
  ASSERT_EQ(success.factors.size(), 3u);
  for (const char* name : {"friction.k1", "friction.k2"}) {
    const FactorSensitivity& found = factor(success, name);
    EXPECT_TRUE(encloses(found.first_order, 1.0 / 3.0)) << name;
    EXPECT_TRUE(encloses(found.total, 2.0 / 3.0)) << name;
    EXPECT_TRUE(found.matters);
    EXPECT_GT(found.rank_correlation.low, 0.0);
    EXPECT_GT(found.partial_rank_correlation.low, 0.0);
    EXPECT_GT(found.log_odds.low, 0.0);
  }
  const FactorSensitivity& idle = success.factors.back();
  EXPECT_EQ(idle.name, "friction.alpha");
  EXPECT_EQ(idle.total.value, 0.0);
  EXPECT_FALSE(idle.matters);
  EXPECT_TRUE(says(success.conclusion, "friction.alpha (at most "));
}

TEST(StudySensitivity, OtherDesignsGiveFirstOrderIndicesOnly) {
  std::string text = manifest();
  text.replace(text.find("saltelli"), 8, "monte_carlo");
  const MadeUpStudy study(text, both_in_upper_half);
  EXPECT_FALSE(study.ask().from_saltelli);
  const OutputSensitivity success = study.about("success");
  EXPECT_TRUE(encloses(factor(success, "friction.k1").first_order, 1.0 / 3.0));
  EXPECT_TRUE(std::isnan(factor(success, "friction.k1").total.value));
  EXPECT_FALSE(factor(success, "friction.alpha").matters);
}

// k1 and k2 act only together: each has a total index of 1 and explains nothing alone. A file without total
// indices cannot show that, and must not say that they have no influence.
TEST(StudySensitivity, WithoutTotalIndicesNoInfluenceIsDenied) {
  const auto either = [](std::span<const double> inputs) {
    const bool success = (inputs[k1] > 1.5) != (inputs[k2] > 1.5);
    return std::vector{move_with(success), move_with(success)};
  };
  std::string text = manifest();
  text.replace(text.find("saltelli"), 8, "monte_carlo");
  const OutputSensitivity alone = MadeUpStudy(text, either).about("success");
  EXPECT_TRUE(says(alone.conclusion, "no parameter is shown to explain 1 % or more of the variance"))
      << alone.conclusion;
  EXPECT_TRUE(says(alone.conclusion, "only together with others these trials cannot show"));
  EXPECT_FALSE(says(alone.conclusion, "no influence"));
  const OutputSensitivity both = MadeUpStudy(manifest(), either).about("success");
  EXPECT_TRUE(factor(both, "friction.k1").matters && factor(both, "friction.k2").matters);
  EXPECT_TRUE(says(both.conclusion, "need not add up to 100 %")) << both.conclusion;
}

// A factor that changes the output in every trial, but by a thousandth of its standard deviation.
TEST(StudySensitivity, ATinyIndexDoesNotCountAsInfluence) {
  const OutputSensitivity creep = MadeUpStudy(manifest(), [](std::span<const double> inputs) {
                                    trial::MoveOutcome move = move_with(true);
                                    move.creep = inputs[k2] + 0.001 * inputs[k1];
                                    return std::vector{move, move};
                                  }).about("creep");
  const FactorSensitivity& small = factor(creep, "friction.k1");
  EXPECT_GT(small.total.value, 0.0);
  EXPECT_LT(small.total.value, 1e-4);
  EXPECT_FALSE(small.matters);
  const std::string influential = creep.conclusion.substr(0, creep.conclusion.find(';'));
  EXPECT_TRUE(says(influential, "friction.k2 (100 %, at least ")) << creep.conclusion;
  EXPECT_FALSE(says(influential, "friction.k1")) << creep.conclusion;
}

/// Manifest of a study with `trials` trials on 40 machines, which differ in all three factors.
std::string manifest_of_machines(std::int64_t trials, int seed) {
  std::string text = manifest(fmt::format("machines: 40\n"));
  const auto replace = [&](const std::string& old, const std::string& now) {
    text.replace(text.find(old), old.size(), now);
  };
  replace("saltelli", "monte_carlo");
  replace("trials: 2000", fmt::format("trials: {}", trials));
  replace("seed: 5", fmt::format("seed: {}", seed));
  return text;
}

// More trials on the same machines show nothing more of what differs between machines.
TEST(StudySensitivity, UsesTheFirstTrialOfEachMachine) {
  for (const int seed : {1, 2, 3}) {
    const OutputSensitivity many =
        MadeUpStudy(manifest_of_machines(800, seed), both_in_upper_half).about("success");
    const OutputSensitivity first =
        MadeUpStudy(manifest_of_machines(40, seed), both_in_upper_half).about("success");
    EXPECT_EQ(many.trials, 40);
    EXPECT_EQ(many.mean, first.mean);
    ASSERT_EQ(many.factors.size(), first.factors.size());
    for (const FactorSensitivity& expected : first.factors) {
      const FactorSensitivity& found = factor(many, expected.name);
      for (const auto number : {&FactorSensitivity::first_order, &FactorSensitivity::rank_correlation,
                                &FactorSensitivity::partial_rank_correlation}) {
        EXPECT_EQ((found.*number).value, (expected.*number).value) << expected.name;
        EXPECT_EQ((found.*number).low, (expected.*number).low) << expected.name;
        EXPECT_EQ((found.*number).high, (expected.*number).high) << expected.name;
      }
    }
    ASSERT_FALSE(many.notes.empty());
    EXPECT_EQ(
        many.notes.front(),
        "only the first trial of each of the 40 machines is used: the others are not independent of it");
  }
}

// An output by which machines differ for another reason: taken for independent, 20 trials of every machine
// show an influence of factors that have none.
TEST(StudySensitivity, DifferencesBetweenMachinesAreNotCreditedToOtherParameters) {
  int alarms = 0;
  constexpr int studies = 25;
  for (int seed = 1; seed <= studies; ++seed) {
    const OutputSensitivity success =
        MadeUpStudy(manifest_of_machines(800, seed), [](std::span<const double> inputs) {
          return std::vector{move_with(true), move_with(inputs[k1] > 1.5)};
        }).about("success");
    alarms += factor(success, "friction.alpha").matters;
  }
  EXPECT_LE(alarms, 7);  // of 25 at 5 % for each of two tests
}

TEST(StudySensitivity, ParametersThatDoNotVaryAreLeftOutAndNamed) {
  const OutputSensitivity success = MadeUpStudy(manifest(), both_in_upper_half).about("success");
  ASSERT_EQ(success.left_out.size(), 1u);
  EXPECT_EQ(success.left_out[0].name, "controller.ki");
  EXPECT_EQ(success.left_out[0].reason, "the same in all trials of the point");
}

TEST(StudySensitivity, AMoveThatNeverArrivesCountsWithItsDuration) {
  const OutputSensitivity settling = MadeUpStudy(manifest(), both_in_upper_half).about("arrival_time");
  EXPECT_NEAR(settling.mean, 0.25 * 0.01 + 0.75 * 0.1, 0.005);
  EXPECT_TRUE(encloses(factor(settling, "friction.k2").total, 2.0 / 3.0));
  const bool said = std::any_of(settling.notes.begin(), settling.notes.end(), [](const std::string& note) {
    return note.find("have a move that never arrived; it counts with its duration") != std::string::npos;
  });
  EXPECT_TRUE(said);
}

TEST(StudySensitivity, WithoutVarianceItSaysThatNothingIsEstimated) {
  const MadeUpStudy study(manifest(), [](auto) { return std::vector{move_with(true), move_with(true)}; });
  const OutputSensitivity success = study.about("success");
  EXPECT_FALSE(success.estimated);
  EXPECT_TRUE(success.factors.empty());
  EXPECT_EQ(
      success.conclusion,
      "success is 1 in all 2000 trials: it has no variance, and nothing can be said of what influences it.");
  EXPECT_FALSE(any_estimated(study.ask()));
  EXPECT_TRUE(any_estimated(MadeUpStudy(manifest(), both_in_upper_half).ask()));
}

// In every trial with k1 in its last quarter the motion is lost: 7 of 16 rows have none of them in A, B or A
// with k1 of B.
TEST(StudySensitivity, RowsWithLostTrialsAreLeftOutWholeAndCounted) {
  const MadeUpStudy study(manifest(), [](std::span<const double> inputs) {
    trial::MoveOutcome move = move_with(true);
    move.jerk_count = 0;
    move.creep = inputs[k2];
    if (inputs[k1] > 1.75) move.outcome = trial::Outcome::nonfinite;
    return std::vector{move_with(true), move};
  });
  const OutputSensitivity creep = study.about("creep");
  EXPECT_NEAR(static_cast<double>(creep.trials), 2000.0 * 9.0 / 16.0, 150.0);
  EXPECT_EQ(creep.trials % 5, 0);
  EXPECT_NEAR(factor(creep, "friction.k2").total.value, 1.0, 0.15);
  EXPECT_EQ(factor(creep, "friction.k1").total.value, 0.0);
  ASSERT_FALSE(creep.notes.empty());
  EXPECT_EQ(
      creep.notes[0].find(std::to_string(2000 - creep.trials) + " of 2000 trials are left out, in whole"),
      0u);
  EXPECT_EQ(study.about("success").trials, 2000) << "a lost trial is no success, and counts";
}

TEST(StudySensitivity, ReportsSeparatedAndRareOutcomes) {
  const MadeUpStudy study(manifest(), [](std::span<const double> inputs) {
    return std::vector{move_with(true), move_with(inputs[k1] < 1.995)};
  });
  const OutputSensitivity success = study.about("success");
  EXPECT_TRUE(std::isnan(factor(success, "friction.k1").log_odds.value));
  std::string notes;
  for (const std::string& note : success.notes) notes += note + "\n";
  EXPECT_TRUE(says(notes, "a logistic fit has no finite coefficients",
                   "differ from the others: the bounds are rough"));
}

TEST(StudySensitivity, EveryOutputOfEveryPointCanBeAnalysed) {
  const MadeUpStudy study(manifest(), both_in_upper_half);
  SensitivityQuestion question;
  for (const SensitivityOutput& output : sensitivity_outputs()) question.outputs.emplace_back(output.name);
  const StudySensitivity all = study.ask(question);
  ASSERT_EQ(all.points.size(), 2u);
  EXPECT_EQ(all.points[1].label, "b");
  for (const PointSensitivity& point : all.points) {
    ASSERT_EQ(point.outputs.size(), sensitivity_outputs().size());
    for (const OutputSensitivity& output : point.outputs) EXPECT_FALSE(output.conclusion.empty());
  }
  const StudySensitivity usual = study.ask();
  ASSERT_EQ(usual.points[0].outputs.size(), 2u);
  EXPECT_EQ(usual.points[0].outputs[1].output, "arrival_time");
}

TEST(StudySensitivity, ALargeStudyUsesItsFirstTrials) {
  const auto text = [](int trials) {
    return fmt::format(
        "zerocount: 1\nname: made up\nseed: 5\ntrials: {}\n"
        "friction: {{k1: {{uniform: [1, 2]}}, k2: {{uniform: [1, 2]}}}}\n"
        "command: {{targets: [5, 0], hold: 0.1}}\n",
        trials);
  };
  SensitivityQuestion question;
  question.max_trials = 300;
  const OutputSensitivity of_first =
      MadeUpStudy(text(1000), both_in_upper_half).ask(question).points.at(0).outputs.at(0);
  const OutputSensitivity of_all =
      MadeUpStudy(text(300), both_in_upper_half).ask().points.at(0).outputs.at(0);
  EXPECT_EQ(of_first.trials, 300);
  EXPECT_EQ(of_first.notes.back(), "the first 300 of 1000 trials are used");
  ASSERT_EQ(of_first.factors.size(), of_all.factors.size());
  for (std::size_t j = 0; j < of_all.factors.size(); ++j) {
    EXPECT_EQ(of_first.factors[j].rank_correlation.value, of_all.factors[j].rank_correlation.value);
    EXPECT_EQ(of_first.factors[j].first_order.high, of_all.factors[j].first_order.high);
  }
  question.max_trials = 100;
  EXPECT_EQ(MadeUpStudy(manifest(), both_in_upper_half).ask(question).points.at(0).outputs.at(0).trials, 2000)
      << "a saltelli design is used whole";
}

TEST(StudySensitivity, MeaninglessQuestionsAreRefused) {
  const MadeUpStudy study(manifest(), both_in_upper_half);
  for (const SensitivityQuestion& question :
       {SensitivityQuestion{.points = {2}}, SensitivityQuestion{.points = {-1}},
        SensitivityQuestion{.outputs = {"sucess"}}, SensitivityQuestion{.confidence = 1.0},
        SensitivityQuestion{.confidence = 0.0}, SensitivityQuestion{.confidence = std::nan("")}}) {
    EXPECT_NE(refusal_by([&] { study.ask(question); }), "");
  }
}

nlohmann::ordered_json json_of(const StudySensitivity& found) {
  return document::json(sensitivity_answer().of(found));
}

TEST(StudySensitivity, DoesNotDependOnTheNumberOfThreads) {
  for (const char* design : {"", "design: monte_carlo\n"}) {
    std::string text = manifest();
    if (*design != '\0') text.replace(text.find("design: saltelli\n"), 17, design);
    const MadeUpStudy study(text, both_in_upper_half);
    const auto many = json_of(study.ask());
    const parallel::ThreadLimit one(1);
    EXPECT_EQ(json_of(study.ask()), many);
  }
}

TEST(StudySensitivity, AnswerHasTheNumbersOfEachFactor) {
  const MadeUpStudy study(manifest(), both_in_upper_half);
  const StudySensitivity found = study.ask();
  const document::Answer answer = sensitivity_answer().of(found);
  const auto json = document::json(answer);
  EXPECT_EQ(json, json_of(study.ask())) << "the same every time";
  const auto& first = json["points"][0]["outputs"][0]["factors"][0];
  const FactorSensitivity& strongest = found.points[0].outputs[0].factors[0];
  EXPECT_EQ(first["name"], strongest.name);
  EXPECT_EQ(first["total"].get<double>(), strongest.total.value);
  EXPECT_EQ(first["total_low"].get<double>(), strongest.total.low);
  const auto& settling = json["points"][0]["outputs"][1]["factors"][0];
  EXPECT_TRUE(settling["log_odds"].is_null()) << "arrival_time is no yes or no";

  const std::string csv = document::csv(answer);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 2 * 3);
  EXPECT_EQ(csv.find("point,label,output,"), 0u);
  EXPECT_TRUE(says(csv, ",name,matters,total,total_low,total_high,first_order,"));

  const std::string text = document::text(answer);
  EXPECT_TRUE(says(text, "Point 1: b", "friction.k1", "total", "first order", "log odds per sd",
                   "controller.ki  the same in all trials of the point"));
}

}  // namespace
}  // namespace zerocount::sensitivity
