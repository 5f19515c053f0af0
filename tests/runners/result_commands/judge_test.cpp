// Error bands and the goal, from the manifest to the answer of `judge`.

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/chosen_summary.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::testing {
namespace {

class Judge : public ProgramTest {
 protected:
  void run_study(const std::string& more, int trials = 40, const std::string& output = "out.h5") {
    folder_.write("study.yaml", small_manifest(trials, more));
    const ProgramResult result = program({"run", "study.yaml", "-o", output, "--force"});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

// The converter is too weak in 9 of 20 trials. A goal that none meets is not missed for that reason.
TEST_F(Judge, NamesSaturationIfTheMovesThatMissSaturate) {
  const std::string axis =
      "zerocount: 1\nname: slide\naxis: linear\nseed: 1\ntrials: 20\nplant: {inertia: 1, sliding_damping: "
      "1}\n"
      "friction: {model: coulomb, breakaway: 1, coulomb_ratio: 1, stribeck_velocity: 1.0e-3}\n"
      "encoder: {resolution: 1.0e-6}\ncommand: {targets: [20000], hold: 0.5}\n"
      "controller: {units: si, sample_rate: 4000, kp: 1.0e+4, ki: 2.0e+4, kd: 180}\n"
      "dac: {bits: 24, range: {choice: [2, 400]}}\n";
  const auto judged = [&](const std::string& within) {
    folder_.write("slide.yaml", axis + "goal: {band: 700, within: " + within + ", moves: 0.9}\n");
    EXPECT_EQ(program({"run", "slide.yaml", "-o", "slide.h5", "--force"}).code, 0);
    return std::pair(program({"judge", "slide.h5"}).out, json_of({"judge", "slide.h5"}));
  };
  const auto [weak, of_weak] = judged("0.2");
  EXPECT_EQ(of_weak["missed_saturated"], 1.0) << weak;
  EXPECT_TRUE(says(weak, "9 moves that miss the goal 9 saturate (of the 11 others 0): the converter clips"));
  const auto [hasty, of_hasty] = judged("0.001");
  EXPECT_LT(of_hasty["missed_saturated"], 0.5) << hasty;
  EXPECT_FALSE(says(hasty, "saturate"));
}

/// A velocity loop without friction, which vibration disturbs under the condition "shaken" in some moves: all
/// moves meet the goal under "empty", and the faster the loop the more under "shaken".
std::string shaken_axis(int machines, const std::string& more = "") {
  return fmt::format(
      "zerocount: 1\nname: shelf\nseed: 4\nmachines: {}\ntrials: {}\n"
      "plant: {{inertia: {{uniform: [1.8e-4, 2.2e-4]}}, presliding_damping: 2.0e-3}}\n"
      "friction: {{model: none}}\nencoder: {{fine: 100000}}\ndac: {{bits: 18, range: 4}}\n"
      "controller: {{sample_rate: 4000, delay: 1, structure: cascade, cascade: {{kv: 40, kp: 0.03, ki: "
      "0.3}}}}\n"
      "command: {{targets: [{{integers: [400, 900]}}], hold: 0.4}}\n"
      "goal: {{band: 8, within: 0.3, moves: 0.5}}\n"
      "disturbance: {{vibration: [{{amplitude: 0, frequency: 15, phase: {{uniform: [0, 6.28]}}}}]}}\n"
      "conditions:\n  empty: {{}}\n"
      "  shaken: {{disturbance.vibration.0.amplitude: {{choice: [0, 0, 0, 0, 0, 0, 0, 0.006, 0.006, "
      "0.006]}}}}\n{}",
      machines, 100 * machines, more);
}

// Few machines bound the proportion of all machines alike under both conditions, whatever their moves do.
TEST_F(Judge, WithFewMachinesTheConditionWithMissesIsTheWorst) {
  folder_.write("shelf.yaml", shaken_axis(5));
  ASSERT_EQ(program({"run", "shelf.yaml", "-o", "shelf.h5", "--quiet"}).code, 0);
  const Json judged = json_of({"judge", "shelf.h5"});
  EXPECT_EQ(judged["worst_condition"], "shaken") << judged;
  const Json& of_shaken = judged["claims"][1];
  ASSERT_EQ(of_shaken["condition"], "shaken");
  EXPECT_EQ(judged["claims"][0]["rate"], 1.0);
  ASSERT_LT(of_shaken["rate"], 1.0);
  ASSERT_NE(of_shaken["settling_time_p95"], judged["claims"][0]["settling_time_p95"]);
  const Json goal = json_of({"summary", "shelf.h5"})["points"][0]["goal"];
  EXPECT_EQ(goal["condition"], "shaken");
  for (const char* const key : {"rate", "rate_low", "rate_high"}) {
    EXPECT_EQ(judged[key], of_shaken[key]) << key;
    EXPECT_EQ(goal[key], of_shaken[key]) << key;
  }
  const std::string table = program({"summary", "shelf.h5"}).out;
  const std::size_t row = table.find("\nall ");
  ASSERT_NE(row, std::string::npos) << table;
  const std::string line = table.substr(row + 1, table.find('\n', row + 1) - row - 1);
  EXPECT_TRUE(says(line, "shaken")) << line;
  EXPECT_TRUE(says(line, of_shaken.value("settling_time_p95", Json()).is_null() ? "> 0.4 s" : "0.")) << line;
}

// However few the machines are.
TEST_F(Judge, TheBestPointHasTheHighestRateForAnyNumberOfMachines) {
  for (const int machines : {2, 3, 5, 10, 20}) {
    folder_.write("points.yaml", shaken_axis(machines,
                                             "sweep: {cases: {soft: {}, stiff: {controller.cascade.kp: 0.2, "
                                             "controller.cascade.kv: 80}}}\n"));
    ASSERT_EQ(program({"run", "points.yaml", "-o", "points.h5", "--quiet", "--force"}).code, 0);
    const Json judged = json_of({"judge", "points.h5"});
    EXPECT_EQ(judged["label"], "stiff") << machines << " machines: " << judged;
  }
}

TEST_F(Judge, AnswersFromKeptStatisticsEqualThoseFromTrials) {
  const std::string more = "machines: 8\ngoal: {band: 3, within: 0.1, moves: 0.6, machines: 0.5}\n";
  run_study(more);
  run_study(more + "keep: statistics\n", 40, "sums.h5");
  for (const char* command : {"summary", "judge"}) {
    Json kept = json_of({command, "out.h5"}), sums = json_of({command, "sums.h5"});
    EXPECT_EQ(kept, sums) << command;
    EXPECT_FALSE(kept.is_discarded());
  }
  const Json point = json_of({"summary", "sums.h5"})["points"][0];
  ASSERT_EQ(point["bands"].size(), 3U);
  EXPECT_EQ(point["bands"][2]["band"], 3);
  EXPECT_EQ(point["bands"][0]["settling_time"]["median"], point["final_settling_time"]["median"]);
  EXPECT_EQ(point["bands"][0]["entry_time"]["p95"], point["arrival_time"]["p95"]);
  EXPECT_EQ(point["bands"][0]["exits"]["total"], point["jerk_count"]["total"]);
}

// `judge` computes all statistics of the chosen point only.
TEST_F(Judge, ChoosesAndJudgesAsIfAllStatisticsOfAllPointsWereKnown) {
  const std::vector<std::string> studies{
      "goal: {band: 1, within: 0.1, moves: 0.6}\n",
      "goal: {band: 1, within: 0.1, moves: 0.6}\nkeep: statistics\n",
      "machines: 8\ngoal: {band: 3, within: 0.1, moves: 0.6, machines: 0.5}\n",
      "machines: 8\nkeep: statistics\ngoals:\n  near: {band: 1, within: 0.1, moves: 0.6, machines: 0.5}\n"
      "  calm: {band: 2, within: 0.12, moves: 0.5, machines: 0.5, limits: {jerk_count: 3}}\n",
      "conditions: {cold: {}, warm: {plant.presliding_damping: 0.4}}\n"
      "goal: {band: 1, within: 0.1, moves: 0.6}\n"};
  for (const std::string& more : studies) {
    run_study(more);
    const std::filesystem::path path = folder_ / "out.h5";
    const summary::StudySummary whole = summary::summarise_file(path);
    for (const std::optional<std::int64_t> point : {std::optional<std::int64_t>(), {0}, {1}}) {
      const summary::ChosenSummary found = summary::summarise_chosen(path, point);
      const summary::ChosenPoint chosen = summary::choose_point(whole, point);
      EXPECT_EQ(found.chosen.point, chosen.point) << more;
      EXPECT_EQ(found.chosen.runner_up, chosen.runner_up) << more;
      EXPECT_EQ(found.chosen.as_good, chosen.as_good) << more;
      EXPECT_EQ(summary::judgement_text(found.summary, summary::judge_point(found.summary, found.chosen)),
                summary::judgement_text(whole, summary::judge_point(whole, chosen)))
          << more;
    }
  }
}

/// Random moves along trapezoidal references, and the durations of these references by their closed form.
struct ProfiledMoves {
  explicit ProfiledMoves(unsigned seed) : draws(seed) {}
  Draws draws;
  double velocity{draws.uniform(0.01, 0.04)};
  double acceleration{draws.uniform(0.3, 2.0)};
  double allowed{draws.uniform(0.01, 0.06)};

  double duration(double counts) const {
    const double angle = counts * 2.0 * std::numbers::pi / 1'620'000.0;
    const double peak = std::min(velocity, std::sqrt(acceleration * angle));
    return angle / peak + peak / acceleration;
  }
  std::string manifest(const std::string& targets, const std::string& goal) const {
    return fmt::format(
        "zerocount: 1\nname: profiled\nseed: 3\ntrials: 60\nmachines: 6\n"
        "friction: {{k1: {{uniform: [70, 150]}}, alpha: 0.5}}\ncontroller: {{sample_rate: 2000, ki: "
        "4.0e-5}}\n"
        "command: {{targets: {}, hold: 0.4, profile: {{shape: trapezoidal, velocity_limit: {}, "
        "acceleration_limit: {}}}}}\ngoal: {{band: 1, {}, moves: 0.9}}\n",
        targets, velocity, acceleration, goal);
  }
};

TEST_F(Judge, TimeAfterTheProfileCountsFromTheProfileOfEachMove) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    ProfiledMoves moves(seed);
    const std::int64_t first = moves.draws.integer(20, 300), second = moves.draws.integer(20, 300);
    folder_.write("study.yaml", moves.manifest(fmt::format("[{}, {}]", first, first + second),
                                               fmt::format("after_profile: {}", moves.allowed)));
    ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5", "--force"}).code, 0);
    const reading::AllTrialsFile file(folder_.path() / "out.h5");
    const std::vector<double> times = file.measure("band_settling_time[1]", file.rows());
    std::vector<double> allowed;
    for (const std::int64_t counts : {first, second})
      allowed.push_back(moves.duration(static_cast<double>(counts)) + moves.allowed);
    std::int64_t met = 0;
    for (std::size_t i = 0; i < times.size(); ++i) met += times[i] <= allowed[i % 2] + 1e-9;
    const Json claim = json_of({"judge", "out.h5"})["claims"][0];
    EXPECT_EQ(claim["met"], met) << seed;
    EXPECT_NEAR(claim["within"].get<double>(), std::ranges::max(allowed), 1e-9);
  }
}

// Of moves of one length the goal is that with the time from their start, in whatever is said of it.
TEST_F(Judge, EqualProfilesGiveOneTimeFromTheStart) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    ProfiledMoves moves(seed);
    const std::int64_t counts = moves.draws.integer(20, 300);
    const double whole = moves.duration(static_cast<double>(counts)) + moves.allowed;
    const auto answers = [&](const std::string& time) {
      folder_.write("study.yaml", moves.manifest(fmt::format("[{}, 0, {}]", counts, -counts), time));
      EXPECT_EQ(program({"run", "study.yaml", "-o", "out.h5", "--force"}).code, 0);
      Json judged = json_of({"judge", "out.h5"}), summary = json_of({"summary", "out.h5"});
      judged.erase("goal");
      judged["claims"][0]["within"] = std::round(judged["claims"][0]["within"].get<double>() * 1e9);
      summary.erase("goal");
      return std::pair(judged, summary["points"]);
    };
    EXPECT_EQ(answers(fmt::format("after_profile: {}", moves.allowed)),
              answers(fmt::format("within: {:.17g}", whole)));
  }
}

