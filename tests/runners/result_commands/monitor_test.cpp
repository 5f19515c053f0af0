// `monitor` as a program: results files and logs as baselines, growing logs, exit codes.
#include <csignal>

#include "results/reading/all_trials_file.hpp"
#include "runners/result_commands/machine_logs.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* study = R"(zerocount: 1
name: monitored
seed: 5
trials: 200
machines: 10
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {targets: [{integers: [5, 30]}, {integers: [-30, -5]}], hold: 0.2}
)";

class Monitor : public ProgramTest {
 protected:
  /// Writes a log with settling times that repeat 0.041 … 0.050 s in a fixed order, times `factor`.
  void write_log(const std::string& name, int moves, double factor = 1.0, bool append = false) {
    std::ofstream file(folder_.path() / name, append ? std::ios::app : std::ios::trunc);
    if (!append) file << "arrival_time [ms]\n";
    for (int i = 0; i < moves; ++i) file << fmt::format("{}\n", factor * (41.0 + (7 * i + i / 10) % 10));
  }
  void run_study(const std::string& more = "") {
    folder_.write("study.yaml", study + more);
    const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "-q"});
    ASSERT_EQ(run.code, 0) << run.err;
  }
};

TEST_F(Monitor, AnswersWithItsFieldsAndExitCodes) {
  write_log("before.csv", 200);
  write_log("same.csv", 200);
  write_log("few.csv", 2);
  write_log("none.csv", 0);
  write_log("slower.csv", 60);
  write_log("slower.csv", 60, 1.3, true);
  EXPECT_EQ(json_of({"monitor", "before.csv", "same.csv"}, 0)["status"], "unchanged");
  EXPECT_EQ(json_of({"monitor", "before.csv", "few.csv"}, 3)["status"], "undecided");
  const Json none = json_of({"monitor", "before.csv", "none.csv"}, 3);
  EXPECT_EQ(none["moves"], 0);
  for (const char* const key : {"measure", "direction", "since", "alarm_at"})
    EXPECT_TRUE(none[key].is_null()) << key;
  const Json slower = json_of({"monitor", "before.csv", "slower.csv"}, 1);
  EXPECT_EQ(slower["status"], "changed");
  EXPECT_EQ(slower["measure"], "arrival_time");
  EXPECT_EQ(slower["direction"], "higher");
  EXPECT_NEAR(slower["since"].get<double>(), 61.0, 10.0);
  EXPECT_GT(slower["alarm_at"], 60);
  EXPECT_EQ(slower["moves"], 120);
  EXPECT_GE(slower["evidence"], 1000.0);
}

// The moves of the file itself are its distribution; its units are those of its export.
TEST_F(Monitor, AcceptsAResultsFileAsTheBaseline) {
  run_study();
  ASSERT_EQ(program({"export", "study.h5", "-o", "tables"}).code, 0);
  const Json same = json_of({"monitor", "study.h5", "tables/outcomes.csv", "--measure", "arrival_time"}, 0);
  EXPECT_EQ(same["baseline_moves"], 400);
  EXPECT_EQ(same["baseline_machines"], 10);
  EXPECT_EQ(same["measures"][0]["baseline"], same["measures"][0]["moves"]);
  EXPECT_EQ(json_of({"monitor", "study.h5", "tables/outcomes.csv", "--machine", "3"}, 3)["baseline_moves"],
            40);
  const std::string text = program({"monitor", "study.h5", "tables/outcomes.csv"}).out;
  EXPECT_TRUE(says(text, "an alarm can mean that the model is wrong"));
}

// A machine that never settles any more writes nothing but line feeds.
TEST_F(Monitor, FindsMovesThatNeverSettleInALogOfOneColumn) {
  write_log("before.csv", 200);
  folder_.write("never.csv", "arrival_time\n" + std::string(100, '\n'));
  const Json never = json_of({"monitor", "before.csv", "never.csv"}, 1);
  EXPECT_EQ(never["moves"], 100);
  EXPECT_EQ(never["direction"], "higher");
}

