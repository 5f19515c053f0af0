// Runs that stop when they are sure: when they do, and that it depends on the trials alone.
#include <csignal>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

constexpr double halfwidth = 0.08;
constexpr std::int64_t block = 50;

std::string manifest(const std::string& stop) {
  return "zerocount: 1\nname: stopping\nseed: 11\ntrials: 50\n" + stop +
         "friction: {k1: {uniform: [90, 130]}, alpha: {log_uniform: [0.2, 2]}}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}}\n"
         "command: {targets: [{integers: [1, 30]}], hold: 0.2}\n"
         "verdict: {dwell: 0.02, window: 0.02}\n"
         "sweep: {grid: {controller.ki: [2.0e-5, 9.45e-5]}}\n";
}

std::string stopping_manifest() {
  return manifest("stop: {success_rate_halfwidth: 0.08, max_trials: 2000}\n");
}

class SequentialRun : public ::testing::Test {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }

  ProgramResult run(const std::string& study, const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run", study, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return zerocount_program(words, folder_.path());
  }

  void complete(const std::string& study, const std::string& output, std::vector<std::string> more = {}) {
    const ProgramResult result = run(study, output, std::move(more));
    ASSERT_EQ(result.code, 0) << result.err;
  }

  TemporaryFolder folder_;
};

std::int64_t successes_among(const reading::AllTrialsFile& file, std::int64_t point, std::int64_t trials) {
  const std::vector<double> outcomes = file.measure("outcome", {point * file.header().trials, trials});
  std::int64_t successes = 0;
  for (const double outcome : outcomes)
    successes += outcome == static_cast<double>(trial::Outcome::zero_count);
  return successes;
}

bool narrow(const reading::AllTrialsFile& file, std::int64_t trials) {
  for (std::int64_t point = 0; point < 2; ++point) {
    const statistics::ConfidenceInterval bounds =
        statistics::confidence_sequence_bounds(successes_among(file, point, trials), trials, 0.95);
    if (bounds.high - bounds.low > 2.0 * halfwidth) return false;
  }
  return true;
}

TEST_F(SequentialRun, EndsAfterTheFirstBlockThatDecides) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "out.h5");
  const reading::AllTrialsFile file(at("out.h5"));
  const std::int64_t trials = file.header().trials;
  EXPECT_EQ(trials % block, 0);
  EXPECT_GT(trials, 2 * block);
  EXPECT_LT(trials, 2000);
  EXPECT_TRUE(narrow(file, trials));
  EXPECT_FALSE(narrow(file, trials - block));
  EXPECT_FALSE(fs::exists(at("out.h5.shards")));
}

TEST_F(SequentialRun, DoesNotDependOnThreadsAndInterruptions) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "one.h5", {"--threads", "1"});
  complete("study.yaml", "three.h5", {"--threads", "3"});
  expect_same_datasets(at("one.h5"), at("three.h5"));
  for (const int signal : {SIGKILL, SIGINT, SIGKILL, SIGINT}) {
    RunningProgram program({"run", "study.yaml", "-o", "cut.h5", "--threads", "1", "-q"}, folder_.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    program.send(signal);
    program.wait();
  }
  complete("study.yaml", "cut.h5");
  expect_same_datasets(at("one.h5"), at("cut.h5"));
}

TEST_F(SequentialRun, ReportsItsTrialsAndTheReasonForStopping) {
  folder_.write("study.yaml", stopping_manifest());
  const ProgramResult sure = run("study.yaml", "out.h5");
  const std::string trials = std::to_string(reading::AllTrialsFile(at("out.h5")).header().trials);
  EXPECT_TRUE(says(sure.err, "wrote out.h5: " + trials + " trials at each point (all success rates"));
  const ProgramResult unsure = run("study.yaml", "few.h5", {"--set", "stop.max_trials=120"});
  EXPECT_TRUE(says(unsure.err, "wrote few.h5: 120 trials at each point (max_trials; some"));
  EXPECT_EQ(reading::AllTrialsFile(at("few.h5")).header().trials, 120);
}

TEST_F(SequentialRun, RunsAtLeastMinTrials) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "out.h5", {"--set", "stop.min_trials=1020"});
  EXPECT_EQ(reading::AllTrialsFile(at("out.h5")).header().trials, 1050);
}

TEST_F(SequentialRun, AFinishedOneIsNotRunAgain) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "out.h5");
  const ProgramResult again = run("study.yaml", "out.h5");
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.err, "out.h5: already complete, nothing to run\n");
  EXPECT_EQ(run("study.yaml", "out.h5", {"--set", "seed=12"}).code, 2);
  EXPECT_EQ(run("study.yaml", "out.h5", {"--engine", "reference"}).code, 2);
}

