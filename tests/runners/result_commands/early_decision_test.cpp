// A study with early decision from its manifest to its summary: the same outcomes as without, what was
// stopped is told, and a trial replays.
#include <nlohmann/json.hpp>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class EarlyDecision : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder.emplace();
    folder->write("study.yaml", small_manifest(40, "retain: {trials: [3]}\n"));
    ASSERT_EQ(run({"run", "study.yaml", "-o", "whole.h5"}).code, 0);
    const ProgramResult stopped = run(with_stop({"run", "study.yaml", "-o", "early.h5"}));
    ASSERT_EQ(stopped.code, 0) << stopped.err;
  }
  static void TearDownTestSuite() { folder.reset(); }

  static ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder->path());
  }
  static std::vector<std::string> with_stop(std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "verdict.stop=true", "--set", "verdict.limit=100"});
    return words;
  }
  static std::vector<double> measure(const char* file, const char* name) {
    const reading::AllTrialsFile study(*folder / file);
    return study.measure(name, study.rows());
  }
  static double stopped_trials() {
    const std::vector<double> stopped = measure("early.h5", "stopped");
    return static_cast<double>(std::count(stopped.begin(), stopped.end(), 1.0));
  }

  static inline std::optional<TemporaryFolder> folder;
};

TEST_F(EarlyDecision, KeepsTheOutcomesAndSaysWhatWasStopped) {
  for (const char* name : {"outcome", "stable", "arrived", "arrival"}) {
    EXPECT_EQ(measure("whole.h5", name), measure("early.h5", name)) << name;
  }
  EXPECT_GT(stopped_trials(), 20);
  EXPECT_LT(stopped_trials(), 60);
  const std::vector<double> outcomes = measure("early.h5", "outcome");
  const std::vector<double> stopped = measure("early.h5", "stopped");
  for (std::size_t row = 0; row < stopped.size(); ++row) {
    if (stopped[row] == 0.0) continue;
    EXPECT_EQ(outcomes[row], static_cast<double>(trial::Outcome::oscillating)) << row;
  }
}

// Real measures of a move that was not run are NaN, and its file is read all the same.
TEST_F(EarlyDecision, MovesAfterOneThatDivergedAreReadAsNotRun) {
  std::vector<std::string> words = with_stop({"run", "study.yaml", "-o", "moves.h5"});
  words.insert(words.end(), {"--set", "command.targets=[20, 0]"});
  const ProgramResult result = run(words);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<double> times = measure("moves.h5", "travel_time");
  EXPECT_GT(std::count_if(times.begin(), times.end(), [](double time) { return std::isnan(time); }), 0);
  EXPECT_EQ(run({"summary", "moves.h5"}).code, 0);
}

TEST_F(EarlyDecision, LeavesNoColumnWhereItIsNotUsed) {
  EXPECT_FALSE(reading::AllTrialsFile(*folder / "whole.h5").root().open_group("outcome").contains("stopped"));
  EXPECT_TRUE(reading::AllTrialsFile(*folder / "early.h5").root().open_group("outcome").contains("stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5"}).out, "stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5", "--format", "csv"}).out, "stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5", "--format", "json"}).out, "stopped"));
}

TEST_F(EarlyDecision, IsCountedInTheSummaryAndInThePoints) {
  const auto json = nlohmann::json::parse(run({"summary", "early.h5", "--format", "json"}).out);
  double in_json = 0, in_file = 0;
  for (const auto& point : json["points"]) in_json += point["stopped"].get<double>();
  for (const layout::PointColumn& column : reading::AllTrialsFile(*folder / "early.h5").statistics()) {
    if (column.name != "stopped") continue;
    for (const double value : column.values) in_file += value;
  }
  EXPECT_EQ(in_json, stopped_trials());
  EXPECT_EQ(in_file, stopped_trials());
  EXPECT_TRUE(says(run({"summary", "early.h5"}).out, " stopped "));
  EXPECT_TRUE(says(run({"summary", "early.h5", "--format", "csv"}).out, ",stopped,"));
  ASSERT_EQ(run({"export", "early.h5", "-o", "tables"}).code, 0);
  EXPECT_TRUE(says(folder->read("tables/outcomes.csv"), ",stopped,"));
}

TEST_F(EarlyDecision, TracesAndRecordsEndWhereTheTrialDoes) {
  const std::string whole = run({"trace", "whole.h5", "--point", "1", "--trial", "3"}).out;
  const ProgramResult early = run({"trace", "early.h5", "--point", "1", "--trial", "3"});
  EXPECT_EQ(early.code, 0) << early.err;
  EXPECT_EQ(run(with_stop({"trace", "study.yaml", "--point", "1", "--trial", "3"})).out, early.out);
  ASSERT_LT(early.out.size(), whole.size());
  EXPECT_EQ(whole.substr(0, early.out.size()), early.out);

  const reading::AllTrialsFile file(*folder / "early.h5");
  const auto lines = std::count(early.out.begin(), early.out.end(), '\n') - 1;
  EXPECT_EQ(file.trace_count(), 300 + lines);  // that trial of the other point is not stopped
  const layout::TraceRecord last = file.trace_at(file.trace_count() - 1, 1)[0];
  EXPECT_EQ(last.k, lines - 1);
  EXPECT_GT(std::abs(last.error), 100);
}

}  // namespace
}  // namespace zerocount::testing