TEST_F(Monitor, NamesTheMeasuresThatItCallsUnchanged) {
  std::string text = "arrival_time,overshoot,jerk_count\n";
  for (int i = 0; i < 300; ++i)
    text += fmt::format("{},{},0\n", 0.041 + 0.001 * ((7 * i + i / 10) % 10), 10 + (3 * i + i / 7) % 5);
  folder_.write("before.csv", text);
  const std::string said = program({"monitor", "before.csv", "before.csv"}).out;
  EXPECT_TRUE(says(said,
                   "a change of 20 % of the baseline's median (added to each value, or as a factor of it) "
                   "would have been seen with 90 % in arrival_time, overshoot"))
      << said;
  EXPECT_TRUE(says(said, "a proportion cannot change so much: jerk_count")) << said;
}

// Whatever the moves lack is named with its reason: nothing is passed over.
TEST_F(Monitor, NamesTheMeasuresThatItDoesNotJudge) {
  const auto log = [](const std::string& head) {
    std::string text = head + "\n";
    for (int i = 0; i < 300; ++i)
      text += fmt::format("{},{}\n", 0.041 + 0.001 * ((7 * i + i / 10) % 10), 10 + (3 * i + i / 7) % 5);
    return text;
  };
  folder_.write("before.csv", log("arrival_time,overshoot"));
  folder_.write("renamed.csv", log("arrival_time,Over_Shoot"));
  folder_.write("missing.csv", log("arrival_time,day"));
  folder_.write("other.csv", log("Arrival_Time,jerk_count"));
  const std::vector<std::string> renamed{"monitor", "before.csv", "renamed.csv"};
  const std::string said = program(renamed).out;
  EXPECT_TRUE(
      says(said, "would have been seen with 90 % in arrival_time; not judged: overshoot",
           "not judged, because renamed.csv has no such column: overshoot (its column 'Over_Shoot' looks "
           "like it)"))
      << said;
  const Json answer = json_of(renamed, 0);
  EXPECT_EQ(answer["not_judged"],
            Json::parse(R"([{"measure": "overshoot", "why": "missing", "near": "Over_Shoot"}])"));
  EXPECT_EQ(answer["unused"], Json({"Over_Shoot"}));
  const Json missing = json_of({"monitor", "before.csv", "missing.csv"}, 0);
  EXPECT_EQ(missing["not_judged"],
            Json::parse(R"([{"measure": "overshoot", "why": "missing", "near": null}])"));
  EXPECT_TRUE(says(refusal({"monitor", "before.csv", "other.csv"}), "no measure to compare",
                   "the column 'Arrival_Time' of other.csv looks like arrival_time"));
  EXPECT_TRUE(json_of({"monitor", "before.csv", "before.csv"}, 0)["not_judged"].empty());
  EXPECT_TRUE(says(program({"monitor", "renamed.csv", "renamed.csv"}).out,
                   "columns that are not compared: Over_Shoot (looks like overshoot)"));
}

TEST_F(Monitor, ReportsMovesThatRepeatTheBaseline) {
  write_log("before.csv", 100);
  write_log("moves.csv", 150);
  EXPECT_EQ(json_of({"monitor", "before.csv", "moves.csv"})["repeated"], 100);
  EXPECT_TRUE(says(program({"monitor", "before.csv", "moves.csv"}).out,
                   "the first 100 of these moves have the same values as those of the baseline"));
  write_log("moves.csv", 150, 1.01);
  EXPECT_EQ(json_of({"monitor", "before.csv", "moves.csv"})["repeated"], 0);
}

// Compressed files, workbooks and texts in UTF-16 are named, whichever operand they are, and while followed.
TEST_F(Monitor, NamesTheFormatOfALogThatIsNotText) {
  write_log("moves.csv", 20);
  const std::string wide("\xFF\xFEs\0e\0t\0\n\0", 10);
  folder_.write("moves.csv.gz", std::string("\x1F\x8B\x08\0\n\x01", 6));
  folder_.write("moves.xlsx", "PK\x03\x04\x14");
  folder_.write("wide.csv", wide);
  for (const auto& [name, what] :
       {std::pair{"moves.csv.gz", "compressed by gzip, which 'gunzip' unpacks"},
        {"moves.xlsx", "workbook"},
        {"wide.csv", "text in UTF-16, which 'iconv -f UTF-16 -t UTF-8' converts"}}) {
    const std::string wanted = fmt::format("{}: this is ", name);
    EXPECT_TRUE(says(refusal({"monitor", name, "moves.csv"}), wanted, what));
    EXPECT_TRUE(says(refusal({"monitor", "moves.csv", name}), wanted, what));
    EXPECT_TRUE(says(refusal({"monitor", "moves.csv", name, "--follow", "--idle", "20"}), wanted, what));
    EXPECT_TRUE(says(refusal({"identify", name}), wanted, what));
    EXPECT_TRUE(says(refusal({"check", name}), wanted, what));
    EXPECT_TRUE(says(refusal({"summary", name}, 4), "it is not in the HDF5 format, but", what));
  }
  folder_.write("marked.csv",
                "\xEF\xBB\xBF"
                "arrival_time [ms]\n41\n43\n");
  EXPECT_EQ(json_of({"monitor", "moves.csv", "marked.csv"}, 3)["moves"], 2);
}

