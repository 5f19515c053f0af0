// `accept` as a program: logs of machines beside a study.

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class Accept : public ProgramTest {
 protected:
  void SetUp() override { run_study("machines: 40\ngoal: {band: 1, within: 0.03, moves: 0.9}\n"); }

  void run_study(const std::string& more) {
    folder_.write("study.yaml", R"(zerocount: 1
name: accepted
seed: 5
trials: 4000
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {targets: [{integers: [3, 9]}], hold: 0.1}
)" + more);
    const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "-q", "--force"});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  /// Writes a log with `moves` moves, the first `late` of which take too long. The times differ from log to
  /// log.
  void write_log(const std::string& name, int moves, int late) {
    std::ofstream file(folder_.path() / name);
    file << "move,band_settling_time[1] [ms]\n";
    const double time = 12.5 + 0.001 * ++logs_;
    for (int i = 0; i < moves; ++i)
      file << i << "," << (i < late ? (i % 2 == 0 ? "31" : "") : fmt::format("{:.3f}", time)) << "\n";
  }
  Json accepted(std::vector<std::string> logs, int code) {
    logs.insert(logs.begin(), {"accept", "study.h5"});
    return json_of(logs, code);
  }

  int logs_{0};  ///< number of logs written so far
};

TEST_F(Accept, JudgesTheMachinesByTheGoalAndThePrediction) {
  for (int i = 0; i < 3; ++i) write_log(fmt::format("good-{}.csv", i), 100, 0);
  write_log("bad.csv", 100, 30);
  write_log("few.csv", 5, 0);
  const Json good = accepted({"good-0.csv", "good-1.csv", "good-2.csv", "--these"}, 0);
  EXPECT_EQ(good["status"], "accepted");
  EXPECT_EQ(good["simulated_machines"], 40);
  EXPECT_EQ(good["goals"][0]["met"], 300);
  EXPECT_EQ(good["goals"][0]["agreement"], "consistent");
  EXPECT_NEAR(good["goals"][0]["measured_low"].get<double>(), std::pow(0.05, 1.0 / 300.0), 1e-9);
  const Json bad = accepted({"bad.csv"}, 1);
  EXPECT_EQ(bad["goals"][0]["met"], 70) << "an empty cell is late, too";
  EXPECT_EQ(bad["goals"][0]["agreement"], "differs");
  EXPECT_EQ(accepted({"few.csv"}, 3)["status"], "undecided");
  EXPECT_TRUE(says(accepted({"few.csv", "--these"}, 3)["headline"].get<std::string>(),
                   "; 29 moves in all, without another miss, can"));
}

// The log of one column of a machine that stopped settling ends with blank lines.
TEST_F(Accept, CountsBlankLinesOfALogOfOneColumnAsMissedMoves) {
  std::string text = "band_settling_time[1]\n";
  for (int i = 0; i < 60; ++i) text += "0.001\n";
  std::ofstream(folder_.path() / "log.csv") << text << std::string(40, '\n');
  const Json judged = accepted({"log.csv", "--these"}, 1);
  EXPECT_EQ(judged["goals"][0]["met"], 60);
  EXPECT_EQ(judged["goals"][0]["moves"], 100);
}

TEST_F(Accept, CountsFromTheEndOfTheProfilesInTheLog) {
  run_study("machines: 40\ngoal: {band: 1, after_profile: 0.03, moves: 0.9}\n");
  std::ofstream(folder_.path() / "log.csv")
      << "band_settling_time[1] [ms],travel_time [ms]\n49,20\n51,20\n29,0\n,20\n";
  const Json judged = json_of({"accept", "study.h5", "log.csv", "--these"});
  EXPECT_EQ(judged["goals"][0]["met"], 2);
  write_log("short.csv", 5, 0);
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "short.csv"}), "has no column travel_time"));
}

// That 9 in 10 moves of all machines meet the goal is shown by 29 machines without a miss, and by no fewer.
TEST_F(Accept, JudgesTheClaimOnAllMachines) {
  std::vector<std::string> logs;
  for (int i = 0; i < 29; ++i) {
    logs.push_back(fmt::format("good-{}.csv", i));
    write_log(logs.back(), 40, 0);
  }
  const Json enough = accepted(logs, 0);
  EXPECT_EQ(enough["goals"][0]["goal_status"], "met");
  EXPECT_NEAR(enough["goals"][0]["all_machines_low"].get<double>(), std::pow(0.05, 1.0 / 29.0), 1e-9);
  logs.pop_back();
  const Json too_few = accepted(logs, 3);
  EXPECT_EQ(too_few["goals"][0]["goal_status"], "undecided");
  EXPECT_GE(too_few["needed_machines"].get<int>(), 29);
}