// The goal of the motor beside the same of the load, each counted again from the measures of its mass.
TEST_F(Judge, WithTwoMassesNamesTheMassAndShowsTheLoad) {
  const auto run = [&](const std::string& encoder, const std::string& of) {
    folder_.write(
        "joint.yaml",
        "zerocount: 1\nname: joint\nseed: 7\ntrials: 60\nmachines: 20\n"
        "plant: {inertia: 0.5, sliding_damping: 1, load: {inertia: {uniform: [0.5, 2]}, stiffness: "
        "2.0e+4, damping: 5, encoder: " +
            encoder +
            "}}\nfriction: {model: lugre, breakaway: 5, coulomb_ratio: 0.8, stribeck_velocity: 0.01, "
            "sigma0: 1.0e+5, sigma1: 100}\nencoder: {fine: 1000000}\n"
            "command: {units: si, targets: [0.1, 0.0, 0.02], hold: 0.6, profile: {shape: "
            "trapezoidal, velocity_limit: 1, acceleration_limit: 20}}\n"
            "controller: {units: si, sample_rate: 4000, kp: 3.0e+4, ki: 3.0e+5, kd: 300}\n"
            "dac: {bits: 20, range: 200}\n"
            "goal: {tolerance: 5.0e-4, after_profile: 0.15, moves: 0.9, limits: {true_overshoot: "
            "5.0e-3}" +
            of + "}\n");
    EXPECT_EQ(program({"run", "joint.yaml", "-o", "joint.h5", "-q", "--force"}).code, 0);
    return json_of({"judge", "joint.h5"});
  };
  const auto rate = [&](const std::string& mass) {
    const reading::AllTrialsFile file(folder_.path() / "joint.h5");
    const std::vector<double> times = file.measure(mass + "tolerance_settling_time[0.0005]", file.rows());
    const std::vector<double> overshoot = file.measure(mass + "true_overshoot", file.rows());
    const std::vector<double> travel = file.measure("travel_time", file.rows());
    double met = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i)
      met += times[i] <= travel[i] + 0.15 + 1e-9 && overshoot[i] <= 5e-3 ? 1.0 : 0.0;
    return met / static_cast<double>(times.size());
  };
  const Json motor = run("motor", "");
  EXPECT_EQ(motor["rate"], rate(""));
  EXPECT_EQ(motor["other_mass"]["of"], "load");
  EXPECT_EQ(motor["other_mass"]["rate"], rate("load_"));
  EXPECT_NE(motor["other_mass"]["rate"], motor["rate"]) << "else the test shows nothing";
  EXPECT_TRUE(says(motor["headline"].get<std::string>(), "the goal of the motor"));
  EXPECT_EQ(json_of({"summary", "joint.h5"})["points"][0]["goal"]["other_mass"], motor["other_mass"]);
  EXPECT_TRUE(says(program({"check", "joint.yaml"}).err, "the load behind it may be elsewhere"));
  const Json load = run("motor", ", of: load");
  EXPECT_EQ(load["rate"], motor["other_mass"]["rate"]);
  EXPECT_FALSE(load.contains("other_mass"));
  EXPECT_TRUE(says(load["goal"].get<std::string>(), "|position error of the load|"));
  const Json at_load = run("load", ", of: motor");
  EXPECT_EQ(at_load["rate"], rate("motor_"));
  EXPECT_EQ(at_load["other_mass"]["rate"], rate(""));
  // The load's measures have another name in each of these files.
  run("motor", ", of: load");
  std::filesystem::copy(folder_.path() / "joint.h5", folder_.path() / "motor.h5");
  run("load", ", of: load");
  const ProgramResult compared = program({"compare", "motor.h5", "joint.h5"});
  EXPECT_TRUE(says(compared.out, "position error of the load")) << compared.err;
}