TEST_F(Monitor, AsksForThePointAndTheCondition) {
  run_study(
      "sweep: {grid: {controller.ki: [2.0e-5, 4.0e-5]}}\nconditions: {empty: {}, loaded: {plant.inertia: "
      "8.0e-4}}\n");
  write_log("moves.csv", 20);
  EXPECT_TRUE(says(program({"monitor", "study.h5", "moves.csv", "--condition", "empty"}).err, "2 points"));
  EXPECT_TRUE(
      says(program({"monitor", "study.h5", "moves.csv", "--point", "1"}).err, "one of empty, loaded"));
  const reading::AllTrialsFile file(folder_.path() / "study.h5");
  const reading::AllTrialsFile loaded = file.in_setting(1);
  const Json answer =
      json_of({"monitor", "study.h5", "moves.csv", "--point", "1", "--condition", "loaded"}, 3);
  EXPECT_EQ(answer["baseline_moves"], loaded.rows_of(1).count * loaded.moves());
  write_log("before.csv", 20);
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--point", "1"}).code, 2);
}

TEST_F(Monitor, FollowingAGrowingLogGivesTheAnswerOfTheWholeLog) {
  write_log("before.csv", 200);
  write_log("moves.csv", 40);
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::seconds(2));  // on a loaded machine the program starts late
    for (int i = 0; i < 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      write_log("moves.csv", 30, 1.3, true);
    }
  });
  const ProgramResult followed = program({"monitor", "before.csv", "moves.csv", "--follow", "--idle", "20"});
  writer.join();
  EXPECT_EQ(followed.code, 1) << followed.err;
  std::vector<Json> lines;
  for (std::size_t at = 0, end = 0; (end = followed.out.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(Json::parse(followed.out.substr(at, end - at)));
  ASSERT_GE(lines.size(), 2);
  EXPECT_EQ(lines.front()["moves"], 40);
  EXPECT_NE(lines.front()["status"], "changed");
  const Json whole = json_of({"monitor", "before.csv", "moves.csv"}, 1);
  for (const char* const key : {"status", "measure", "direction", "since", "alarm_at"})
    EXPECT_EQ(lines.back()[key], whole[key]) << key;
  // Started again, it reads the log from its beginning.
  const ProgramResult again = program({"monitor", "before.csv", "moves.csv", "--follow"});
  EXPECT_EQ(again.code, 1);
  EXPECT_EQ(Json::parse(again.out), whole);
}

TEST_F(Monitor, EndsIfNoNewMovesCome) {
  write_log("before.csv", 200);
  write_log("moves.csv", 3);
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--follow", "--idle", "0"}).code, 3);
  write_log("moves.csv", 0);
  const ProgramResult none = program({"monitor", "before.csv", "moves.csv", "--follow", "--idle", "0"});
  EXPECT_EQ(none.code, 3);
  EXPECT_EQ(Json::parse(none.out, nullptr, false), json_of({"monitor", "before.csv", "moves.csv"}, 3));
  folder_.write("moves.csv", "");
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--follow", "--idle", "0"}).code, 2);
  EXPECT_EQ(program({"monitor", "before.csv", "missing.csv", "--follow"}).code, 2);
}

// What is wrong is said at once, not with the first move.
TEST_F(Monitor, RefusesWrongInputBeforeItFollows) {
  write_log("before.csv", 200);
  write_log("moves.csv", 0);
  folder_.write("other.csv", "overshoot\n");
  const auto followed = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{"monitor", "before.csv"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"--follow", "--idle", "20"});
    const ProgramResult result = program(all);
    EXPECT_EQ(result.code, 2) << result.out;
    return result.err;
  };
  EXPECT_TRUE(says(followed({"moves.csv", "--alarm", "2"}), "--alarm"));
  EXPECT_TRUE(says(followed({"moves.csv", "--change", "0"}), "--change"));
  EXPECT_TRUE(says(followed({"moves.csv", "--measure", "overshoot"}), "no such measure"));
  EXPECT_TRUE(says(followed({"other.csv"}), "no measure to compare"));
  EXPECT_TRUE(says(followed({"."}), "this is a directory"));
}

