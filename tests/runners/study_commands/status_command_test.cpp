// How far a run or an array job has come.
#include <csignal>

#include "core/friction/profile.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/first_difference.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class StatusOfARun : public ProgramTest {
 protected:
  nlohmann::json status() const {
    const ProgramResult result = program({"status", "out.h5", "--format", "json"});
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  void run_part(int part, const std::string& output) const {
    const ProgramResult result =
        program({"run", "study.yaml", "-q", "-o", output, "--shard", std::to_string(part) + "/4"});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(StatusOfARun, CountsTheTrialsInItsShards) {
  folder_.write("study.yaml", small_manifest(200000));
  EXPECT_EQ(program({"status", "out.h5"}).code, 2);
  RunningProgram run({"run", "study.yaml", "-q", "-o", "out.h5", "--threads", "1"}, folder_.path());
  run.wait_for_shards(folder_ / "out.h5.shards");
  const nlohmann::json during = status();
  RunningProgram watch({"status", "out.h5", "--watch", "1"}, folder_.path());
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 130);
  EXPECT_EQ(watch.wait(), 4) << "nobody runs it any more";
  EXPECT_TRUE(says(program({"status", "out.h5", "--watch", "1"}).err, "has stopped"));
  EXPECT_TRUE(during["running"].get<bool>());
  EXPECT_EQ(during["trials"], 400000);
  EXPECT_GT(during["finished"], 0);
  const nlohmann::json after = status();
  EXPECT_FALSE(after["running"].get<bool>());
  EXPECT_GE(after["finished"], during["finished"]);
  const std::string text = program({"status", "out.h5"}).out;
  EXPECT_TRUE(says(text, ": not running, " + after["finished"].dump() + " of 400000 trials",
                   "unfinished"));                  // the summary
  folder_.write("out.h5.lock", "another machine");  // whose lock is not seen here
  EXPECT_TRUE(status()["running"].get<bool>());
}

TEST_F(StatusOfARun, CountsThePartsOfAnArrayJob) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  run_part(1, "out.h5.parts/part-1-of-4.h5");
  run_part(4, "out.h5.parts/part-4-of-4.h5");
  fs::create_directory(folder_ / "out.h5.parts/part-3-of-4.h5.shards");
  run_part(3, "out.h5.parts/part-3-of-4.h5.shards/trials.h5");
  const nlohmann::json found = status();
  EXPECT_EQ(
      found["parts"],
      (nlohmann::json{{"all", 4}, {"complete", 2}, {"running", 0}, {"interrupted", 1}, {"waiting", 1}}));
  EXPECT_EQ(found["finished"], 90);
  EXPECT_FALSE(found["complete"].get<bool>());
  EXPECT_EQ(found["shards"], 1);
  const ProgramResult summary = program({"summary", "out.h5", "--format", "json"});
  ASSERT_EQ(summary.code, 0) << summary.err;
  EXPECT_EQ(nlohmann::json::parse(summary.out)["unfinished"]["finished"], 90);
}

TEST_F(StatusOfARun, NamesFilesThatCannotBeRead) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  run_part(1, "out.h5.parts/part-1-of-4.h5");
  folder_.write("out.h5.parts/part-2-of-4.h5", "nothing");
  const nlohmann::json found = status();
  ASSERT_EQ(found["problems"].size(), 1U);
  EXPECT_TRUE(says(found["problems"][0].get<std::string>(), "part-2-of-4.h5"));
  EXPECT_EQ(found["parts"]["complete"], 1);
  const ProgramResult table = program({"status", "out.h5"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_TRUE(says(table.out, "no summary: "));
  fs::remove(folder_ / "out.h5.parts/part-1-of-4.h5");
  EXPECT_EQ(program({"status", "out.h5"}).code, 4);  // nothing but what cannot be read
}

TEST_F(StatusOfARun, IsRefusedForFilesThatAreNotARun) {
  folder_.write("study.yaml", small_manifest(60));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"status", "out.h5"}, {"status", "out.h5", "--watch", "1"}, {"status", "."}})
    EXPECT_EQ(program(words).code, 2) << words.back();
  EXPECT_EQ(program({"status", "study.yaml"}).code, 4);
  run_part(1, "part.h5");
  EXPECT_EQ(program({"status", "part.h5"}).code, 4);
}

