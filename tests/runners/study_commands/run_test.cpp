// Runs: the same datasets for any threads, parts, interruptions and kills; nothing lost.
#include <csignal>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class Run : public ProgramTest {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }

  /// Runs the study to its end, and expects success.
  void complete(const std::string& manifest, const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run", manifest, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_FALSE(fs::exists(at(output + ".shards")));
  }

  /// Starts a run that takes minutes, and waits until it writes its first shard.
  RunningProgram start_long_run(const std::string& output, std::vector<std::string> more = {}) {
    folder_.write("long.yaml", small_manifest(200000));
    std::vector<std::string> words{"run", "long.yaml", "-o", output, "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    const std::ptrdiff_t before = shards_in(at(output + ".shards"));
    RunningProgram running(words, folder_.path());
    running.wait_for_shards(at(output + ".shards"), before + 1);
    return running;
  }
};

TEST_F(Run, GivesTheSameDatasetsInParts) {
  folder_.write("study.yaml", small_manifest(101, "retain: {trials: [7]}\n"));
  complete("study.yaml", "whole.h5");
  for (const char* part : {"3/3", "1/3", "2/3"})
    complete("study.yaml", std::string("part") + part[0] + ".h5", {"--shard", part});
  EXPECT_TRUE(says(refusal({"merge", "part1.h5", "part3.h5", "-o", "merged.h5"}, 4), "missing"));
  EXPECT_EQ(program({"summary", "part1.h5"}).code, 4);
  const ProgramResult merged = program({"merge", "part3.h5", "part1.h5", "part2.h5", "-o", "merged.h5"});
  EXPECT_EQ(merged.code, 0) << merged.err;
  expect_same_datasets(at("whole.h5"), at("merged.h5"));
  EXPECT_EQ(program({"merge", "part3.h5", "part1.h5", "part2.h5", "-o", "merged.h5"}).code, 2);  // it exists
  EXPECT_TRUE(says(refusal({"merge", "part1.h5", "part1.h5", "part2.h5", "part3.h5", "-o", "twice.h5"}, 4),
                   "part1.h5: is given twice"));
}

TEST_F(Run, SurvivesBeingKilledAtRandomMoments) {
  folder_.write("study.yaml", small_manifest(1000));
  complete("study.yaml", "whole.h5");
  std::mt19937 random(6);
  std::uniform_int_distribution<int> moment(5, 400);
  for (const int signal : {SIGKILL, SIGINT, SIGTERM}) {
    const std::string name = "hit" + std::to_string(signal) + ".h5";
    for (int kill = 0; kill < 3; ++kill) {
      RunningProgram running({"run", "study.yaml", "-o", name, "--threads", "2"}, folder_.path());
      std::this_thread::sleep_for(std::chrono::milliseconds(moment(random)));
      running.send(signal);
      const int code = running.wait();
      // Finished in time, ended by the signal, or (before the watch is set up) by its default action.
      EXPECT_TRUE(code == 0 || code == 130 || code == 128 + signal) << code;
    }
    complete("study.yaml", name);
    expect_same_datasets(at("whole.h5"), at(name));
  }
}

TEST_F(Run, AnInterruptedRunKeepsItsTrialsAndContinues) {
  RunningProgram running = start_long_run("long.h5");
  running.send(SIGINT);
  EXPECT_EQ(running.wait(), 130);
  EXPECT_FALSE(fs::exists(at("long.h5")));
  EXPECT_FALSE(fs::is_empty(at("long.h5.shards")));
  folder_.write("other.yaml", small_manifest(20001));
  EXPECT_TRUE(says(refusal({"run", "other.yaml", "-o", "long.h5"}), "trials is 200000 there and 20001 here"));
  RunningProgram again = start_long_run("long.h5");
  again.send(SIGTERM);
  EXPECT_EQ(again.wait(), 130);
}

TEST_F(Run, AKilledRunKeepsItsFinishedTrials) {
  RunningProgram running = start_long_run("killed.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  running.send(SIGKILL);
  running.wait();
  std::int64_t kept = 0;
  for (const auto& entry : fs::directory_iterator(at("killed.h5.shards"))) {
    if (entry.path().extension() == ".shard")
      kept += reading::AllTrialsFile(entry.path(), reading::Require::any_part).rows().count;
  }
  EXPECT_GT(kept, 0);
}

TEST_F(Run, LeavesAnIgnoredSignalIgnored) {
  folder_.write("study.yaml", small_manifest(1000));
  const std::string command = "cd " + folder_.path().string() +
                              " && bash -c \"trap '' INT; " ZEROCOUNT_PROGRAM
                              " run study.yaml -o out.h5 -q & sleep 0.2; kill -INT \\$!; wait \\$!\"";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
  EXPECT_TRUE(fs::exists(at("out.h5")));
}

TEST_F(Run, UsesOverlappingShards) {
  folder_.write("study.yaml", small_manifest(60));
  complete("study.yaml", "whole.h5");
  complete("study.yaml", "middle.h5", {"--shard", "2/3"});
  complete("study.yaml", "half.h5", {"--shard", "1/2"});
  fs::create_directory(at("out.h5.shards"));
  fs::copy(at("middle.h5"), at("out.h5.shards/middle.h5"));
  fs::copy(at("half.h5"), at("out.h5.shards/half.h5"));
  complete("study.yaml", "out.h5");
  expect_same_datasets(at("whole.h5"), at("out.h5"));
}

TEST_F(Run, CleansUpAfterARunThatDiedAtItsEnd) {
  folder_.write("study.yaml", small_manifest(10));
  complete("study.yaml", "part.h5", {"--shard", "1/2"});
  complete("study.yaml", "out.h5");
  fs::create_directory(at("out.h5.shards"));
  fs::copy(at("part.h5"), at("out.h5.shards/part.h5"));
  complete("study.yaml", "out.h5");  // expects the folder gone

  complete("study.yaml", "other.h5", {"--set", "seed=43"});
  fs::create_directory(at("out.h5.shards"));
  fs::copy(at("other.h5"), at("out.h5.shards/other.h5"));
  EXPECT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code,
            0);  // nothing to run, so nothing stands in the way
  EXPECT_TRUE(fs::exists(at("out.h5.shards/other.h5")));
}