TEST_F(SequentialRun, CannotBeDividedIntoParts) {
  folder_.write("study.yaml", stopping_manifest());
  const ProgramResult result = run("study.yaml", "out.h5", {"--shard", "1/2"});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(result.err, "option '--shard': a study with `stop` cannot be divided"));
}

TEST_F(SequentialRun, SummaryHasAnytimeValidBounds) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "out.h5");
  const reading::AllTrialsFile file(at("out.h5"));
  const std::int64_t trials = file.header().trials;
  const ProgramResult result = zerocount_program({"summary", "out.h5", "--format", "json"}, folder_.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto points = nlohmann::json::parse(result.out).at("points");
  for (std::int64_t point = 0; point < 2; ++point) {
    const statistics::ConfidenceInterval bounds =
        statistics::confidence_sequence_bounds(successes_among(file, point, trials), trials, 0.95);
    const auto& stopped = points.at(static_cast<std::size_t>(point)).at("stopping");
    EXPECT_EQ(stopped.at("success_rate_low").get<double>(), bounds.low);
    EXPECT_EQ(stopped.at("success_rate_high").get<double>(), bounds.high);
    EXPECT_TRUE(stopped.at("reached").get<bool>());
  }
}

TEST_F(SequentialRun, SummaryNamesPointsThatStayedUndecided) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "few.h5", {"--set", "stop.max_trials=100"});
  const ProgramResult table =
      zerocount_program({"summary", "few.h5", "--confidence", "0.99"}, folder_.path());
  EXPECT_TRUE(says(table.out, "99 % bounds of zero-count, however often one looks", ": not reached"));
}

// With machines, how well the mean over these machines is known decides, and all of them have run equally
// many trials whenever it is looked at.
TEST_F(SequentialRun, EndsAfterAWholeRoundOfItsMachines) {
  const std::string machines = "machines: 10\n";
  folder_.write("study.yaml", stopping_manifest() + machines);
  folder_.write("plain.yaml", manifest("") + machines);
  complete("study.yaml", "out.h5");
  const reading::AllTrialsFile file(at("out.h5"));
  const std::int64_t trials = file.header().trials;
  EXPECT_GT(trials, block);
  EXPECT_LT(trials, 2000);
  EXPECT_TRUE(narrow(file, trials));
  EXPECT_FALSE(narrow(file, trials - block));
  const reading::StoredGroups on_machines = file.groups("machine").value();
  ASSERT_EQ(on_machines.trials.size(), 20U);
  for (const std::int64_t of_machine : on_machines.trials) EXPECT_EQ(of_machine, trials / 10);
  complete("plain.yaml", "plain.h5", {"--set", "trials=" + std::to_string(trials)});
  const auto stopped = stored_datasets(at("out.h5"));
  for (const auto& [path, bytes] : stored_datasets(at("plain.h5"))) {
    if (path.find("manifest") == std::string::npos && path.find("overrides") == std::string::npos) {
      EXPECT_TRUE(stopped.at(path) == bytes) << path;
    }
  }
}

// What more trials narrowed is the mean over these machines; of all machines less is known.
TEST_F(SequentialRun, SummarySeparatesBoundsForTheseMachinesFromThoseForAll) {
  folder_.write("study.yaml", stopping_manifest() + "machines: 10\n");
  complete("study.yaml", "out.h5");
  const ProgramResult result = zerocount_program({"summary", "out.h5", "--format", "json"}, folder_.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto points = nlohmann::json::parse(result.out).at("points");
  bool differ = false;
  for (const auto& point : points) {
    EXPECT_EQ(point.at("stopping").at("of_machines"), 10);
    EXPECT_LE(point.at("stopping").at("halfwidth").get<double>(), halfwidth);
    const double of_all =
        point.at("success_rate_high").get<double>() - point.at("success_rate_low").get<double>();
    differ = differ || of_all > 2.0 * halfwidth;
  }
  EXPECT_TRUE(differ) << result.out;
  EXPECT_TRUE(says(zerocount_program({"summary", "out.h5"}, folder_.path()).out,
                   "these bounds hold for the mean over the 10 machines of the study"));
}

/// Every trial of the file can be run again from it.
TEST_F(SequentialRun, CanBeReplayedFromItsFile) {
  folder_.write("study.yaml", stopping_manifest());
  complete("study.yaml", "out.h5");
  const reading::AllTrialsFile file(at("out.h5"));
  const std::int64_t last = file.header().trials - 1;
  const ProgramResult trace =
      zerocount_program({"trace", "out.h5", "--point", "1", "--trial", std::to_string(last)}, folder_.path());
  EXPECT_EQ(trace.code, 0) << trace.err;
  EXPECT_NE(zerocount_program({"trace", "out.h5", "--point", "1", "--trial", std::to_string(last + 1)},
                              folder_.path())
                .code,
            0);
}

// A run whose output exists: it is complete, or is extended by more trials, or is refused with what differs.

class ExistingOutput : public ::testing::Test {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }

  ProgramResult run(const std::string& manifest, const std::string& output,
                    std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run", manifest, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return zerocount_program(words, folder_.path());
  }

  void complete(const std::string& manifest, const std::string& output, std::vector<std::string> more = {}) {
    const ProgramResult result = run(manifest, output, std::move(more));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_FALSE(fs::exists(at(output + ".shards")));
  }

  /// Expects exit code 2, every text in the message, and the bytes of the file as they were.
  void expect_refused(const std::vector<std::string>& more, const std::vector<std::string>& texts) {
    const std::string before = folder_.read("out.h5");
    const ProgramResult result = run("study.yaml", "out.h5", more);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    for (const std::string& text : texts) EXPECT_TRUE(says(result.err, text, "--force"));
    EXPECT_TRUE(folder_.read("out.h5") == before);
    EXPECT_FALSE(fs::exists(at("out.h5.shards")));
  }

  TemporaryFolder folder_;
};

