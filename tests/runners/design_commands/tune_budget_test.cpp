// What a tuning does within its budget, and what it leaves out.
#include <csignal>

#include <nlohmann/json.hpp>

#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class TuneBudget : public Tune {};

// As soon as the results file is there it is the whole proof; the answer is printed before any extra; Ctrl-C
// keeps both, and the same command ends with the answer of a tuning without interruption.
TEST_F(TuneBudget, GivesTheProvenAnswerBeforeTheExtrasAndKeepsIt) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n" + std::string(two_gains));
  const std::vector<std::string> command{"tune", "axis.yaml", "-o", "tuned.h5", "--budget", "20000"};
  const std::filesystem::path out = folder_.path() / "out.txt";
  RunningProgram running(command, folder_.path(), out);
  while (!std::filesystem::exists(folder_.path() / "tuned.h5"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_EQ(program({"judge", "tuned.h5"}).code, 0) << "complete at once";
  for (int i = 0; i < 2000 && folder_.read("out.txt").find("wrote tuned.h5") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  running.send(SIGINT);
  EXPECT_EQ(running.wait(), 130);
  const std::string text = folder_.read("out.txt");
  EXPECT_TRUE(text.starts_with("met: the goal is met by controller.ki")) << text;
  const std::size_t proven = text.find("wrote tuned.h5");
  ASSERT_NE(proven, std::string::npos) << text;
  EXPECT_EQ(text.find("what limits it"), std::string::npos) << "interrupted before: " << text;
  EXPECT_NE(text.find("limits; the same command goes on with them"), std::string::npos) << text;
  EXPECT_EQ(program({"judge", "tuned.h5"}).code, 0) << "kept";

  const auto numbers_of = [](const std::string& whole) { return whole.substr(0, whole.find("spent:")); };
  const ProgramResult resumed = program(command);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(resumed.out.substr(0, proven), text.substr(0, proven));
  std::vector<std::string> again = command;
  again.emplace_back("--force");
  EXPECT_EQ(numbers_of(program(again).out), numbers_of(resumed.out));
  // The extras stand behind the answer, in their order.
  std::size_t last = proven;
  for (const char* const extra :
       {"of controller.delay", "room of each parameter", "at the tuned values, with other premises",
        "other controls", "what limits it", "searched:"}) {
    const std::size_t at = resumed.out.find(extra, last);
    ASSERT_NE(at, std::string::npos) << extra << resumed.out;
    last = at;
  }
}

TEST_F(TuneBudget, MakesTheExtrasThatAreAskedFor) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n" + std::string(two_gains));
  EXPECT_EQ(tune({"--extras", "rooms"}).code, 2);
  EXPECT_EQ(tune({"--extras", "maps"}).code, 2) << "without a page";
  const Json none = Json::parse(tune({"--extras", "none"}, "6000").out);
  EXPECT_TRUE(none["room"].empty() && none["alternatives"].empty() && none["limits"].empty());
  EXPECT_TRUE(none["left_out"].empty()) << none["left_out"];
  EXPECT_GE(none["margins"]["gain"], 6.0) << "asked for or not";
  const Json room = Json::parse(tune({"--extras", "room"}, "6000").out);
  EXPECT_FALSE(room["room"].empty());
  EXPECT_TRUE(room["alternatives"].empty() && room["limits"].empty());
  EXPECT_EQ(room["gains"], none["gains"]);

  // Of a results file that is there: the same values and proof, and the extras beside them.
  const ProgramResult later = program({"tune", "tuned.h5", "--extras", "limits,margins", "--format", "json"});
  ASSERT_EQ(later.code, 0) << later.err;
  const Json limits = Json::parse(later.out);
  EXPECT_EQ(limits["gains"], none["gains"]);
  EXPECT_EQ(limits["behaviour"][0]["peak_torque_max"], none["behaviour"][0]["peak_torque_max"]);
  EXPECT_EQ(limits["limits"][0]["cause"], "none");
  EXPECT_TRUE(limits["room"].empty());
  EXPECT_EQ(limits["margins"]["machines"], 2048);
  EXPECT_EQ(program({"tune", "tuned.h5", "--force"}).code, 2) << "nothing is written";
  folder_.write("page.html", "another page");
  const std::vector<std::string> page{"tune", "tuned.h5", "--extras", "none", "--report", "page.html"};
  EXPECT_EQ(program(page).code, 2) << "it is there";
  std::vector<std::string> replacing = page;
  replacing.emplace_back("--force");
  EXPECT_EQ(program(replacing).code, 0);
}

TEST_F(TuneBudget, NamesTheExtrasThatABudgetLeavesOutWithTheCommandThatMakesThem) {
  write_axis("goal: {band: 1, within: 0.06, moves: 0.9}\n" + std::string(two_gains));
  const ProgramResult result = program({"tune", "axis.yaml", "-o", "tuned.h5", "--budget", "1500"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::size_t line = result.out.find("left out, because the budget is not enough: ");
  ASSERT_NE(line, std::string::npos) << result.out;
  const std::string makes = "zerocount tune tuned.h5 --extras ";
  const std::size_t names = result.out.find(makes, line);
  ASSERT_NE(names, std::string::npos) << result.out;
  const std::size_t begin = names + makes.size();
  const std::string extras = result.out.substr(begin, result.out.find(' ', begin) - begin);
  const ProgramResult later = program({"tune", "tuned.h5", "--extras", extras, "--budget", "20000"});
  EXPECT_EQ(later.code, 0) << later.err;
  EXPECT_EQ(later.out.find("left out"), std::string::npos) << later.out;
  EXPECT_NE(later.out.find("what limits it"), std::string::npos) << later.out;
}

/// Trials of all parts of an answer.
std::int64_t trials_in(const Json& answer) {
  return answer["searched"]["trials"].get<std::int64_t>() + answer["proof"]["trials"].get<std::int64_t>();
}

// Of any size, on machines or trials of their own, with worlds, met or missed.
TEST_F(TuneBudget, HoldsItsBudgetOfTrialsInAllThatItRuns) {
  const std::string moves = "goal: {band: 1, within: 0.06, moves: 0.9}\n";
  const std::string machines = "goal: {band: 1, within: 0.06, moves: 0.9, machines: 0.8}\n";
  const std::string missed = "goal: {band: 0, within: 0.004, moves: 0.9}\n";
  const std::string worlds = "worlds: 5\n" + moves;
  for (const std::string& kind : {machines, missed, worlds}) {
    std::int64_t last = 0;
    for (const std::int64_t budget : {1500, 6000}) {
      write_axis(kind + std::string(two_gains));
      const ProgramResult result = tune({}, std::to_string(budget));
      if (result.code == 2) {
        EXPECT_LT(budget, 6000) << kind;
        EXPECT_NE(result.err.find("the smallest search takes"), std::string::npos) << result.err;
        continue;
      }
      const Json answer = Json::parse(result.out);
      EXPECT_LE(answer["spent_trials"], budget) << kind;
      EXPECT_LE(trials_in(answer), answer["spent_trials"]) << kind;
      EXPECT_GT(answer["searched"]["points"], last) << kind << ": a smaller budget makes a smaller search";
      last = answer["searched"]["points"];
      if (budget == 1500) {
        EXPECT_FALSE(answer["left_out"].empty()) << result.out;
      }
    }
  }
}

TEST_F(TuneBudget, HoldsItsBudgetOfTime) {
  write_axis("goal: {band: 1, within: 0.06, moves: 0.9}\n" + std::string(two_gains));
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult result = tune({}, "2s");
  const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LE(taken, 1.1 * 2.0 + 0.5) << "half a second for a busy machine";
  EXPECT_LE(Json::parse(result.out)["searched"]["seconds"], 1.1 * 2.0);
  const ProgramResult none = tune({}, "0.06s");
  EXPECT_EQ(none.code, 3);
  EXPECT_NE(none.err.find("s are not enough"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace zerocount::testing