TEST_F(Monitor, FollowsUntilItIsInterrupted) {
  write_log("before.csv", 200);
  write_log("moves.csv", 30);
  RunningProgram running({"monitor", "before.csv", "moves.csv", "--follow"}, folder_.path(),
                         folder_.path() / "lines.json");
  const auto has_line = [&] {
    std::ifstream file(folder_.path() / "lines.json");
    std::string line;
    return static_cast<bool>(std::getline(file, line));
  };
  for (int i = 0; i < 200 && !has_line(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(has_line());
  running.send(SIGINT);
  EXPECT_EQ(running.wait(), 130);
}

TEST_F(Monitor, ComparesGroupsAndReportsDependentNeighbours) {
  std::string text = "day,arrival_time\n";
  for (int i = 0; i < 240; ++i)
    text += fmt::format("{},{}\n", i / 12, 0.05 + 0.001 * ((7 * (i / 12)) % 5) + 0.0005 * ((11 * i) % 7));
  folder_.write("before.csv", text);
  folder_.write("moves.csv", text.replace(0, 3, "day"));
  const Json by_day = json_of({"monitor", "before.csv", "moves.csv", "--group", "day"}, 0);
  EXPECT_EQ(by_day["group"], "day");
  EXPECT_EQ(by_day["values"], 19) << "the last day may go on";
  EXPECT_TRUE(by_day["unused"].empty());
  const Json by_move = json_of({"monitor", "before.csv", "moves.csv"}, 0);
  EXPECT_LE(by_move["measures"][0]["dependence"], 0.01);
  EXPECT_TRUE(says(program({"monitor", "before.csv", "moves.csv"}).out, "neighbours resemble each other"));
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--group", "shift"}).code, 2);
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--group", "day", "--block", "2"}).code, 2);
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--unchanged", "friction"}).code, 2)
      << "a log has no parameters";
}

// A study knows the targets of its moves, whatever the log calls them in.
TEST_F(Monitor, ComparesMovesWithEqualMovesOfAStudy) {
  folder_.write("study.yaml", R"(zerocount: 1
name: monitored
seed: 5
trials: 60
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {targets: [2, -60], hold: 0.2}
)");
  ASSERT_EQ(program({"run", "study.yaml", "-o", "study.h5", "-q"}).code, 0);
  ASSERT_EQ(program({"export", "study.h5", "-o", "tables"}).code, 0);
  const Json by_move =
      json_of({"monitor", "study.h5", "tables/outcomes.csv", "--measure", "arrival_time"}, 0);
  EXPECT_EQ(by_move["alike"], "move");
  EXPECT_EQ(by_move["unlike"], 0);
  ASSERT_EQ(by_move["likes"].size(), 2) << by_move;
  EXPECT_EQ(by_move["likes"][0]["baseline"], by_move["likes"][0]["median"]);
  EXPECT_TRUE(by_move["measures"][0]["baseline"].is_null());
  // One count is 2π/1620000 rad.
  folder_.write("moves.csv", "target [rad],arrival_time\n7.757e-06,0.05\n-2.3271e-04,0.05\n7.757e-05,0.05\n");
  const Json by_target = json_of({"monitor", "study.h5", "moves.csv"}, 3);
  EXPECT_EQ(by_target["alike"], "target and direction");
  EXPECT_EQ(by_target["values"], 1) << "the first move is from where is not known";
  // The history keeps what is comparable: the median of each like.
  folder_.write("answer.json", by_move.dump());
  ASSERT_EQ(program({"history", "add", "answer.json"}).code, 0);
  const std::string shown = program({"history", "show"}).out;
  EXPECT_TRUE(says(shown, "outcomes.csv, move 0"));
}

TEST_F(Monitor, AsksForTheAge) {
  run_study("ages: {at: [0, 100000]}\n");
  write_log("moves.csv", 20);
  EXPECT_TRUE(says(refusal({"monitor", "study.h5", "moves.csv"}), "100000"));
  EXPECT_EQ(program({"monitor", "study.h5", "moves.csv", "--age", "7"}).code, 2);
  EXPECT_EQ(json_of({"monitor", "study.h5", "moves.csv", "--age", "100000"}, 3)["baseline_moves"], 200);
  write_log("before.csv", 20);
  EXPECT_EQ(program({"monitor", "before.csv", "moves.csv", "--age", "0"}).code, 2);
}

// A machine like those of the study, and then the same machine with a softer contact.
TEST_F(Monitor, NamesTheParameterThatChanged) {
  folder_.write("study.yaml", R"(zerocount: 1
name: monitored
seed: 5
trials: 400
machines: 20
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [108, 112]}, alpha: 0.5}
command: {targets: [{integers: [5, 30]}, {integers: [-30, -5]}], hold: 0.2}
)");
  ASSERT_EQ(program({"run", "study.yaml", "-o", "study.h5", "-q"}).code, 0);
  /// The moves of a machine that has these settings from the move 241 on.
  const auto log_with = [&](const std::vector<std::string>& changed) {
    std::string log;
    for (const auto& settings : {std::vector<std::string>{"friction.k1=110", "seed=71"}, changed}) {
      std::vector<std::string> words{"run", "study.yaml", "-o",    "one.h5",
                                     "-q",  "--force",    "--set", "trials=120"};
      for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
      EXPECT_EQ(program(words).code, 0);
      EXPECT_EQ(program({"export", "one.h5", "-o", "tables", "--force"}).code, 0);
      std::ifstream file(folder_.path() / "tables/outcomes.csv");
      std::string line;
      for (bool first = true; std::getline(file, line); first = false)
        if (!first || log.empty()) log += line + "\n";
    }
    return log;
  };
  folder_.write("deadband.csv", log_with({"friction.k1=110", "controller.deadband=2", "seed=72"}));
  const Json deadband = json_of({"monitor", "study.h5", "deadband.csv"}, 1);
  ASSERT_FALSE(deadband["parameters"].empty()) << deadband;
  EXPECT_TRUE(says(deadband["parameters"].dump(), "controller.deadband.enter")) << deadband["parameters"];
  folder_.write("moves.csv", log_with({"friction.k1=88", "seed=72"}));
  const Json answer = json_of({"monitor", "study.h5", "moves.csv"}, 1);
  ASSERT_FALSE(answer["parameters"].empty()) << answer;
  EXPECT_NEAR(answer["parameters_since"].get<double>(), 241.0, 12.0);
  EXPECT_EQ(answer["parameters"][0]["parameter"], "friction.k1") << answer["parameters"];
  EXPECT_NEAR(answer["parameters"][0]["factor"].get<double>(), 0.8, 0.05);
  EXPECT_LT(answer["parameters"][0]["high"], 1.0);
  // What cannot have changed is not named.
  const Json known =
      json_of({"monitor", "study.h5", "moves.csv", "--unchanged", "friction.k1,encoder.noise"}, 1);
  for (const auto& tried : known["tried"]) {
    EXPECT_NE(tried, "friction.k1");
    EXPECT_NE(tried, "encoder.fine_errors.noise");
  }
  EXPECT_EQ(std::ranges::count(answer["tried"], "controller.deadband.enter"), 1);
  EXPECT_TRUE(says(refusal({"monitor", "study.h5", "moves.csv", "--unchanged", "friction.k3"}),
                   "'friction.k3' is not among the parameters that are tried"));
  // The alarm does not wait for what a budget is too small for. What would have been enough is said.
  const auto within = [&](std::int64_t trials) {
    return json_of({"monitor", "study.h5", "moves.csv", "--budget", fmt::format("{}", trials)}, 1);
  };
  const Json unexplained = within(10);
  EXPECT_EQ(unexplained["status"], answer["status"]);
  EXPECT_EQ(unexplained["told"], "unknown");
  EXPECT_TRUE(unexplained["tried"].empty()) << unexplained;
  const std::string text = program({"monitor", "study.h5", "moves.csv", "--budget", "10"}).out;
  const std::size_t at = text.find("all parameters take at most ");
  ASSERT_NE(at, std::string::npos) << text;
  const std::int64_t enough = std::stoll(text.substr(at + 28));
  const Json some = within(enough / 10);
  EXPECT_FALSE(some["tried"].empty()) << "a parameter within the budget is tried";
  EXPECT_FALSE(some["untried"].empty());
  EXPECT_NE(some["told"], "one") << "another may explain it as well";
  EXPECT_EQ(within(enough), answer) << "without a budget there are as many trials, on any computer";
  // A log as the baseline has no parameters.
  write_log("before.csv", 200);
  write_log("slower.csv", 200, 1.3);
  EXPECT_TRUE(json_of({"monitor", "before.csv", "slower.csv"}, 1)["told"].is_null());
}

