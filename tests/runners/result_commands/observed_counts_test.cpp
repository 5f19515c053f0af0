// Counts on a real machine beside the simulated trials: from the manifest to the summary, the file and the
// report.
#include <regex>

#include "analysis/basis/statistics/clusters/observed_test.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

const std::string counts_of_both =
    "observed: {low: {successes: 19, of: 20, text: in the shop}, high: {successes: 0, of: 12}}\n";

class ObservedCounts : public ProgramTest {
 protected:
  nlohmann::json points_of(const std::string& more) {
    folder_.write("study.yaml", manifest(more));
    const ProgramResult run = program({"run", "study.yaml", "-o", "out.h5", "--force"});
    EXPECT_EQ(run.code, 0) << run.err;
    const ProgramResult summary = program({"summary", "out.h5", "--format", "json"});
    EXPECT_EQ(summary.code, 0) << summary.err;
    return nlohmann::json::parse(summary.out, nullptr, false)["points"];
  }
  static std::string manifest(const std::string& more) {
    return "zerocount: 1\nname: counted\nseed: 4\ntrials: 80\n"
           "command: {targets: [{integers: [1, 30]}], hold: 0.15}\n"
           "initial: {encoder_phase: {uniform: [0, 1]}, preload: {uniform: [-0.05, 0.05]}}\n"
           "sweep: {cases: {low: {controller.ki: 3.85e-5}, high: {controller.ki: 9.45e-5}}}\n" +
           more;
  }
};

TEST_F(ObservedCounts, AreTestedAgainstTheTrialsOfTheirPoint) {
  const nlohmann::json points = points_of(counts_of_both);
  EXPECT_EQ(points[0]["observed"], "19 of 20 succeeded; in the shop");
  EXPECT_EQ(points[1]["observed"], "0 of 12 succeeded");
  const reading::AllTrialsFile file(folder_ / "out.h5");
  for (const auto& [point, successes, of] : {std::tuple{0, 19, 20}, std::tuple{1, 0, 12}}) {
    const nlohmann::json& found = points[static_cast<std::size_t>(point)];
    const nlohmann::json& counts = found["observed_counts"];
    const statistics::ObservedTest expected =
        statistics::fisher_test({successes, of}, {found["zero_count"], found["trials"]});
    EXPECT_EQ(counts["successes"], successes);
    EXPECT_EQ(counts["of"], of);
    EXPECT_DOUBLE_EQ(counts["p_value"].get<double>(), expected.p);
    EXPECT_EQ(counts["verdict"], expected.p <= 0.05 ? "differs" : "consistent");
    bool stored = false;
    for (const layout::PointColumn& column : file.statistics()) {
      if (column.name != "observed_p_value") continue;
      stored = true;
      EXPECT_DOUBLE_EQ(column.values[static_cast<std::size_t>(point)], expected.p);
    }
    EXPECT_TRUE(stored);
  }
  const std::string table = program({"summary", "out.h5"}).out;
  EXPECT_TRUE(says(table, "Fisher's exact test, each point by itself"));
  ASSERT_EQ(program({"report", "out.h5", "-o", "out.html"}).code, 0);
  EXPECT_TRUE(says(folder_.read("out.html"), points[0]["observed_counts"]["statement"].get<std::string>()));
}

TEST_F(ObservedCounts, CountAsTrialsOfOneMachine) {
  const nlohmann::json points = points_of("machines: 4\n" + counts_of_both);
  const nlohmann::json& few = points[0]["observed_counts"];
  EXPECT_EQ(few["verdict"], "too_few") << few;  // 2/5 is the least p of four machines
  EXPECT_GE(few["lowest_p_value"].get<double>(), 0.4);
  const nlohmann::json short_trials = points_of("machines: 40\n" + counts_of_both);
  EXPECT_EQ(short_trials[0]["observed_counts"]["verdict"], "untested");
  EXPECT_TRUE(short_trials[0]["observed_counts"]["p_value"].is_null());
}