TEST_F(Accept, JudgesAGoalOnMachinesByTheirNumber) {
  run_study("machines: 40\ngoal: {band: 1, within: 0.03, moves: 0.9, machines: 0.95}\n");
  std::vector<std::string> logs;
  for (int i = 0; i < 10; ++i) {
    logs.push_back(fmt::format("{}.csv", i));
    write_log(logs.back(), 400, i < 2 ? 60 : 0);
  }
  const Json all = accepted(logs, 3);
  EXPECT_GT(all["goals"][0]["measured_low"].get<double>(), 0.9) << "of the moves of all together";
  EXPECT_EQ(all["goals"][0]["goal_status"], "undecided") << "8 of 10 may be 95 of 100";
  logs.push_back("--these");
  EXPECT_EQ(accepted(logs, 1)["goals"][0]["goal_status"], "missed");
  logs.erase(logs.begin(), logs.begin() + 2);
  EXPECT_EQ(accepted(logs, 0)["goals"][0]["goal_status"], "met");
}

// Of 40 simulated machines one has a p-value of 2/41 at least: below 0.05, but not below 0.05 by two goals.
TEST_F(Accept, BoundsAllowForTheNumberOfGoals) {
  write_log("worse.csv", 60, 6);
  EXPECT_EQ(accepted({"worse.csv"}, 1)["goals"][0]["agreement"], "differs");
  run_study(
      "machines: 40\ngoals: {one: {band: 1, within: 0.03, moves: 0.8}, other: {band: 1, within: 0.03, moves: "
      "0.85}}\n");
  const Json two = accepted({"worse.csv"}, 3);
  EXPECT_LT(two["goals"][0]["p_value"].get<double>(), 0.05);
  EXPECT_EQ(two["goals"][0]["agreement"], "too_few");
  write_log("bad.csv", 60, 40);
  const std::string text = program({"accept", "study.h5", "bad.csv", "--these"}).out;
  EXPECT_EQ(text.find("rejected by 60 moves of 1 machine: missed: one, other"), 0u) << text;
}

// Few moves that meet the goal are shown by nothing, but fewer of them than predicted meet it.
TEST_F(Accept, RejectsMachinesBelowThePrediction) {
  write_log("worse.csv", 60, 6);
  const Json worse = accepted({"worse.csv"}, 1);
  EXPECT_EQ(worse["goals"][0]["goal_status"], "undecided");
  const std::string text = program({"accept", "study.h5", "worse.csv"}).out;
  EXPECT_EQ(text.find("rejected by 60 moves of 1 machine: met less often than predicted: goal (90 % of"), 0u)
      << text;
  EXPECT_GT(worse["goals"][0]["measured_high"], 0.9);
  EXPECT_EQ(worse["goals"][0]["agreement"], "differs");
}

TEST_F(Accept, RefusesUnusableLogsAndStudies) {
  const auto message = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{"accept", "study.h5"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult result = program(all);
    return fmt::format("{} {}", result.code, result.err);
  };
  folder_.write("other.csv", "overshoot\n1\n");
  folder_.write("none.csv", "band_settling_time[1]\n");
  write_log("good.csv", 10, 0);
  EXPECT_EQ(message({"other.csv"}),
            "2 other.csv: has no column band_settling_time[1], which the goal asks for\n");
  EXPECT_EQ(message({"none.csv"}), "4 none.csv: has no moves; expected a row for each move of the machine\n");
  EXPECT_EQ(message({}).substr(0, 1), "2");
  EXPECT_EQ(message({"good.csv", "./good.csv"}).substr(0, 1), "2");
  EXPECT_TRUE(says(message({"good.csv", "./good.csv"}), "is given twice"));
  run_study("goal: {band: 1, within: 0.03, moves: 0.9}\n");
  EXPECT_TRUE(says(message({"good.csv"}), "no trials share a machine"));
  run_study("machines: 40\n");
  EXPECT_TRUE(says(message({"good.csv"}), "its manifest has no goal"));
}