TEST_F(ExistingOutput, AnExtendedRunEqualsARunOfAllTrials) {
  std::mt19937 random(20);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (const char* design : {"monte_carlo", "sobol", "monte_carlo", "sobol"}) {
    const int machines = between(0, 1) == 1 ? between(2, 40) : 1;
    const int fewer = machines * between(1, 300 / machines);
    const int more = fewer + machines * between(1, 300 / machines);
    std::string keys = fmt::format("retain: {{trials: [0, {}]}}\n", fewer - 1);
    if (std::string(design) == "sobol") keys += "design: sobol\n";
    if (machines > 1) keys += fmt::format("machines: {}\n", machines);
    const std::string name = fmt::format("{}-{}-{}", design, fewer, more);
    SCOPED_TRACE(name + "\n" + keys);
    folder_.write("study.yaml", small_manifest(fewer, keys));
    const std::string first = fmt::format("trials={}", fewer);
    const std::string all = fmt::format("trials={}", more);
    complete("study.yaml", name + ".h5", {"--set", first});
    complete("study.yaml", name + ".h5", {"--set", all});
    complete("study.yaml", name + "-fresh.h5", {"--set", all});
    expect_same_datasets(at(name + "-fresh.h5"), at(name + ".h5"));
  }
}

TEST_F(ExistingOutput, ASaltelliDesignIsExtendedByRows) {
  folder_.write("study.yaml", small_manifest(60, "design: saltelli\n"));  // rows of 4 factors and 2
  complete("study.yaml", "out.h5");
  complete("study.yaml", "out.h5", {"--set", "trials=120"});
  complete("study.yaml", "fresh.h5", {"--set", "trials=120"});
  expect_same_datasets(at("fresh.h5"), at("out.h5"));
}

TEST_F(ExistingOutput, ACompleteFileIsNotChanged) {
  folder_.write("study.yaml", small_manifest(4));
  complete("study.yaml", "out.h5");
  const std::string before = folder_.read("out.h5");
  const ProgramResult again = run("study.yaml", "out.h5");
  EXPECT_EQ(again.code, 0);
  EXPECT_TRUE(says(again.err, "nothing to run"));
  EXPECT_TRUE(folder_.read("out.h5") == before);
}

TEST_F(ExistingOutput, AnExtensionRunsOnlyTheMissingTrials) {
  folder_.write("study.yaml", small_manifest(20));
  complete("study.yaml", "out.h5");
  folder_.write("more.yaml", "# with a comment, and another notation\n" + small_manifest(25));
  const ProgramResult result = run("more.yaml", "out.h5");
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(says(result.err, "20 trials at each point are kept, 5 are added"));
}