TEST_F(Run, RepeatsTheTrialsOfADamagedShard) {
  folder_.write("study.yaml", small_manifest(40));
  complete("study.yaml", "whole.h5");
  complete("study.yaml", "part.h5", {"--shard", "1/2"});
  const std::string bytes = folder_.read("part.h5");
  fs::create_directory(at("new.h5.shards"));
  folder_.write("new.h5.shards/damaged.h5", bytes.substr(0, bytes.size() / 2));
  EXPECT_TRUE(says(refusal({"run", "study.yaml", "-o", "new.h5"}, 0), "warning"));
  EXPECT_EQ(folder_.read("new.h5.shards/damaged.h5.damaged").size(), bytes.size() / 2);
  expect_same_datasets(at("whole.h5"), at("new.h5"));
}

/// Manifest of trials with ten million samples of a contact that creeps fast: each takes minutes.
constexpr const char* long_trials =
    "zerocount: 1\nname: slow\nseed: 1\ntrials: 4\nfriction: {lambda: 1.0e-6}\n"
    "command: {targets: [5], hold: 5000}\n";

TEST_F(Run, CheckOfLongTrialsEndsSoon) {
  folder_.write("slow.yaml", long_trials);
  const auto started = std::chrono::steady_clock::now();
  const ProgramResult result = program({"check", "slow.yaml", "--set", "friction.lambda=1.0e-9"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(60));
  EXPECT_TRUE(says(result.out, "hunting of trial 0", "not decided")) << result.out;
}

// The signal does not wait for the trial.
TEST_F(Run, ASignalEndsALongTrial) {
  folder_.write("slow.yaml", long_trials);
  for (const char* engine : {"batch", "reference"}) {
    RunningProgram running({"run", "slow.yaml", "-o", "slow.h5", "-q", "--engine", engine}, folder_.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const auto sent = std::chrono::steady_clock::now();
    running.send(SIGTERM);
    EXPECT_EQ(running.wait(), 130) << engine;
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(20)) << engine;
  }
}

TEST_F(Run, RefusesASecondRunOnTheSameOutput) {
  RunningProgram first = start_long_run("out.h5");
  EXPECT_TRUE(says(refusal({"run", "long.yaml", "-o", "out.h5"}, 5), "out.h5"));
  first.send(SIGKILL);
  first.wait();
  RunningProgram third = start_long_run("out.h5");  // the lock died with its holder
  third.send(SIGINT);
  EXPECT_EQ(third.wait(), 130);
}

TEST_F(Run, AnUnwritableOutputIsReportedWithTheReason) {
  folder_.write("study.yaml", small_manifest(4));
  EXPECT_TRUE(says(refusal({"run", "study.yaml", "-o", "nowhere/out.h5"}, 5), "nowhere", "does not exist"));
  EXPECT_EQ(program({"run", "study.yaml", "-o", "new/"}).code, 2);
  EXPECT_EQ(program({"run", "study.yaml", "-o", "."}).code, 2);
}

TEST_F(Run, AFullDiskLosesNoFinishedTrial) {
  folder_.write("study.yaml", small_manifest(400));
  complete("study.yaml", "whole.h5");
  // A limit on file size stands for the full disk: shards fit, and the results file does not.
  const std::string command = "cd " + folder_.path().string() +
                              " && ulimit -f 60 && " ZEROCOUNT_PROGRAM " run study.yaml -o out.h5 2> err";
  const int status = std::system(("bash -c \"" + command + "\"").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 5) << folder_.read("err");
  EXPECT_TRUE(says(folder_.read("err"), "out.h5")) << folder_.read("err");
  EXPECT_FALSE(fs::exists(at("out.h5")));
  complete("study.yaml", "out.h5");
  expect_same_datasets(at("whole.h5"), at("out.h5"));
}

TEST_F(Run, RecordsOverridesAndTraceReplaysThem) {
  folder_.write("study.yaml", small_manifest(6));
  complete("study.yaml", "set.h5", {"--set", "trials=3", "--set", "plant.inertia=6e-4"});
  EXPECT_EQ(reading::AllTrialsFile(at("set.h5")).header().overrides,
            (std::vector<std::string>{"trials=3", "plant.inertia=6e-4"}));
  EXPECT_EQ(reading::AllTrialsFile(at("set.h5")).rows().count, 6);
  EXPECT_EQ(program({"trace", "set.h5", "--point", "1", "--trial", "2"}).code, 0);
}

}  // namespace
}  // namespace zerocount::testing