// One machine under several names would show what so many machines show.
TEST_F(Accept, RefusesLogsOfOneMachine) {
  std::string log = "band_settling_time[1]\n";
  std::string in_ms = "\xEF\xBB\xBFserial;band_settling_time[1] [ms]\r\n";
  for (int i = 0; i < 40; ++i) {
    log += fmt::format("{:.6f}\n", 0.01 + 1e-4 * (7 * i % 40));
    in_ms += fmt::format("7;{:.3f}\r\n", 10.0 + 0.1 * (7 * i % 40));
  }
  folder_.write("a.csv", log);
  folder_.write("copy.csv", log);
  folder_.write("in_ms.csv", in_ms);
  folder_.write("longer.csv", log + "0.0137\n");
  write_log("b.csv", 40, 0);
  std::filesystem::create_symlink("a.csv", folder_.path() / "link.csv");
  std::filesystem::create_hard_link(folder_.path() / "a.csv", folder_.path() / "hard.csv");
  for (const std::string copy : {"copy.csv", "in_ms.csv", "hard.csv"})
    EXPECT_TRUE(says(refusal({"accept", "study.h5", "a.csv", "b.csv", copy}),
                     "a.csv, " + copy + ": all 40 moves have the same values in the same order",
                     "--allow-equal"))
        << copy;
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "longer.csv", "b.csv", "a.csv"}),
                   "longer.csv, a.csv: the first 40 moves have the same values"));
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "a.csv", "link.csv", "--allow-equal"}), "is given twice"));
  EXPECT_EQ(accepted({"a.csv", "copy.csv", "--these", "--allow-equal"}, 0)["goals"][0]["moves"], 80);
  folder_.write("few.csv", "band_settling_time[1]\n0.01\n0.01\n");
  folder_.write("as-few.csv", "band_settling_time[1]\n0.01\n0.01\n");
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "few.csv", "as-few.csv"}),
                   "--allow-equal where so few different values are equal by chance"));
}

TEST_F(Accept, NamesTheColumnThatLooksLikeTheMissingOne) {
  folder_.write("case.csv", "move,Band_Settling_Time[1] [ms],overshoot\n0,12,0\n");
  EXPECT_EQ(
      refusal({"accept", "study.h5", "case.csv"}),
      "case.csv: has no column band_settling_time[1] (its column 'Band_Settling_Time[1] [ms]' looks like "
      "it), which the goal asks for\n");
}

TEST_F(Accept, AsksForTheConditionAndTheAge) {
  run_study(
      "machines: 40\ngoal: {band: 1, within: 0.03, moves: 0.9}\nages: {at: [0, 100000]}\n"
      "conditions: {empty: {}, loaded: {controller.ki: 8.0e-6}}\n");
  write_log("good.csv", 100, 0);
  EXPECT_NE(program({"accept", "study.h5", "good.csv"}).code, 0);
  EXPECT_TRUE(
      says(refusal({"accept", "study.h5", "good.csv", "--condition", "empty", "--age", "7"}), "100000"));
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "good.csv", "--age", "100000"}), "loaded"));
  const Json empty = accepted({"good.csv", "--condition", "empty", "--age", "0", "--these"}, 0);
  const Json loaded = accepted({"good.csv", "--condition", "loaded", "--age", "100000", "--these"}, 0);
  EXPECT_EQ(loaded["goals"][0]["agreement"], "differs") << "these are better";
  EXPECT_EQ(loaded["simulated_machines"], 40);
  EXPECT_NE(loaded["goals"][0]["predicted"], empty["goals"][0]["predicted"]) << "a slower loop";
}

// The unit of a column may be that of another kind of axis.
TEST_F(Accept, RefusesUnitsOfAnotherDimension) {
  run_study("machines: 40\ngoal: {band: 1, within: 0.03, moves: 0.9, limits: {holding_torque: 1}}\n");
  folder_.write("force.csv", "band_settling_time[1] [ms],holding_torque [N]\n12,0.1\n");
  const ProgramResult force = program({"accept", "study.h5", "force.csv"});
  EXPECT_EQ(force.code, 2);
  EXPECT_EQ(force.err,
            "force.csv: holding_torque is in 'N', and in the study in 'N m'; expected a unit of the same "
            "dimension\n");
  folder_.write("angle.csv", "band_settling_time[1] [rad],holding_torque [N m]\n12,0.1\n");
  EXPECT_EQ(program({"accept", "study.h5", "angle.csv"}).code, 2);
  folder_.write("milli.csv", "band_settling_time[1] [ms],holding_torque [mN m]\n12,900\n12,1100\n");
  EXPECT_EQ(accepted({"milli.csv"}, 1)["goals"][0]["met"], 1);
}