// A log that another process writes, replaces, moves or cuts.

using result_commands::GrowingLog;

std::string rows(int moves, int value) {
  std::string text;
  for (int i = 0; i < moves; ++i) text += fmt::format("{}.{},{}\n", value, i % 10, i % 3);
  return text;
}

const std::string head = "arrival_time [ms],overshoot\n";

class GrowingLogTest : public ::testing::TestWithParam<bool> {
 protected:
  /// Writes the log: in place, or as another file that replaces it.
  void write(const std::string& text) {
    folder_.write(GetParam() ? "moves.csv" : "new.csv", text);
    if (!GetParam()) std::filesystem::rename(folder_.path() / "new.csv", folder_.path() / "moves.csv");
  }
  /// The message, with the exit code, of the next reading after this text has replaced the log.
  std::string refusal(const std::string& text) {
    write(head + rows(30, 40));
    GrowingLog log(folder_.path() / "moves.csv");
    EXPECT_TRUE(log.read());
    EXPECT_FALSE(log.read());
    write(text);
    try {
      log.read();
    } catch (const Failure& failure) {
      return fmt::format("{}{}", static_cast<int>(failure.code()),
                         std::string(failure.what()).substr((folder_.path() / "moves.csv").string().size()));
    }
    return fmt::format("{} moves", log.log().moves);
  }