// With noise the loop is within its band in time, and hardly ever ends at zero counts.
TEST_F(ObservedCounts, AreComparedWithTheGoalIfTheStudyHasOne) {
  const nlohmann::json point = points_of(
      "observed: {low: {successes: 12, of: 12}}\nencoder: {fine_errors: {noise: 1}}\n"
      "goal: {band: 12, within: 0.14, moves: 0.8}\n")[0];
  const nlohmann::json& counts = point["observed_counts"];
  EXPECT_EQ(counts["simulated_of"], 80);
  EXPECT_EQ(counts["simulated_successes"], std::lround(80.0 * point["goal"]["rate"].get<double>()));
  EXPECT_GT(counts["simulated_successes"].get<int>(), point["zero_count"].get<int>() + 40);
  EXPECT_EQ(counts["verdict"], "consistent") << counts;
  const std::string table = program({"summary", "out.h5"}).out;
  EXPECT_TRUE(says(table, "A trial succeeds if all its moves meet the goal.")) << table;
  EXPECT_FALSE(says(table, "coarse")) << table;
}

TEST_F(ObservedCounts, ObservationsMayBeTextsOnly) {
  const nlohmann::json points = points_of("observed: {low: calm}\n");
  EXPECT_EQ(points[0]["observed"], "calm");
  EXPECT_FALSE(points[0].contains("observed_counts"));
  const nlohmann::json one = points_of("observed: {low: {successes: 3, of: 3}}\n");
  EXPECT_TRUE(one[1]["observed_counts"].is_null());
}

TEST_F(ObservedCounts, AreRefusedForAnOpenLoop) {
  folder_.write(
      "study.yaml",
      "zerocount: 1\nname: open\nseed: 4\ntrials: 4\ncommand: {torque: {levels: [0.1]}, hold: 0.15}\n"
      "sweep: {cases: {low: {plant.inertia: 1.0e-3}}}\nobserved: {low: {successes: 1, of: 2}}\n");
  EXPECT_TRUE(says(refusal({"check", "study.yaml"}),
                   "an open-loop study has no successes to compare with; expected a text"));
}

// `summary --confirm`: the best point again, with new trials.

class Confirm : public ProgramTest {
 protected:
  nlohmann::json summary_of(const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"summary", file};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(words, 0);
  }
};

TEST_F(Confirm, EqualsARunOfThatPointWithTheStatedSeed) {
  for (const char* machines : {"", "machines: 5\n"}) {
    SCOPED_TRACE(machines);
    folder_.write("study.yaml", small_manifest(20, std::string(machines) + "retain: {trials: [7]}\n"));
    ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5", "--force"}).code, 0);
    const std::string before = folder_.read("out.h5");
    const nlohmann::json confirmed = summary_of("out.h5", {"--confirm", "300"})["confirmation"];
    EXPECT_EQ(folder_.read("out.h5"), before);
    EXPECT_NE(confirmed["seed"], 1);

    std::vector<std::string> words{
        "run",   "study.yaml", "-o", "new.h5", "--force", "--set", "seed=" + confirmed["seed"].dump(),
        "--set", "trials=300"};
    if (*machines != '\0') words.insert(words.end(), {"--set", "machines=300"});
    ASSERT_EQ(program(words).code, 0);
    const nlohmann::json point = summary_of("new.h5")["points"][confirmed["point"].get<std::size_t>()];
    EXPECT_EQ(confirmed["zero_count"], point["zero_count"]);
    EXPECT_EQ(confirmed["success_rate"], point["success_rate"]);
    EXPECT_NEAR(confirmed["success_rate_low"].get<double>(), point["success_rate_low"].get<double>(), 1e-12);
    EXPECT_NEAR(confirmed["success_rate_high"].get<double>(), point["success_rate_high"].get<double>(),
                1e-12);
    EXPECT_EQ(confirmed["one_trial_per_machine"], *machines != '\0');
  }
}

TEST_F(Confirm, SummarySaysThatTheBoundAllowsForTheChoice) {
  folder_.write("study.yaml", small_manifest(20));
  ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  const ProgramResult result = program({"summary", "out.h5", "--confirm", "100"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out,
                   "best of 2 points: ", "the bound allows for the choice of the point by these trials",
                   "trials:                100\n"));
}