TEST_F(Accept, JudgesAGoalOnSomeMovesByTheirNumbers) {
  run_study("machines: 40\ngoals: {first: {on: [0], band: 1, within: 0.03, moves: 0.9}}\n");
  folder_.write("unnumbered.csv", "band_settling_time[1]\n0.01\n");
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "unnumbered.csv"}), "expected a column 'move'"));
  folder_.write("beyond.csv", "move,band_settling_time[1]\n0,0.01\n7,0.01\n");
  EXPECT_TRUE(says(refusal({"accept", "study.h5", "beyond.csv"}, 4), "row 2: its 'move'"));

  folder_.write("two.yaml", R"(zerocount: 1
name: two
seed: 5
trials: 400
machines: 40
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {targets: [{integers: [3, 9]}, 0], hold: 0.1}
goals: {back: {on: [1], band: 1, within: 0.03, moves: 0.9}}
)");
  ASSERT_EQ(program({"run", "two.yaml", "-o", "study.h5", "-q", "--force"}).code, 0);
  std::string log = "move,band_settling_time[1]\n";
  for (int i = 0; i < 100; ++i) log += "0,\n1,0.012\n";
  folder_.write("numbered.csv", log);
  const Json numbered = accepted({"numbered.csv", "--these"}, 0);
  EXPECT_EQ(numbered["goals"][0]["moves"], 100) << "the late ones are not asked";
  EXPECT_EQ(numbered["goals"][0]["met"], 100);
  EXPECT_EQ(numbered["machines"][0]["moves"], Json({100}));
  EXPECT_EQ(numbered["machines"][0]["met"], Json({100}));
  const std::string page = program({"accept", "study.h5", "numbered.csv", "--these"}).out;
  EXPECT_TRUE(
      says(page, "accepted: 100 moves of 1 machine show that these machines meet the goal", "100 of 100"));
  EXPECT_FALSE(says(page, "200"));
}

// Machines of an unknown world differ where they are like those of none.
TEST_F(Accept, ComparesMachinesWithEachWorld) {
  run_study(
      "machines: 160\nworlds: 4\nplant: {inertia: {uniform: [4.0e-4, 9.0e-4], per: world}}\n"
      "goal: {band: 1, within: 0.03, moves: 0.9}\n");
  write_log("good.csv", 100, 0);
  write_log("bad.csv", 100, 80);
  const Json good = accepted({"good.csv", "--these"}, 0);
  EXPECT_GE(good["goals"][0]["like_worlds"], 1);
  const Json bad = accepted({"bad.csv"}, 1);
  EXPECT_EQ(bad["goals"][0]["like_worlds"], 0);
  EXPECT_EQ(bad["goals"][0]["agreement"], "differs");
  const std::string text = program({"accept", "study.h5", "good.csv"}).out;
  EXPECT_TRUE(says(text, "with 4 worlds"));
}

// The runs of a machine of the study itself have the values of its summary.
TEST_F(Accept, ReportsTheValuesOfTheStandard) {
  folder_.write("iso.yaml", R"(zerocount: 1
name: iso
seed: 5
trials: 80
machines: 40
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {sequence: {targets: [-20, 5, 20], overrun: 5, cycles: 3}, hold: 0.1}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 1, within: 0.09, moves: 0.5}
)");
  ASSERT_EQ(program({"run", "iso.yaml", "-o", "study.h5", "-q", "--force"}).code, 0);
  ASSERT_EQ(program({"export", "study.h5", "-o", "tables"}).code, 0);
  const Json answer = accepted({"tables/outcomes.csv", "--these"}, 0);
  ASSERT_EQ(answer["standard"].size(), 12u);
  const Json summary = Json::parse(program({"summary", "study.h5", "--format", "json"}).out);
  for (const Json& value : answer["standard"]) {
    EXPECT_EQ(value["runs"], 80);
    EXPECT_GE(value["within"].get<int>(), 70) << value;
    if (value["value"] != "repeatability") continue;
    const std::string text = summary.dump();
    EXPECT_TRUE(says(text, "repeatability"));
    std::vector<double> measured = value["measured"].get<std::vector<double>>();
    std::ranges::sort(measured);
    EXPECT_DOUBLE_EQ(value["predicted"].get<double>(), 0.5 * (measured[39] + measured[40]));
  }
  EXPECT_FALSE(says(program({"accept", "study.h5", "tables/outcomes.csv"}).out, "not judged"));
  write_log("times.csv", 20, 0);
  EXPECT_TRUE(accepted({"times.csv", "--these"}, 0)["standard"].empty());
  EXPECT_TRUE(says(program({"accept", "study.h5", "times.csv"}).out,
                   "the values of ISO 230-2 are not judged, because times.csv has no column final_error"));
}

}  // namespace
}  // namespace zerocount::testing