TEST_F(StatusOfARun, PartsAreCompleteWhenTheyAreMerged) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  for (const int part : {1, 2, 3, 4}) run_part(part, fmt::format("out.h5.parts/part-{}-of-4.h5", part));
  EXPECT_FALSE(status()["complete"].get<bool>());
  ASSERT_EQ(program({"merge", "out.h5.parts", "-o", "out.h5"}).code, 0);
  EXPECT_TRUE(status()["complete"].get<bool>());
  EXPECT_EQ(status()["parts"]["all"], 4);
  ASSERT_EQ(program({"run", "study.yaml", "-q", "-o", "out.h5", "--set", "trials=80"}).code, 0);
  EXPECT_EQ(status()["finished"], 160) << "trials were added to the file";
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_EQ(
      program({"run", "study.yaml", "-q", "--force", "-o", "out.h5.parts/part-2-of-4.h5", "--shard", "2/4"})
          .code,
      0);
  EXPECT_FALSE(status()["complete"].get<bool>());  // the file is older than a part
}

TEST_F(StatusOfARun, AnExistingFileIsComplete) {
  folder_.write("study.yaml", small_manifest(4));
  ASSERT_EQ(program({"run", "study.yaml", "-q", "-o", "out.h5"}).code, 0);
  const std::string text = program({"status", "out.h5"}).out;
  EXPECT_TRUE(says(text, ": complete, 8 of 8 trials (100.0 %)\nsee: zerocount summary out.h5\n"));
  EXPECT_EQ(program({"status", "out.h5", "--watch", "1"}).code, 0);
  const std::string json = program({"status", "out.h5", "--watch", "1", "--format", "json"}).out;
  EXPECT_EQ(json.find('\n'), json.size() - 1) << json;
}

// The timeline of a run: all trials, and the serial stages that limit how it grows with the threads.

/// small_manifest(150) has 150 trials at each of two points.
class TimelineOfRun : public ProgramTest {
 protected:
  /// For each stage of the work, the number of trials in its spans of the timeline.
  std::map<std::string, std::int64_t> trials_of_stages(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    std::map<std::string, std::int64_t> trials;
    const nlohmann::json text = nlohmann::json::parse(file);
    for (const nlohmann::json& event : text.at("traceEvents"))
      if (event.at("ph") == "X")
        trials[event.at("name")] += event.at("args").at("trials").get<std::int64_t>();
    return trials;
  }
};

TEST_F(TimelineOfRun, HasEveryTrialInEachStage) {
  folder_.write("study.yaml", small_manifest(150));
  const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "--timeline", "time.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  std::map<std::string, std::int64_t> trials = trials_of_stages("time.json");
  for (const char* stage : {"compute", "encode", "merge", "sum"}) EXPECT_EQ(trials[stage], 300) << stage;
  EXPECT_EQ(trials["store"], 600);      // the shards, and the file
  EXPECT_EQ(trials["read back"], 300);  // of the file; storing a shard contains it
}

TEST_F(TimelineOfRun, CoversKeptStatistics) {
  folder_.write("study.yaml", small_manifest(150, "keep: statistics\n"));
  const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "--timeline", "time.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(trials_of_stages("time.json")["compute"], 300);
  EXPECT_EQ(trials_of_stages("time.json")["statistics"], 300);
}

TEST_F(TimelineOfRun, ReplacesOnlyATimeline) {
  folder_.write("study.yaml", small_manifest(20));
  folder_.write("notes.txt", "not a timeline\n");
  const auto run = [&](const std::string& timeline) {
    return program({"run", "study.yaml", "-o", "study.h5", "--timeline", timeline});
  };
  EXPECT_EQ(run("time.json").code, 0);
  EXPECT_EQ(run("time.json").code, 0);
  EXPECT_EQ(run("notes.txt").code, 2);
  EXPECT_EQ(run("study.h5").code, 2);
  EXPECT_EQ(run("study.yaml").code, 2);
}

TEST_F(TimelineOfRun, ATuningHasItsStages) {
  const std::string study = small_manifest(150);
  folder_.write("study.yaml", study.substr(0, study.find("sweep:")) +
                                  "controller: {ki: 3.85e-5}\n"
                                  "goal: {band: 1, within: 0.1, moves: 0.5}\n"
                                  "tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}}}\n");
  const ProgramResult tune = program({"tune", "study.yaml", "-o", "tuned.h5", "--budget", "20000", "--extras",
                                      "none", "--timeline", "time.json"});
  ASSERT_TRUE(tune.code == 0 || tune.code == 1 || tune.code == 3) << tune.err;
  std::map<std::string, std::int64_t> trials = trials_of_stages("time.json");
  for (const char* stage : {"tune", "search", "proof", "simulate", "margins", "compute"})
    EXPECT_TRUE(trials.contains(stage)) << stage;
  EXPECT_EQ(program({"tune", "study.yaml", "-o", "other.h5", "--timeline", "tuned.h5"}).code, 2);
}