TEST_F(Confirm, IsRefusedIfItIsMeaningless) {
  folder_.write("study.yaml", small_manifest(20));
  ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  EXPECT_EQ(program({"summary", "out.h5", "--confirm", "1"}).code, 2);
  EXPECT_EQ(program({"summary", "out.h5", "--confirm", "100", "--format", "csv"}).code, 2);
  EXPECT_EQ(program({"summary", "out.h5", "--plugin", "own.so"}).code, 2);
}

// Every output of a study speaks of the same design point.

/// A small study with a sweep, machines or not, a goal or not.
std::string random_manifest(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const auto within = [&](double low, double high) { return low + (high - low) * uniform(random); };
  std::string manifest = fmt::format("zerocount: 1\nname: drawn\nseed: {}\ntrials: 40\n", random() % 100000);
  if (uniform(random) < 0.5) manifest += "machines: 10\n";
  manifest +=
      fmt::format("friction: {{k1: {{uniform: [{:.3g}, {:.3g}]}}}}\n", within(60, 90), within(100, 140));
  manifest +=
      "command: {targets: [{integers: [-20, 20]}], hold: 0.2}\nverdict: {dwell: 0.02, window: 0.02}\n";
  manifest += "initial: {encoder_phase: {uniform: [0, 1]}}\n";
  if (uniform(random) < 0.5) {
    manifest += fmt::format("goal: {{band: {}, within: {:.3g}, moves: {:.2g}}}\n", random() % 3,
                            within(0.02, 0.1), within(0.3, 0.95));
  }
  return manifest + fmt::format(
                        "sweep: {{grid: {{controller.ki: {{logspace: [{:.3g}, {:.3g}, 4]}}, "
                        "controller.kp: [0, {:.3g}]}}}}\n",
                        within(1e-5, 5e-5), within(1e-4, 4e-4), within(1e-4, 1e-3));
}

TEST(OnePoint, EveryOutputAgreesOnEachPoint) {
  const TemporaryFolder folder;
  std::mt19937_64 random(1130);
  const auto run = [&](const std::vector<std::string>& words) {
    return zerocount_program(words, folder.path());
  };
  int with_goal = 0;
  for (int round = 0; round < 5; ++round) {
    const std::string manifest = random_manifest(random);
    SCOPED_TRACE(manifest);
    folder.write("study.yaml", manifest);
    ASSERT_EQ(run({"run", "study.yaml", "-q", "--force", "-o", "study.h5"}).code, 0);
    const auto summary = nlohmann::json::parse(run({"summary", "study.h5", "--format", "json"}).out);
    const auto best = summary["best"]["point"].get<std::int64_t>();

    const std::string table = run({"summary", "study.h5"}).out;
    EXPECT_TRUE(says(table, fmt::format("\n{} *", best), fmt::format("best of 8 points: {} (", best)));
    if (manifest.find("goal:") != std::string::npos) {
      ++with_goal;
      const ProgramResult judged = run({"judge", "study.h5", "--format", "json"});
      EXPECT_EQ(nlohmann::json::parse(judged.out)["point"], best);
    }
    EXPECT_TRUE(
        says(run({"summary", "study.h5", "--confirm", "20"}).err, fmt::format("the point {} (", best)));
    const std::string first_row = run({"summary", "study.h5", "--top", "1", "--format", "csv"}).out;
    EXPECT_TRUE(says(first_row, fmt::format("\n{},", best)));

    ASSERT_EQ(run({"report", "study.h5", "--force", "-o", "study.html"}).code, 0);
    const std::string page = folder.read("study.html");
    std::smatch named, star, trace;
    ASSERT_TRUE(std::regex_search(page, named, std::regex("Best of 8 points: ([0-9]*) \\(([^)]*)\\)")));
    ASSERT_TRUE(std::regex_search(page, star, std::regex("<td[^>]*>([^<]*) \\*<")));
    ASSERT_TRUE(std::regex_search(page, trace, std::regex("of point ([^,]*), simulated again")));
    EXPECT_EQ(named[1], std::to_string(best));
    EXPECT_EQ(star[1], std::to_string(best));
    EXPECT_EQ(trace[1], named[2]);
  }
  EXPECT_GE(with_goal, 1);
  EXPECT_LT(with_goal, 5);
}

}  // namespace
}  // namespace zerocount::testing