TEST_F(ExistingOutput, AKilledExtensionLosesNothing) {
  folder_.write("study.yaml", small_manifest(100));
  complete("study.yaml", "out.h5");
  const std::string before = folder_.read("out.h5");
  for (const int signal : {SIGINT, SIGKILL}) {
    RunningProgram program({"run", "study.yaml", "--set", "trials=200000", "-o", "out.h5", "--threads", "1"},
                           folder_.path());
    for (int i = 0; i < 2000 && !fs::exists(at("out.h5.shards")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(fs::exists(at("out.h5.shards"))) << "the run has begun nothing in 10 s";
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    program.send(signal);
    EXPECT_NE(program.wait(), 0);
    EXPECT_TRUE(folder_.read("out.h5") == before);
  }
  EXPECT_EQ(zerocount_program({"summary", "out.h5"}, folder_.path()).code, 0);
  // The shards of the longer study are in the way of another one, until they are given up.
  EXPECT_EQ(run("study.yaml", "out.h5", {"--set", "trials=150"}).code, 2);
  complete("study.yaml", "out.h5", {"--set", "trials=150", "--force"});
  complete("study.yaml", "fresh.h5", {"--set", "trials=150"});
  expect_same_datasets(at("fresh.h5"), at("out.h5"));
}

TEST_F(ExistingOutput, AnotherStudyIsRefusedWithTheDifferences) {
  folder_.write("study.yaml", small_manifest(20));
  complete("study.yaml", "out.h5");
  expect_refused({"--set", "seed=43"}, {"another study", "seed is 42 there and 43 here"});
  expect_refused({"--set", "plant.inertia=6e-4", "--set", "seed=43"},
                 {"plant.inertia is 6e-4 here, and not given there", "seed is 42 there"});
  expect_refused({"--set", "trials=30", "--set", "seed=43"}, {"trials is 20 there and 30 here", "seed"});
  expect_refused({"--set", "trials=10"}, {"has 20 trials", "the study 10"});
  expect_refused({"--engine", "reference"}, {"batch engine", "reference engine"});
  expect_refused({"--shard", "1/2"}, {"trials 0 to 39", "0 to 19"});
}

// Trials of one case stood under the name of another.
TEST_F(ExistingOutput, AStudyInAnotherOrderIsNotExtended) {
  folder_.write(
      "study.yaml",
      small_manifest(8,
                     "machines: 2\ngoals: {wide: {band: 3, within: 0.1, moves: 0.9}, zero: {within: "
                     "0.1, moves: 0.9}}\nconditions: {light: {}, heavy: {plant.inertia: "
                     "1.0e-3}}\n"));
  const std::string swept =
      "sweep={cases: {b: {friction.alpha: 1}, a: {friction.alpha: 2}}, grid: "
      "{controller.kp: [0, 1.0e-4], controller.delay: [1, 2]}}";
  complete("study.yaml", "out.h5", {"--set", swept});
  for (const auto& [other, said] : std::vector<std::pair<std::string, std::string>>{
           {"sweep.cases={a: {friction.alpha: 2}, b: {friction.alpha: 1}}",
            "sweep.cases, order of keys is b, a there and a, b here"},
           {"sweep.grid={controller.delay: [1, 2], controller.kp: [0, 1.0e-4]}",
            "sweep.grid, order of keys is controller.kp, controller.delay there and controller.delay, "
            "controller.kp here"},
           {"conditions={heavy: {plant.inertia: 1.0e-3}, light: {}}",
            "conditions, order of keys is light, heavy there and heavy, light here"},
           {"goals={zero: {within: 0.1, moves: 0.9}, wide: {band: 3, within: 0.1, moves: 0.9}}",
            "goals, order of keys is wide, zero there and zero, wide here"}}) {
    for (const char* const trials : {"trials=8", "trials=16"})
      expect_refused({"--set", swept, "--set", other, "--set", trials}, {"another study", said});
  }
  complete("study.yaml", "out.h5", {"--set", swept, "--set", "trials=16"});
}

TEST_F(ExistingOutput, ALatinHypercubeCannotBeExtended) {
  folder_.write("study.yaml", small_manifest(20, "design: latin_hypercube\n"));
  complete("study.yaml", "out.h5");
  expect_refused({"--set", "trials=40"}, {"latin_hypercube", "laid out for their number"});
}

TEST_F(ExistingOutput, APartCannotBeExtended) {
  folder_.write("study.yaml", small_manifest(20));
  complete("study.yaml", "out.h5", {"--shard", "1/2"});
  expect_refused({"--set", "trials=40"}, {"a part of a study"});
}

TEST_F(ExistingOutput, AFileThatIsNotAResultsFileIsRefused) {
  folder_.write("study.yaml", small_manifest(4));
  folder_.write("out.h5", "my notes");
  expect_refused({}, {"not a usable results file"});
  complete("study.yaml", "out.h5", {"--force"});
}

TEST_F(ExistingOutput, AnEarlierFormatIsRefused) {
  folder_.write("study.yaml", small_manifest(4));
  complete("study.yaml", "out.h5", {});
  replace_attribute(at("out.h5"), "format_version", 3);
  expect_refused(
      {}, {"out.h5", "wrote it in format version 3, and this program reads version 5; run its manifest"});
}

}  // namespace
}  // namespace zerocount::testing