// Studies with machines, from the manifest to the file and back.

// Moves that slide and stick again, on machines that differ.
const char* const machines =
    "zerocount: 1\nname: machines\nseed: 5\ntrials: 40\nmachines: 8\n"
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.2}}, cv: 0.1, correlation_length: 0.3}}\n"
    "  k2: {uniform: [600, 900]}\n"
    "  breakaway: {uniform: [0.02, 0.03], per: contact}\n"
    "command: {targets: [{integers: [200, 300]}, 0], hold: 0.1}\n"
    "initial: {position: {uniform: [0, 6.283185307179586]}}\n"
    "verdict: {dwell: 0.02, window: 0.02}\n"
    "sweep: {grid: {controller.ki: [2.0e-5, 6.0e-5]}}\n"
    "retain: {trials: [3]}\n";

class MachineStudy : public ProgramTest {
 protected:
  MachineStudy() { write_bytes(folder_ / "m.yaml", machines); }

  void run(std::vector<std::string> more) {
    std::vector<std::string> words{"run", "m.yaml"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(MachineStudy, CheckListsTrialsPerMachineAndTheParametersThatDiffer) {
  const ProgramResult result = program({"check", "m.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out, " 8, 5 trials of each\n"));
  const auto plan = nlohmann::json::parse(program({"check", "m.yaml", "--format", "json"}).out);
  using Names = std::vector<std::string>;
  EXPECT_EQ(plan["differ_in_machines"], (Names{"friction.k1.profile.mean", "friction.k2"}));
  EXPECT_EQ(plan["differ_in_trials"],
            (Names{"friction.k1", "friction.breakaway", "command.targets.0", "initial.position"}));
  EXPECT_EQ(plan["differ_in_contacts"], Names{"friction.breakaway"});
  EXPECT_EQ(plan["same_in_points"], Names{"controller.ki"});
}

// Of 200 machines the softest is none of the first 20.
TEST_F(MachineStudy, CheckGivesTheBoundsAtTheSoftestRotorOfAllMachines) {
  std::string text = machines;
  text.replace(text.find("trials: 40\nmachines: 8"), 22, "trials: 200\nmachines: 200");
  write_bytes(folder_ / "m.yaml", text);
  const study::Study study = manifest::load_study(folder_ / "m.yaml");
  double lowest = 1e9;
  std::int64_t softest = 0;
  for (std::int64_t machine = 0; machine < study.machines; ++machine) {
    const std::shared_ptr<const friction::Profile> rotor = study.profiles.at(0).of_machine(machine);
    for (int i = 0; i < 4096; ++i) {
      const double k1 = friction::value_at(*rotor, i * study.period / 4096);
      if (k1 >= lowest) continue;
      lowest = k1;
      softest = machine;
    }
  }
  ASSERT_GE(softest, 20);

  // (6) of an integral control: ki < c·k1/J·Δx·T/2, with the numbers of the paper's machine.
  const double bound = 0.2 * lowest / 5.54e-4 * (study.period / 1'620'000) * 0.25e-3;
  const auto theory =
      nlohmann::json::parse(program({"check", "m.yaml", "--format", "json"}).out)["theory"][0];
  EXPECT_EQ(theory["lowest_k1_source"], "the lowest along the profiles of 200 machines");
  EXPECT_NEAR(theory["lowest_k1"].get<double>(), lowest, 2e-3 * lowest);
  EXPECT_NEAR(theory["lowest_stable_below"].get<double>(), bound, 2e-3 * bound);
}

TEST_F(MachineStudy, TheFileDoesNotDependOnHowItWasRun) {
  run({"-o", "once.h5", "--threads", "1"});
  run({"-o", "a.h5", "--shard", "1/2"});
  run({"-o", "b.h5", "--shard", "2/2"});
  ASSERT_EQ(program({"merge", "a.h5", "b.h5", "-o", "joined.h5"}).code, 0);
  const reading::AllTrialsFile once(folder_ / "once.h5");
  const reading::AllTrialsFile joined(folder_ / "joined.h5");
  EXPECT_EQ(reading::first_difference(once.root(), joined.root()).value_or("none"), "none");
  std::vector<std::int64_t> success(2 * 8, 0);  // counted from the outcomes
  const std::int64_t trials = once.header().trials;
  for (std::int64_t row = 0; row < once.rows().count; ++row) {
    success[static_cast<std::size_t>(row / trials * 8 + row % trials % 8)] +=
        trial::succeeded(once.outcomes({row, 1}));
  }
  EXPECT_EQ(once.groups("machine").value().success, success);
  EXPECT_EQ(once.profiles().at(0).machines, 8);
}

TEST_F(MachineStudy, ASingleTrialCanBeReplayed) {
  run({"-o", "once.h5", "--engine", "reference"});
  std::int64_t slid = 0;
  const reading::AllTrialsFile file(folder_ / "once.h5");
  for (const trial::MoveOutcome& move : file.outcomes(file.rows())) slid += move.broke_away;
  EXPECT_GT(slid, 20) << "the contacts after the first are to matter";
  for (const char* trial : {"3", "11", "39"}) {
    const ProgramResult result =
        program({"trace", "once.h5", "--point", "1", "--trial", trial, "--format", "json"});
    EXPECT_EQ(result.code, 0) << result.err;
    const std::string machine =
        std::string("\"trial\": ") + trial + ", \"machine\": " + std::to_string(std::stoi(trial) % 8);
    EXPECT_TRUE(says(result.out, machine)) << machine;
  }
}

// Joint draws of several parameters: what the program does with the table that a manifest names.

const std::string table_text = "friction.k1,friction.k2\n100,700\n110,650\n120,720\n";

class Samples : public ProgramTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "studies");
    folder_.write("studies/study.yaml",
                  "zerocount: 1\nname: sampled\nseed: 4\ntrials: 60\nmachines: 6\n"
                  "command: {targets: [20], hold: 0.05}\nsamples: posterior.csv\n");
    folder_.write("studies/posterior.csv", table_text);
  }
  ProgramResult run(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", "studies/study.yaml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
};

TEST_F(Samples, AreFoundBesideTheManifest) {
  const ProgramResult check = program({"check", "studies/study.yaml"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_TRUE(says(check.out, "friction.k1, friction.k2: a row of posterior.csv (3 draws) for each machine"));
}

TEST_F(Samples, AreRecordedInTheResultsFile) {
  ASSERT_EQ(run("out.h5").code, 0);
  std::filesystem::remove(folder_ / "studies/posterior.csv");
  EXPECT_EQ(reading::AllTrialsFile(folder_ / "out.h5").header().samples, table_text);
  for (const std::string command : {"summary", "trace"}) {
    const ProgramResult result = program({command, "out.h5"});
    EXPECT_EQ(result.code, 0) << command << result.err;
  }
  const ProgramResult report = program({"report", "out.h5", "-o", "out.html"});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_TRUE(says(folder_.read("out.html"), "a row of posterior.csv (3 draws) for each machine"));
}

TEST_F(Samples, AChangedTableIsAnotherStudy) {
  ASSERT_EQ(run("out.h5").code, 0);
  folder_.write("studies/posterior.csv", table_text + "130,710\n");
  ASSERT_EQ(run("other.h5").code, 0);
  EXPECT_NE(run("out.h5").code, 0) << "would replace the results of another study";
  const ProgramResult compare = program({"compare", "out.h5", "other.h5"});
  EXPECT_TRUE(says(compare.out, "samples, SHA-256 of the table"));
}

TEST_F(Samples, WorkWithAStudyThatStopsByItself) {
  const ProgramResult stopped =
      run("out.h5", {"--set", "stop={success_rate_halfwidth: 0.3, max_trials: 6000}"});
  EXPECT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_EQ(program({"summary", "out.h5"}).code, 0);
}

TEST_F(Samples, NameTheMissingFile) {
  std::filesystem::remove(folder_ / "studies/posterior.csv");
  EXPECT_TRUE(says(refusal({"check", "studies/study.yaml"}),
                   "studies/posterior.csv: no such file; expected a table of samples"));
}

TEST_F(Samples, AreNeverReplacedByAnOutput) {
  EXPECT_EQ(run("studies/posterior.csv", {"--force"}).code, 2);
  EXPECT_EQ(program({"trace", "studies/study.yaml", "-o", "studies/posterior.csv", "--force"}).code, 2);
  EXPECT_EQ(folder_.read("studies/posterior.csv"), table_text);
}

}  // namespace
}  // namespace zerocount::testing
