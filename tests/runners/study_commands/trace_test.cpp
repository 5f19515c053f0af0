// Traces: the columns of the contract, numbers that read back, replay from the results file alone.

#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"
#include "runners/study_commands/trace_writer.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/trial_runner.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* columns =
    "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode";

class Trace : public ProgramTest {
 protected:
  Trace() { folder_.write("study.yaml", small_manifest(5, "retain: {trials: [2]}\n")); }

  std::vector<trial::SampleRecord> records(std::int64_t point, std::int64_t index) const {
    const study::Study study = manifest::load_study(folder_.path() / "study.yaml");
    std::vector<trial::SampleRecord> all;
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& record) { all.push_back(record); };
    trial::run_trial(study::study_trial(study, point, index).parameters, observers);
    return all;
  }
};

TEST_F(Trace, CsvHasTheColumnsAndReadsBackToTheSameNumbers) {
  const ProgramResult result = program({"trace", "study.yaml", "--point", "1", "--trial", "3"});
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, columns);
  for (const trial::SampleRecord& r : records(1, 3)) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream cells(line);
    std::string cell;
    const auto next = [&] {
      std::getline(cells, cell, ',');
      return std::strtod(cell.c_str(), nullptr);
    };
    EXPECT_EQ(next(), static_cast<double>(r.k));
    EXPECT_EQ(next(), r.t);
    EXPECT_EQ(next(), static_cast<double>(r.target));
    EXPECT_EQ(next(), static_cast<double>(r.count));
    EXPECT_EQ(next(), static_cast<double>(r.coarse_count));
    EXPECT_EQ(next(), static_cast<double>(r.error));
    EXPECT_EQ(next(), static_cast<double>(r.code));
    EXPECT_EQ(next(), r.torque);
    EXPECT_EQ(next(), r.theta);
    EXPECT_EQ(next(), r.omega);
    EXPECT_EQ(next(), r.xp);
    EXPECT_EQ(next(), r.xh);
    EXPECT_EQ(next(), static_cast<double>(r.depth));
    std::getline(cells, cell, ',');
    EXPECT_EQ(cell, r.mode == trial::HookMode::stick ? "stick" : "slide");
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(Trace, JsonEqualsTheRecords) {
  const auto json =
      nlohmann::json::parse(program({"trace", "study.yaml", "--trial", "1", "--format", "json"}).out);
  const std::vector<trial::SampleRecord> expected = records(0, 1);
  ASSERT_EQ(json["samples"].size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(json["samples"][i]["theta"].get<double>(), expected[i].theta);
    EXPECT_EQ(json["samples"][i]["count"].get<std::int64_t>(), expected[i].count);
    EXPECT_EQ(json["samples"][i]["mode"], "stick");
  }
  EXPECT_EQ(json["trial"], 1);
  EXPECT_TRUE(json["inputs"].contains("friction.k1"));
  EXPECT_EQ(json["outcome"].size(), 1u);
}

TEST_F(Trace, ReplayFromTheFileEqualsTheRetainedRecord) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  const std::string from_manifest = program({"trace", "study.yaml", "--point", "1", "--trial", "2"}).out;
  std::filesystem::remove(folder_.path() / "study.yaml");
  const ProgramResult replay =
      program({"trace", "out.h5", "--point", "1", "--trial", "2", "-o", "trial.csv"});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_EQ(folder_.read("trial.csv"), from_manifest);
  EXPECT_EQ(program({"trace", "out.h5", "-o", "trial.csv"}).code, 2);  // never over an existing file

  const reading::AllTrialsFile file(folder_.path() / "out.h5");
  const std::vector<layout::TraceRecord> kept = file.trace_at(0, file.trace_count());
  ASSERT_EQ(kept.size(), 600u);  // trial 2 of both points
  EXPECT_EQ(kept[300].trial, 7);
  EXPECT_EQ(kept[300].k, 0);
}