TEST_F(Judge, EndsWithTheCodeOfTheVerdict) {
  struct Case {
    const char* goal;
    const char* status;
    int code;
  };
  for (const Case& one : {Case{"{band: 1000, within: 0.14, moves: 0.8}", "met", 0},
                          Case{"{band: 0, within: 0.0005, moves: 0.99}", "missed", 1},
                          Case{"{band: 1000, within: 0.14, moves: 0.999}", "undecided", 3}}) {
    run_study(std::string("goal: ") + one.goal + "\n");
    const Json judged = json_of({"judge", "out.h5"});
    EXPECT_EQ(judged["status"], one.status) << judged;
    EXPECT_EQ(program({"judge", "out.h5"}).code, one.code);
    EXPECT_EQ(judged["needed"].is_null(), one.code != 3) << judged;
    const Json of_point =
        json_of({"summary", "out.h5"})["points"][judged["point"].get<std::size_t>()]["goal"];
    EXPECT_EQ(of_point["rate"], judged["rate"]);
    EXPECT_GE(of_point["rate_low"], judged["rate_low"]);  // it was not chosen
    const Json alone = json_of({"judge", "out.h5", "--point", judged["point"].dump()});
    EXPECT_EQ(of_point["rate_low"], alone["rate_low"]);
    EXPECT_EQ(of_point["status"], alone["status"]);
  }
}

