// Torque levels in place of targets, from the manifest to the table; and the columns of sample records that a
// study uses.
#include <nlohmann/json.hpp>

#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* loads =
    "zerocount: 1\nname: loads\nseed: 11\ntrials: 12\n"
    "friction: {k2: {uniform: [600, 900]}}\n"
    "command: {torque: {levels: [0.1, 0.05, 0.15, 0], rate: 5}, hold: 0.05}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}}\n"
    "retain: {trials: [3]}\n"
    "sweep: {cases: {creeping: {friction.alpha: 0.5}, elastic: {friction.alpha: 0}}}\n";

class OpenLoop : public ::testing::Test {
 protected:
  OpenLoop() { folder.write("loads.yaml", loads); }
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder.path());
  }

  TemporaryFolder folder;
};

TEST_F(OpenLoop, LevelsOfTheSummaryAreThoseOfTheTrials) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5", "--engine", "reference"}).code, 0);
  const auto json = nlohmann::json::parse(run({"summary", "loads.h5", "--format", "json"}).out);
  const study::Study study = manifest::load_study(folder / "loads.yaml");
  for (std::int64_t point = 0; point < 2; ++point) {
    const auto& found = json["points"][static_cast<std::size_t>(point)];
    EXPECT_EQ(found["open_loop"], 12);
    EXPECT_EQ(found["zero_count"], 0);
    EXPECT_TRUE(found["success_rate"].is_null());
    std::vector<double> sum(4), creep(4);
    for (std::int64_t index = 0; index < study.trials; ++index) {
      const trial::TrialOutcome outcome =
          trial::run_trial(study::study_trial(study, point, index).parameters);
      for (std::size_t level = 0; level < 4; ++level) {
        sum[level] += outcome.moves[level].final_position / 12.0;
        creep[level] += outcome.moves[level].creep / 12.0;
      }
    }
    ASSERT_EQ(found["levels"].size(), 4U);
    for (std::size_t level = 0; level < 4; ++level) {
      const auto& values = found["levels"][level];
      EXPECT_NEAR(values["position"]["mean"].get<double>(), sum[level], 1e-12 * std::abs(sum[level]));
      EXPECT_NEAR(values["creep"]["mean"].get<double>(), creep[level],
                  1e-12 * std::abs(creep[level]) + 1e-30);
      EXPECT_LT(values["position"]["low"].get<double>(), sum[level]);
      EXPECT_GT(values["position"]["high"].get<double>(), sum[level]);
      const double asked = std::vector<double>{0.1, 0.05, 0.15, 0.0}[level];
      EXPECT_NEAR(values["torque"].get<double>(), asked, 1.2e-4) << "half a code";
    }
  }
}

TEST_F(OpenLoop, TableAndTablesHaveTheLevels) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  const std::string table = run({"summary", "loads.h5"}).out;
  EXPECT_TRUE(says(table, "position (µrad)"));
  EXPECT_FALSE(says(table, "zero-count"));
  ASSERT_EQ(run({"export", "loads.h5", "-o", "tables"}).code, 0);
  std::istringstream lines(folder.read("tables/levels.csv"));
  int count = 0;
  for (std::string line; std::getline(lines, line);) ++count;
  EXPECT_EQ(count, 1 + 2 * 4);
}

TEST_F(OpenLoop, SampleRecordsHaveNoTarget) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  const reading::AllTrialsFile file(folder / "loads.h5");
  ASSERT_GT(file.trace_count(), 0);
  for (const layout::TraceRecord& record : file.trace_at(0, file.trace_count())) {
    EXPECT_EQ(record.target, 0);
    EXPECT_EQ(record.error, -record.count);
  }
  EXPECT_EQ(run({"trace", "loads.h5", "--point", "1", "--trial", "3"}).code, 0);
}

// results/datasets.md, /trace/code.
TEST_F(OpenLoop, SampleRecordsOfAnExactTorqueHaveNoCode) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "exact.h5", "--set", "command.torque.through=exact"}).code, 0);
  const reading::AllTrialsFile file(folder / "exact.h5");
  double largest = 0.0;
  for (const layout::TraceRecord& record : file.trace_at(0, file.trace_count())) {
    EXPECT_EQ(record.code, 0);
    largest = std::max(largest, record.torque);
  }
  EXPECT_EQ(largest, 0.15);
}

TEST(SampleRecords, HaveTheColumnsThatTheStudyUsesInEveryPlace) {
  const TemporaryFolder folder;
  folder.write("study.yaml",
               "zerocount: 1\nname: two phases\nseed: 2\ntrials: 2\n"
               "dac: {offset: 1.0e-4}\n"
               "controller: {coarse: {coarse_beyond: 500}}\n"
               "command: {targets: [3000], hold: 0.1, profile: {shape: trapezoidal}}\n"
               "retain: {trials: [1]}\n");
  const auto run = [&](const std::vector<std::string>& words) {
    return zerocount_program(words, folder.path());
  };
  ASSERT_EQ(run({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  const reading::AllTrialsFile file(folder / "out.h5");
  const std::vector<layout::TraceRecord> kept = file.trace_at(0, file.trace_count());
  const ProgramResult trace = run({"trace", "out.h5", "--trial", "1", "--format", "json"});
  ASSERT_EQ(trace.code, 0) << trace.err;
  const auto samples = nlohmann::json::parse(trace.out)["samples"];
  ASSERT_EQ(samples.size(), kept.size());
  bool coarse = false, moving = false;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(samples[i]["reference"].get<std::int64_t>(), kept[i].reference);
    EXPECT_EQ(samples[i]["phase"], kept[i].phase == loop::ControlPhase::coarse ? "coarse" : "fine");
    EXPECT_EQ(samples[i]["drive_torque"].get<double>(), kept[i].drive_torque);
    EXPECT_NEAR(kept[i].drive_torque, kept[i].torque + 1.0e-4, 1e-15);
    coarse = coarse || kept[i].phase == loop::ControlPhase::coarse;
    moving = moving || (kept[i].reference != 0 && kept[i].reference != 3000);
  }
  EXPECT_TRUE(coarse && moving);
}

}  // namespace
}  // namespace zerocount::testing