TEST_F(Trace, ReportsAReplayThatDiffersFromTheRecord) {
  const study::Study study = manifest::load_study(folder_.path() / "study.yaml");
  std::vector<shards::TrialResult> results = trials::TrialRunner(study).run(layout::all_rows(study));
  results[3].outcome.moves[0].holding_torque += 2.4e-4;
  const std::filesystem::path shard = folder_.path() / "shard.h5";
  shards::write_shard(shard, study, {0, std::ssize(results)}, results);
  study_run::assemble(std::vector<shards::ShardInfo>{{shard, layout::all_rows(study)}}, study,
                      folder_.path() / "altered.h5", layout::all_rows(study));

  EXPECT_EQ(program({"trace", "altered.h5", "--trial", "2"}).code, 0);
  const ProgramResult altered = program({"trace", "altered.h5", "--trial", "3"});
  EXPECT_EQ(altered.code, 4);
  EXPECT_TRUE(says(altered.err, "move 0: holding_torque: recorded"));
  EXPECT_FALSE(says(altered.err, "creep"));
}

TEST_F(Trace, AnEmptyResultsFileIsCalledDamaged) {
  folder_.write("empty.h5", "");
  EXPECT_TRUE(says(refusal({"trace", "empty.h5"}, 4), "empty.h5: not a results file of zerocount"));
}

TEST_F(Trace, LeavesNoPartialFile) {
  const std::string command = "cd " + folder_.path().string() +
                              " && bash -c \"ulimit -f 8; " ZEROCOUNT_PROGRAM
                              " trace study.yaml -o trial.csv 2> err\"";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5);
  EXPECT_TRUE(says(folder_.read("err"), "trial.csv")) << folder_.read("err");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "trial.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "trial.csv.part"));
}

TEST_F(Trace, APartHasOnlyItsTrials) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "part.h5", "--shard", "1/2"}).code, 0);
  EXPECT_EQ(program({"trace", "part.h5", "--point", "0", "--trial", "4"}).code, 0);
  EXPECT_EQ(program({"trace", "part.h5", "--point", "1", "--trial", "0"}).code, 2);
}

}  // namespace
}  // namespace zerocount::testing

// The columns of a trace are those of the study, whatever they are.

namespace zerocount::study_commands {
namespace {

/// The trace of one sample as text, with the columns that a study with these features has.
/// @param json as JSON; false: as a table
std::string trace_of(const study::StudyFeatures& features, bool json) {
  study::Study study;
  study.name = "extras";
  study.features = features;
  const study::StudyTrial trial;
  trial::SampleRecord record;
  record.count = 5;
  record.reference = 7;
  record.phase = loop::ControlPhase::coarse;
  record.drive_torque = 0.125;

  std::string text;
  TraceWriter writer([&text](std::string_view piece) { text += piece; }, json);
  writer.begin({study, 0, 0, trial});
  writer.write(record);
  writer.end({});
  return text;
}

TEST(TraceColumns, AreFourteenForABasicStudy) {
  EXPECT_EQ(trace_of({}, false),
            "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode\n"
            "0,0,0,5,0,0,0,0,0,0,0,0,0,stick\n");
}

TEST(TraceColumns, OptionalColumnsComeAfterTheMode) {
  EXPECT_EQ(
      trace_of({.travel = true, .phases = true, .drive_torque = true}, false),
      "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode,reference,phase,drive_"
      "torque\n"
      "0,0,0,5,0,0,0,0,0,0,0,0,0,stick,7,coarse,0.125\n");
  EXPECT_TRUE(trace_of({.phases = true}, false).ends_with(",stick,coarse\n"));
}

TEST(TraceColumns, JsonHasTheSameColumns) {
  const auto all = nlohmann::json::parse(
      trace_of({.travel = true, .phases = true, .drive_torque = true}, true))["samples"][0];
  EXPECT_EQ(all.size(), 17U);
  EXPECT_EQ(all["reference"], 7);
  EXPECT_EQ(all["phase"], "coarse");
  EXPECT_EQ(all["drive_torque"], 0.125);
  const auto few = nlohmann::json::parse(trace_of({}, true))["samples"][0];
  EXPECT_EQ(few.size(), 14U);
  EXPECT_FALSE(few.contains("reference"));
}

TEST(TraceOutcome, SaysWhetherItWasStoppedIfTheStudyCanStop) {
  study::Study study;
  const study::StudyTrial trial;
  for (const bool stopped : {false, true}) {
    study.features.stopping = stopped;
    std::string text;
    TraceWriter writer([&text](std::string_view piece) { text += piece; }, true);
    writer.begin({study, 0, 0, trial});
    writer.end({{trial::MoveOutcome{}}});
    EXPECT_EQ(nlohmann::json::parse(text)["outcome"][0].contains("stopped"), stopped);
  }
}

}  // namespace
}  // namespace zerocount::study_commands