TEST_F(Judge, NeedsAGoalAndAFinishedFile) {
  run_study("");
  EXPECT_TRUE(says(refusal({"judge", "out.h5"}), "no goal; expected"));
  EXPECT_EQ(program({"judge", "out.h5", "--point", "2"}).code, 2);
  run_study("goal: {within: 0.1, moves: 0.9}\n");
  EXPECT_EQ(program({"judge", "out.h5", "--point", "2"}).code, 2);
  ASSERT_EQ(program({"run", "study.yaml", "-o", "part.h5", "--shard", "1/2"}).code, 0);
  EXPECT_EQ(program({"judge", "part.h5"}).code, 4);
  std::filesystem::create_directory(folder_.path() / "begun.h5.shards");
  ASSERT_EQ(program({"run", "study.yaml", "-o", "begun.h5.shards/first.h5", "--shard", "1/2"}).code, 0);
  EXPECT_TRUE(says(refusal({"judge", "begun.h5"}, 4), "begun.h5: unfinished"));
}

TEST_F(Judge, PlansTheStudyThatDecidesTheGoal) {
  run_study("goal: {band: 1, within: 0.05, moves: 0.99}\n");
  const Json plan = json_of({"plan", "study.yaml"});
  EXPECT_GT(plan["plans"][0]["trials"].get<int>(), 40) << plan;
  const Json of_pilot = json_of({"plan", "out.h5"});
  const Json judged = json_of({"judge", "out.h5"});
  EXPECT_EQ(of_pilot["status"], judged["status"]);
  EXPECT_EQ(of_pilot["needed"], judged["needed"]);
  const Json set = json_of({"plan", "study.yaml", "--set", "goal.moves=0.5"});
  EXPECT_LT(set["plans"][0]["trials"], plan["plans"][0]["trials"]);
  run_study("");
  for (const char* operand : {"study.yaml", "out.h5"})
    EXPECT_TRUE(says(refusal({"plan", operand}), "its manifest has no goal"));
}