  TemporaryFolder folder_;
};

TEST_P(GrowingLogTest, RefusesAnotherLog) {
  EXPECT_EQ(refusal(head + rows(5, 41) + rows(60, 40)),
            "4: another log took its place after 30 moves; expected a file that only grows");
  EXPECT_EQ(refusal("overshoot,arrival_time [ms]\n" + rows(60, 1)),
            "4:1: the line became 'overshoot,arrival_time [ms]' while the log was followed; expected "
            "'arrival_time [ms],overshoot', as it was");
  EXPECT_EQ(refusal("arrival_time [s],overshoot\n" + rows(60, 40)),
            "4:1: the line became 'arrival_time [s],overshoot' while the log was followed; expected "
            "'arrival_time [ms],overshoot', as it was");
  EXPECT_EQ(refusal(head + rows(5, 40)),
            "4: became shorter while it was followed; expected a file that only grows");
  EXPECT_EQ(refusal(""), "4: became shorter while it was followed; expected a file that only grows");
  // Far from the beginning: only the last rows that were read differ.
  EXPECT_EQ(refusal(head + rows(29, 40) + rows(60, 50)),
            "4: another log took its place after 30 moves; expected a file that only grows");
}

// As rsync copies a log that grows: each copy is another file.
TEST_P(GrowingLogTest, ContinuesIfTheFileStillBeginsWithWhatWasRead) {
  EXPECT_EQ(refusal(head + rows(30, 40) + rows(7, 45)), "37 moves");
  EXPECT_EQ(refusal(head + rows(30, 40)), "30 moves");
  // A longer log than what is compared, and a last line that was not complete.
  write(head + rows(5000, 40) + "40.");
  GrowingLog log(folder_.path() / "moves.csv");
  EXPECT_TRUE(log.read());
  write(head + rows(5000, 40) + "41.5,2\n" + rows(3, 40));
  EXPECT_TRUE(log.read());
  EXPECT_EQ(log.log().moves, 5004);
  write(head + rows(4999, 40) + "39.9,1\n41.5,2\n" + rows(9, 40));
  EXPECT_THROW(log.read(), Failure);
}

INSTANTIATE_TEST_SUITE_P(InPlaceAndMoved, GrowingLogTest, ::testing::Bool());

}  // namespace
}  // namespace zerocount::testing
