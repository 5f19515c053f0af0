// Counts on a real rig beside the simulated trials: from the manifest to the summary, the file and the
// report.
#include <nlohmann/json.hpp>

#include "analysis/statistics/clusters/observed_test.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

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

TEST_F(ObservedCounts, AreOfOneOfTheRigs) {
  const nlohmann::json points = points_of("rigs: 4\n" + counts_of_both);
  const nlohmann::json& few = points[0]["observed_counts"];
  EXPECT_EQ(few["verdict"], "too_few") << few;  // 2/5 is the least p of four rigs
  EXPECT_GE(few["lowest_p_value"].get<double>(), 0.4);
  const nlohmann::json short_trials = points_of("rigs: 40\n" + counts_of_both);
  EXPECT_EQ(short_trials[0]["observed_counts"]["verdict"], "untested");
  EXPECT_TRUE(short_trials[0]["observed_counts"]["p_value"].is_null());
}

TEST_F(ObservedCounts, AreNotMissedWhereThereAreTextsOnly) {
  const nlohmann::json points = points_of("observed: {low: calm}\n");
  EXPECT_EQ(points[0]["observed"], "calm");
  EXPECT_FALSE(points[0].contains("observed_counts"));
  const nlohmann::json one = points_of("observed: {low: {successes: 3, of: 3}}\n");
  EXPECT_TRUE(one[1]["observed_counts"].is_null());
}

TEST_F(ObservedCounts, OfAnOpenLoopAreRefused) {
  folder_.write(
      "study.yaml",
      "zerocount: 1\nname: open\nseed: 4\ntrials: 4\ncommand: {torque: {levels: [0.1]}, hold: 0.15}\n"
      "sweep: {cases: {low: {plant.inertia: 1.0e-3}}}\nobserved: {low: {successes: 1, of: 2}}\n");
  EXPECT_TRUE(says(refusal({"check", "study.yaml"}),
                   "an open-loop study has no successes to compare with; expected a text"));
}

}  // namespace
}  // namespace zerocount::testing