// A goal is the question of its study: every command speaks of it first, and of success where there is none.

constexpr double within = 0.03;

/// Many moves that stay within two counts from 30 ms on do not end at zero counts: jerks disturb them.
std::string manifest_with(const std::string& goal) {
  return R"(zerocount: 1
name: question
seed: 7
trials: 48
machines: 12
worlds: 4
friction:
  k1: {lognormal: {median: 110, cv: 0.3}}
  alpha: {log_uniform: [0.1, 2.0], per: world}
command: {targets: [{integers: [1, 30]}, {integers: [1, 30]}], hold: 0.2}
initial: {encoder_phase: {uniform: [0, 1]}}
sweep: {grid: {controller.ki: [3.85e-5, 9.45e-5]}}
)" + goal;
}

/// A study with a goal of ±2 counts ("goal") and the same without one ("success"), run once.
class QuestionOfAStudy : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    folder->write("goal.yaml", manifest_with(fmt::format(
                                   "goal: {{band: 2, within: {}, moves: 0.9, machines: 0.8}}\n", within)));
    folder->write("success.yaml", manifest_with(""));
    for (const std::string name : {"goal", "success"}) {
      ASSERT_EQ(run({"run", name + ".yaml", "-o", name + ".h5"}).code, 0);
      ASSERT_EQ(run({"history", "add", name + ".h5", "--database", name + ".sqlite"}).code, 0);
      const std::string shards = name + "-begun.h5.shards";
      std::filesystem::create_directory(*folder / shards);
      ASSERT_EQ(run({"run", name + ".yaml", "-o", shards + "/first.h5", "--shard", "1/2"}).code, 0);
    }
  }
  static void TearDownTestSuite() { delete folder; }
  static ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder->path());
  }
  /// Runs a command about the study `name`; @ in its words stands for the name.
  static ProgramResult say(std::vector<std::string> words, const std::string& name) {
    for (std::string& word : words) {
      if (const std::size_t at = word.find('@'); at != std::string::npos) word.replace(at, 1, name);
    }
    ProgramResult result = run(words);
    if (words.front() == "report") {
      const std::string page = read_bytes(folder->path() / words.back());
      const std::size_t begin = page.find("<main");
      result.out = page.substr(begin, page.find("</main>") - begin);
    }
    return result;
  }

  static inline TemporaryFolder* folder = nullptr;
};

struct Answer {
  std::vector<std::string> words;
  std::vector<std::string> of_goal;  ///< texts that the answer about the study with a goal contains
  /// Texts that the answer about the study without a goal contains; empty: the command refuses that study.
  std::vector<std::string> of_success;
};

const std::vector<Answer> answers{
    {{"check", "@.yaml"}, {" the goal: |error| ≤ 2 counts"}, {" success: all moves"}},
    {{"judge", "@.h5"}, {"goal: |error| ≤ 2 counts"}, {}},
    {{"plan", "@.h5"}, {"goal: |error| ≤ 2 counts"}, {}},
    {{"plan", "@.yaml"}, {"goal: |error| ≤ 2 counts"}, {}},
    {{"summary", "@.h5"},
     {"machines in goal (worst world)", "machines w/o miss", "machines in goal worst", "zero-count"},
     {"zero-count", "machines w/o failure", "zero-count worst"}},
    {{"summary", "@.h5", "--confirm", "12"}, {"moves in goal"}, {"succeeded"}},
    {{"status", "@-begun.h5"}, {"moves in goal", "the goal is"}, {"zero-count"}},
    {{"sensitivity", "@.h5", "--point", "0"},
     {"all moves met the goal", "goal_settling_time (s)"},
     {"all moves ended at zero counts", "arrival_time (s)"}},
    {{"compare", "@.h5", "--points", "0", "1"},
     {"goal_rate", "goal_machines"},
     {"success_rate", "jerk_count"}},
    {{"history", "show", "--database", "@.sqlite"}, {"goal_rate", "goal_machines"}, {"success_rate"}},
    {{"learn", "@.h5"}, {"fall short of the goal"}, {"succeed less often"}},
    {{"limits", "@.yaml", "--point", "0"},
     {"of the machines meet the goal"},
     {"of the moves end at zero counts"}},
    {{"worst", "@.yaml", "--point", "0", "--set", "command.hold=0.06"},
     {"of its moves meet the goal"},
     {"of its moves end at zero counts"}},
    {{"rare", "@.yaml", "-o", "@-rare.h5", "--point", "0", "--world", "0", "--budget", "300"},
     {"a move misses the goal: |error| ≤ 2 counts for good"},
     {"a move does not end at zero counts"}},
    {{"report", "@.h5", "-o", "@.html"},
     {"whether the goal is met", "machines in goal", "machines w/o miss",
      "Which design points meet the goal?"},
     {"machines w/o failure", "How many trials succeed?"}},
};

/// Offset in the text of the first occurrence of any of these words.
std::size_t first_of(const std::string& text, const std::vector<std::string>& words) {
  std::size_t first = std::string::npos;
  for (const std::string& word : words) first = std::min(first, text.find(word));
  return first;
}

TEST_F(QuestionOfAStudy, EveryCommandAnswersItFirst) {
  const std::vector<std::string> words_of_success{"zero-count", "zero count", "success", "succeed",
                                                  "failure"};
  for (const Answer& answer : answers) {
    const std::string command = fmt::format("{} {}", answer.words[0], answer.words[1]);
    const ProgramResult of_goal = say(answer.words, "goal");
    EXPECT_LE(of_goal.code, 3) << command << of_goal.err;
    EXPECT_NE(of_goal.code, 2) << command << of_goal.err;
    for (const std::string& said : answer.of_goal)
      EXPECT_TRUE(says(of_goal.out, said)) << command << ": " << said << "\n" << of_goal.out.substr(0, 2000);
    EXPECT_LT(first_of(of_goal.out, {"goal"}), first_of(of_goal.out, words_of_success)) << command;
    const ProgramResult of_success = say(answer.words, "success");
    EXPECT_EQ(of_success.code == 2, answer.of_success.empty()) << command << of_success.err;
    if (answer.of_success.empty()) {
      EXPECT_TRUE(says(of_success.err, "no goal")) << command;
    }
    for (const std::string& said : answer.of_success)
      EXPECT_TRUE(says(of_success.out, said)) << command << ": " << said << "\n"
                                              << of_success.out.substr(0, 2000);
    EXPECT_EQ(first_of(of_success.out, {"the goal", "in goal", "goal_"}), std::string::npos)
        << command << "\n"
        << of_success.out.substr(0, 2000);
  }
}

TEST_F(QuestionOfAStudy, DecidesWhichTrialsAndMachinesFailed) {
  for (const std::string name : {"goal", "success"}) {
    const reading::AllTrialsFile file(folder->path() / (name + ".h5"));
    const report::ReportedStudy reported = report::reported_study(file);
    const std::int64_t point = reported.chosen.point;
    const std::vector<trial::MoveOutcome> moves = file.outcomes(file.rows_of(point));
    // Literally: the third band is that of ±2 counts.
    const auto fails = [&](const trial::MoveOutcome& move) {
      return name == "goal" ? !(move.bands[2].settling_time <= within * (1.0 + 1e-12))
                            : move.outcome != trial::Outcome::zero_count;
    };
    std::map<std::int64_t, std::int64_t> failed;  // [trial] of its moves
    std::array<bool, 12> machine_failed{};
    for (std::size_t i = 0; i < moves.size(); ++i) {
      if (!fails(moves[i])) continue;
      ++failed[static_cast<std::int64_t>(i / 2)];
      machine_failed[i / 2 % 12] = true;
    }
    ASSERT_FALSE(failed.empty()) << name;
    const goal::MachinesWithoutFailure machines = goal::machines_without_failure(
        reported.summary.question, reported.summary.points[static_cast<std::size_t>(point)]);
    EXPECT_EQ(machines.of, 12);
    EXPECT_EQ(machines.machines, std::ranges::count(machine_failed, false)) << name;
    const std::int64_t most =
        std::ranges::max_element(failed, {}, [](const auto& one) { return one.second; })->second;
    const std::vector<report::SampleTrial> shown = report::sample_trials(reported);
    ASSERT_EQ(shown.size(), 2U);
    for (const report::SampleTrial& trial : shown) {
      ASSERT_EQ(trial.point, point);
      if (trial.name == "worst" && name == "goal") {
        EXPECT_EQ(failed[trial.index], most);
      }
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
