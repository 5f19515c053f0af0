// `tune`, `limits` and `worst`, from the manifest to the proof.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/design_commands/tune_fixture.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

TEST_F(Tune, ProvesTheGainsThatItFinds) {
  write_axis("goal: {band: 1, within: 0.05, moves: 0.95}\n" + std::string(two_gains));
  EXPECT_EQ(tune({"--report", "page.txt"}).code, 2);
  const ProgramResult result = tune({"--report", "page.html", "-m", "tuned.yaml"});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const Json answer = Json::parse(result.out);
  EXPECT_EQ(answer["status"], "met");
  EXPECT_GE(answer["proof"]["rate_low"], 0.95);
  EXPECT_GE(answer["proof"]["rigs"], 500);
  EXPECT_GE(answer["margins"]["gain"], 6.0);
  EXPECT_GE(answer["margins"]["phase"], 30.0);
  EXPECT_GE(answer["margins"]["delay"], 0.5);
  EXPECT_LE(answer["room"]["controller.kp"][0], answer["gains"]["controller.kp"]);
  EXPECT_GE(answer["room"]["controller.kp"][1], answer["gains"]["controller.kp"]);
  EXPECT_EQ(answer["alternatives"][0]["fixed"], (Json{{"controller.kp", 0.0}}));
  EXPECT_EQ(answer["limits"][0]["cause"], "none");
  EXPECT_EQ(answer["worst"]["inputs"].count("friction.k1"), 1U);
  EXPECT_GT(answer["searched"]["points"], 100);

  // The file is of the tuned manifest, on other machines, and judges itself met.
  EXPECT_EQ(program({"judge", "tuned.h5"}).code, 0);
  const reading::ResultsFile file(folder_.path() / "tuned.h5");
  const std::string& manifest = file.header().manifest;
  EXPECT_NE(manifest.find("ki: " + answer["gains"]["controller.ki"].dump()), std::string::npos) << manifest;
  EXPECT_NE(manifest.find("# machines"), std::string::npos) << "comments stay";
  EXPECT_EQ(manifest.find("seed: 7\n"), std::string::npos);
  EXPECT_TRUE(file.header().overrides.empty());

  // The user's manifest with the tuned values.
  const std::string tuned = folder_.read("tuned.yaml");
  EXPECT_NE(tuned.find("seed: 7\ntrials: 200\nrigs: 100   # machines\n"), std::string::npos) << tuned;
  // Its controller is that of the proof, whose heading has the margins of other machines.
  const auto written = [&](const std::vector<std::string>& of) {
    std::vector<std::string> words{"controller"};
    words.insert(words.end(), of.begin(), of.end());
    const std::string code = program(words).out;
    EXPECT_NE(code.find("#include"), std::string::npos) << code;
    return code.substr(code.find("#include"));
  };
  EXPECT_EQ(written({"tuned.yaml"}), written({"tuned.h5", "--point", "best"}));

  // The page, of which the browser test looks at every figure.
  const std::string page = folder_.read("page.html");
  for (const char* const part : {"tuning-frontier", "tuning-room", "response", "id=\"overview\""})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  const Json frontier = answer["frontier"];
  for (std::size_t i = 1; i < frontier.size(); ++i) {
    EXPECT_GT(frontier[i]["rate"], frontier[i - 1]["rate"]);
    EXPECT_GE(frontier[i]["criterion"], frontier[i - 1]["criterion"]);
  }
}

// The loop that is fastest without margins does not bear much more delay.
TEST_F(Tune, NamesTheDelayAtWhichTheGoalIsLost) {
  write_axis(
      "goal: {band: 1, within: 0.03, moves: 0.98}\ntune: {free: {controller.ki: {log: [1.0e-5, 1.0e-3]}, "
      "controller.kp: [0, 2.0e-3], controller.kd: [0, 5.0e-3]}, margins: off}\n");
  const ProgramResult result = tune({}, "20000");
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const Json answer = Json::parse(result.out);
  ASSERT_TRUE(answer["delay_lost"].is_number()) << result.out;
  const double lost = answer["delay_lost"];
  EXPECT_GT(lost, 1.0);
  const auto rate_at = [&](double delay) {
    EXPECT_EQ(program({"run", "tuned.h5.yaml", "-o", "later.h5", "--force", "--set",
                       "controller.delay=" + std::to_string(delay)})
                  .code,
              0);
    return Json::parse(program({"judge", "later.h5", "--format", "json"}).out)["rate"].get<double>();
  };
  const reading::ResultsFile file(folder_.path() / "tuned.h5");
  folder_.write("tuned.h5.yaml", file.header().manifest);
  EXPECT_LT(rate_at(lost + 0.3), 0.98);
  EXPECT_GT(rate_at(lost - 0.3), 0.975);
}

TEST_F(Tune, DoesNotDependOnTheNumberOfThreads) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n" + std::string(two_gains));
  Json one = Json::parse(tune({"--threads", "1"}, "5000").out);
  Json two = Json::parse(tune({"--threads", "2"}, "5000").out);
  for (Json* json : {&one, &two}) (*json)["searched"].erase("seconds");
  EXPECT_EQ(one, two);
}

// The answer after interruptions in the search, and in what follows it, is that of a run without any.
TEST_F(Tune, GoesOnAfterAnInterruption) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n" + std::string(two_gains));
  const std::vector<std::string> command{"tune",     "axis.yaml", "-o",       "tuned.h5",
                                         "--format", "json",      "--budget", "5000"};
  const auto answer_of = [](const std::string& text) {
    Json json = Json::parse(text);
    json["searched"].erase("seconds");
    return json;
  };
  const ProgramResult whole = program(command);
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_EQ(program(command).code, 2) << "the file is there";
  std::filesystem::remove(folder_.path() / "tuned.h5");
  int interruptions = 0;
  for (const int milliseconds : {200, 300, 500}) {
    RunningProgram running(command, folder_.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    running.send(milliseconds == 300 ? SIGINT : SIGKILL);
    if (running.wait() == 0) break;
    ++interruptions;
  }
  std::filesystem::remove(folder_.path() / "tuned.h5");
  const ProgramResult result = program(command);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_GT(interruptions, 0);
  EXPECT_EQ(answer_of(result.out), answer_of(whole.out));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "tuned.h5.tuning"));
}

// As soon as the results file is there it is the whole proof; the answer is printed before any extra; Ctrl-C
// keeps both, and the same command ends with the answer of a tuning without interruption.
TEST_F(Tune, GivesTheProvenAnswerBeforeTheExtrasAndKeepsIt) {
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
       {"of controller.delay", "room of each parameter", "other controls", "what limits it", "searched:"}) {
    const std::size_t at = resumed.out.find(extra, last);
    ASSERT_NE(at, std::string::npos) << extra << resumed.out;
    last = at;
  }
}

TEST_F(Tune, MakesTheExtrasThatAreAskedFor) {
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

TEST_F(Tune, NamesTheExtrasThatABudgetLeavesOutWithTheCommandThatMakesThem) {
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

/// The row of a table that has these members.
const Json& row_with(const Json& rows, const Json& members) {
  for (const Json& row : rows) {
    bool has_all = true;
    for (const auto& [key, value] : members.items()) has_all = has_all && row.value(key, Json()) == value;
    if (has_all) return row;
  }
  throw std::runtime_error("no such row: " + members.dump() + rows.dump());
}

/// The 95 % quantile (inverse of the empirical distribution function) and the maximum.
std::pair<double, double> upper_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(values.size()) - 1e-9));
  return {values[rank - 1], values.back()};
}

// Each number of what the values do is that of a study which `run` simulates with them: under each condition,
// of the moves of each goal, in counts, SI units and of the step, with drawn steps, on a converter that
// clips.
TEST_F(Tune, SaysWhatTheTunedValuesDo) {
  std::string manifest = std::string(axis);
  const std::string command = "command: {targets: [29], hold: 0.3}";
  manifest.replace(
      manifest.find(command), command.size(),
      "command: {targets: [{integers: [20, 200]}, 0], hold: 0.3}\ndac: {bits: 8, resolution: 1.0e-3}\n"
      "conditions: {empty: {}, loaded: {plant.inertia: 8.0e-4}}\nverdict: {motion: true}");
  folder_.write("axis.yaml", manifest +
                                 "goals: {there: {'on': [0], band: 1, within: 0.25, moves: 0.3},\n"
                                 "  back: {'on': [1], band: 2, within: 0.25, moves: 0.3}}\n" +
                                 std::string(two_gains));
  const ProgramResult result = tune({"--extras", "none"}, "12000");
  ASSERT_NE(result.code, 2) << result.err;
  const Json answer = Json::parse(result.out);
  ASSERT_EQ(answer["behaviour"].size(), 4U) << result.out;
  ASSERT_EQ(answer["claims"].size(), 4U);

  // The proof is repeated by `run` from its manifest, and its statistics are those of `summary`.
  folder_.write("tuned.yaml", reading::ResultsFile(folder_.path() / "tuned.h5").header().manifest);
  ASSERT_EQ(program({"run", "tuned.yaml", "-o", "again.h5"}).code, 0);
  const Json point = Json::parse(program({"summary", "again.h5", "--format", "json"}).out)["points"][0];
  for (const Json& claim : answer["claims"]) {
    const Json& same =
        row_with(point["claims"], {{"goal", claim["goal"]}, {"condition", claim["condition"]}});
    for (const char* const key : {"moves", "met", "rate", "settling_time_p95", "within"})
      EXPECT_EQ(claim.value(key, Json()), same.value(key, Json())) << key;
  }
  double largest_overshoot = 0.0;
  double largest_peak = 0.0;
  for (const Json& row : answer["behaviour"]) {
    largest_overshoot = std::max(largest_overshoot, row["overshoot_max"].get<double>());
    largest_peak = std::max(largest_peak, row["peak_torque_max"].get<double>());
  }
  EXPECT_EQ(largest_overshoot, point["overshoot"]["max"].get<double>());
  EXPECT_EQ(largest_peak, point["peak_torque"]["max"].get<double>());

  // Quantiles, proportions and units by goal and condition, from the moves themselves.
  const reading::AllTrialsFile file(folder_.path() / "again.h5");
  const study::Study study = file.study();
  const study::TrialTurns turns = study::turns_of(study);
  const double count = 2.0 * 3.14159265358979323846 / 1620000.0;
  constexpr double range = 0.128;
  for (const Json& row : answer["behaviour"]) {
    const std::size_t move = row["goal"] == "there" ? 0 : 1;
    std::vector<double> overshoots, of_steps, peaks;
    double saturated = 0.0, power = 0.0, changes = 0.0;
    std::int64_t at_rest = 0;
    for (std::int64_t trial = 0; trial < study.trials; ++trial) {
      if (study.conditions[static_cast<std::size_t>(turns.condition_of(trial))] != row["condition"]) continue;
      const std::vector<trial::MoveOutcome> moves = file.outcomes({trial, 1});
      const trial::MoveOutcome& one = moves[move];
      // From 0 to the first target, and back.
      const auto step =
          static_cast<double>(study::study_trial(study, 0, trial).parameters.command.targets[0]);
      overshoots.push_back(static_cast<double>(one.overshoot));
      of_steps.push_back(static_cast<double>(one.overshoot) / step);
      peaks.push_back(one.peak_torque);
      saturated += one.saturated ? 1.0 : 0.0;
      if (std::isnan(one.rest_torque_power) || std::isnan(one.rest_torque_noise)) continue;
      ++at_rest;
      power += one.rest_torque_power;
      changes += one.rest_torque_noise;
    }
    EXPECT_EQ(row["moves"], overshoots.size());
    const auto expect_upper = [&](const std::string& key, const std::vector<double>& values, double scale) {
      const auto [p95, max] = upper_of(values);
      EXPECT_NEAR(row[key + "_p95"].get<double>(), p95 * scale, 1e-9 * p95 * scale) << key;
      EXPECT_NEAR(row[key + "_max"].get<double>(), max * scale, 1e-9 * max * scale) << key;
    };
    expect_upper("overshoot", overshoots, 1.0);
    expect_upper("overshoot_length", overshoots, count);
    expect_upper("overshoot_of_step", of_steps, 1.0);
    expect_upper("peak_torque", peaks, 1.0);
    expect_upper("peak_of_range", peaks, 1.0 / range);
    EXPECT_NEAR(row["saturated"].get<double>(), saturated / static_cast<double>(peaks.size()), 1e-12);
    const auto rests = static_cast<double>(at_rest);
    EXPECT_NEAR(row["rest_torque_rms"].get<double>(), std::sqrt(power / rests), 1e-9);
    EXPECT_NEAR(row["rest_torque_changes"].get<double>(), std::sqrt(changes / rests), 1e-9);
  }
}

/// Trials of all parts of an answer.
std::int64_t trials_in(const Json& answer) {
  return answer["searched"]["trials"].get<std::int64_t>() + answer["proof"]["trials"].get<std::int64_t>();
}

// Of any size, on machines or trials of their own, with worlds, met or missed.
TEST_F(Tune, HoldsItsBudgetOfTrialsInAllThatItRuns) {
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

// The margins that are missing, and by how much, in the text, the JSON and the page.
TEST_F(Tune, WithoutAPointThatKeepsTheMarginsNamesTheNearest) {
  const auto write = [this](const std::string& margins) {
    write_axis(
        "goal: {band: 1, within: 0.05, moves: 0.9}\ntune: {free: {controller.ki: {log: [2.0e-5, 1.0e-4]}, "
        "controller.kp: [0, 5.0e-4]}, margins: {" +
        margins + ", spread: off}}\n");
  };
  write("gain: 14, phase: off, delay: off");
  const ProgramResult result = tune({"--report", "none.html"}, "3000");
  EXPECT_EQ(result.code, 1) << result.err;
  const Json nearest = Json::parse(result.out)["nearest"];
  EXPECT_NEAR(nearest["margins"]["gain"].get<double>() + nearest["lacking"]["gain"].get<double>(), 14.0,
              1e-9);
  EXPECT_LT(nearest["lacking"]["gain"], 14.0) << "nearest: stable";
  EXPECT_FALSE(nearest["lacking"].contains("phase")) << "off";
  const std::string page = folder_.read("none.html");
  EXPECT_NE(page.find("its gain margin is"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "tuned.h5"));
  // With as much less as is missing there the point is found.
  const double kept = nearest["margins"]["gain"].get<double>();
  write("gain: " + std::to_string(kept - 0.01) + ", phase: off, delay: off");
  EXPECT_FALSE(Json::parse(tune({}, "3000").out)["gains"].empty());
}

TEST_F(Tune, HoldsItsBudgetOfTime) {
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

/// A control of an answer of 1000 machines at least.
struct ControlInAnswer {
  std::set<std::string> blocks;  ///< free parameters that are not fixed at 0
  double rate;

  bool has_all_blocks_of(const ControlInAnswer& other) const {
    return std::ranges::includes(blocks, other.blocks);
  }
};

std::vector<ControlInAnswer> controls_in(const Json& answer) {
  std::set<std::string> free;
  for (const auto& [name, value] : answer["gains"].items()) free.insert(name);
  std::vector<ControlInAnswer> controls;
  const auto add = [&](const Json& fixed, const Json& gains, double rate) {
    std::set<std::string> blocks = free;
    for (const auto& [name, value] : gains.items()) blocks.insert(name);
    for (const auto& [name, value] : fixed.items()) blocks.erase(name);
    controls.push_back({blocks, rate});
  };
  add(Json::object(), answer["gains"], answer["proof"]["rate"]);
  for (const Json& one : answer["alternatives"]) {
    if (!one["gains"].empty()) add(one["fixed"], one["gains"], one["rate"]);
  }
  return controls;
}

// Every pair of controls of which one has all blocks of the other: the rates are of 500 machines at least.
TEST_F(Tune, AControlWithMoreBlocksIsWorseOnlyByChance) {
  int pairs = 0;
  for (const std::string goal :
       {"{band: 1, within: 0.05, moves: 0.95}", "{band: 0, within: 0.1, moves: 0.9}"}) {
    write_axis("goal: " + goal + "\n" + std::string(two_gains));
    const std::vector<ControlInAnswer> controls =
        controls_in(Json::parse(tune({"--extras", "controls"}, "9000").out));
    for (const ControlInAnswer& more : controls) {
      for (const ControlInAnswer& fewer : controls) {
        if (more.blocks == fewer.blocks || !more.has_all_blocks_of(fewer)) continue;
        ++pairs;
        const double wanted = std::min(fewer.rate, 0.95);
        EXPECT_GE(more.rate, wanted - 3.0 * std::sqrt(wanted * (1.0 - wanted) / 250.0)) << goal;
      }
    }
  }
  EXPECT_EQ(pairs, 6);
}

// The ranges of kp and kd are so wide that only their low ends keep the margins: the integral alone does.
TEST_F(Tune, IsNotUnreachableWhereASimplerControlMeetsTheGoal) {
  write_axis(
      "goal: {band: 1, within: 0.2, moves: 0.9}\ntune: {free: {controller.ki: {log: [2.0e-6, 1.0e-4]}, "
      "controller.kp: [0, 2.0e-2], controller.kd: [0, 1.5e-1]}}\n");
  const Json answer = Json::parse(tune({"--set", "controller.delay=3"}, "6000").out);
  EXPECT_EQ(answer["status"], "met") << answer.dump(1);
  EXPECT_GE(answer["margins"]["gain"], 6.0);
}

// A tuning adds spreads that the study does not draw, and looks at every machine.
TEST_F(Tune, TheReportOfItsFileHasTheMarginsOfTuning) {
  write_axis(
      "goal: {band: 1, within: 0.06, moves: 0.9}\ntune: {free: {controller.ki: {log: [5.0e-6, 1.0e-3]}}}\n");
  const Json tuned = Json::parse(tune({"--extras", "none"}, "5000").out);
  const Json again = Json::parse(program({"tune", "tuned.h5", "--extras", "none", "--format", "json"}).out);
  const double phase = again["margins"]["phase"];
  EXPECT_NEAR(phase, tuned["margins"]["phase"], 10.0) << "of other machines";
  ASSERT_EQ(program({"report", "tuned.h5", "-o", "page.html"}).code, 0);
  const std::string page = folder_.read("page.html");
  EXPECT_NE(page.find(fmt::format("{:.4g} degrees (at least 30 wanted)", phase)), std::string::npos) << phase;
}

TEST_F(Tune, OfAGoalBeyondReachSaysSo) {
  write_axis("goal: {band: 0, within: 0.004, moves: 0.98}\n" + std::string(two_gains));
  const ProgramResult result = tune({}, "5000");
  EXPECT_EQ(result.code, 1) << result.out << result.err;
  const Json answer = Json::parse(result.out);
  EXPECT_EQ(answer["status"], "unreachable");
  EXPECT_LT(answer["proof"]["rate"], 0.98);
  EXPECT_GE(answer["wider_band_rate"], answer["limits"][0]["rate"]);
  EXPECT_EQ(program({"judge", "tuned.h5"}).code, 1);
}

// The quietest gains that meet the goal are lower than the fastest ones.
TEST_F(Tune, MinimisesTheTorqueNoiseAtRest) {
  const std::string goal = "verdict: {motion: true}\ngoal: {band: 1, within: 0.1, moves: 0.95}\n";
  std::vector<double> noise;
  for (const char* criterion : {"band_settling_time.p95", "rest_torque_noise.p95"}) {
    write_axis(goal + std::string(two_gains) + "  minimise: " + criterion + "\n");
    const ProgramResult result = tune({}, "3500");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json summary = Json::parse(program({"summary", "tuned.h5", "--format", "json"}).out);
    noise.push_back(summary["points"][0]["rest_torque_noise"]["mean"].get<double>());
  }
  EXPECT_LT(noise[1], noise[0]);
}

TEST_F(Tune, LimitsSwitchCausesOffOneByOne) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  const ProgramResult result = program({"limits", "axis.yaml", "--format", "json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json limits = Json::parse(result.out)["limits"];
  std::vector<std::string> causes;
  for (const Json& one : limits) causes.push_back(one["cause"]);
  EXPECT_EQ(causes.front(), "none");
  EXPECT_EQ(std::count(causes.begin(), causes.end(), "no delay, no amplifier lag"), 1);
  EXPECT_EQ(std::count(causes.begin(), causes.end(), "no noise"), 0) << "there is none";
  // Without the cause of an idealisation the rate is that of the study with the cause switched off.
  const ProgramResult judged =
      program({"run", "axis.yaml", "-o", "no-delay.h5", "--set", "controller.delay=0"});
  ASSERT_EQ(judged.code, 0);
  const Json judgement = Json::parse(program({"judge", "no-delay.h5", "--format", "json"}).out);
  for (const Json& one : limits) {
    if (one["cause"] == "no delay, no amplifier lag") {
      EXPECT_EQ(one["rate"], judgement["rate"]);
    }
  }
}

// Stiffness alone decides, and more of it is worse: the worst machine is at the end of the box.
TEST_F(Tune, WorstIsFoundAtTheEndOfTheBoxWhereItLies) {
  folder_.write("soft.yaml", R"(zerocount: 1
name: soft
seed: 3
trials: 40
command: {targets: [20], hold: 0.2}
friction: {model: spring, k1: {uniform: [100, 140]}, k2: 0}
initial: {encoder_phase: {uniform: [0, 1]}}
controller: {ki: 3.0e-5}
goal: {band: 0, within: 0.06, moves: 0.9}
)");
  const Json box = Json::parse(program({"worst", "soft.yaml", "--format", "json"}).out)["box"];
  const double quantile = box["quantiles"][0];
  EXPECT_TRUE(quantile < 0.01 || quantile > 0.99) << quantile;
}

TEST_F(Tune, LimitsAreOfThePointThatIsAskedFor) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\nsweep: {grid: {controller.delay: [0, 1]}}\n");
  EXPECT_NE(program({"limits", "axis.yaml"}).err.find("expected one with --point"), std::string::npos);
  const auto rate_of = [this](const std::vector<std::string>& words) {
    return Json::parse(program(words).out)["limits"][0]["rate"].get<double>();
  };
  const double swept = rate_of({"limits", "axis.yaml", "--point", "1", "--format", "json"});
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  EXPECT_EQ(rate_of({"limits", "axis.yaml", "--format", "json"}), swept);
}

TEST_F(Tune, WorstIsTheMachineWithTheFewestGoodMoves) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  ASSERT_EQ(program({"run", "axis.yaml", "-o", "out.h5"}).code, 0);
  const Json of_manifest = Json::parse(program({"worst", "axis.yaml", "--format", "json"}).out);
  const Json of_file = Json::parse(program({"worst", "out.h5", "--format", "json"}).out);
  EXPECT_EQ(of_manifest, of_file);
  const Json box = of_manifest["box"];
  EXPECT_LE(box["met"], of_manifest["met"].get<double>() + 0.1) << "the box has the sampled machines' ranges";
  for (const double quantile : box["quantiles"]) {
    EXPECT_GE(quantile, 0.0005);
    EXPECT_LE(quantile, 0.9995);
  }
  const ProgramResult set = program({"worst", "out.h5", "--set", "controller.delay=0"});
  EXPECT_EQ(set.code, 2);
  EXPECT_NE(set.err.find("changes a manifest"), std::string::npos) << set.err;
  EXPECT_LT(of_manifest["rig"], 100);
  EXPECT_GT(of_manifest["inputs"]["friction.k1"], 0.0);
}

TEST_F(Tune, SaysWhenTheGoalIsLostAndWhatTuningAgainBuys) {
  write_axis("ages: {at: [0, 1.0e+6]}\ngoal: {band: 1, within: 0.08, moves: 0.95}\n" +
             std::string(two_gains));
  const std::string growing =
      "friction.k1={lognormal: {median: 130, cv: 0.2}, aging: {exponential: 0.5, scale: 1.0e+6}}";
  const ProgramResult tuned =
      tune({"--set", growing, "--extras", "ages,retuning", "--retune-every", "5e5", "--report", "life.html"},
           "40000");
  ASSERT_EQ(tuned.code, 0) << tuned.err;
  EXPECT_NE(folder_.read("life.html").find("figure-tuning-retuning"), std::string::npos);
  const auto answer = nlohmann::json::parse(tuned.out);
  ASSERT_EQ(answer["lost_ages"].size(), 1U);
  EXPECT_GT(answer["lost_ages"][0]["lost"], 1.0e6);
  EXPECT_LE(answer["lost_ages"][0]["met_until"], answer["lost_ages"][0]["lost"]);
  EXPECT_GE(answer["lost_ages"][0]["missed_from"], answer["lost_ages"][0]["lost"]);
  ASSERT_EQ(answer["retuning"].size(), 2U);
  EXPECT_EQ(answer["retuning"][0]["to"], 5.0e5);
  EXPECT_EQ(answer["retuning"][1]["to"], 1.0e6);
  ASSERT_EQ(answer["retuned_ages"].size(), 4U);
  for (const auto& row : answer["retuned_ages"]) EXPECT_GT(row["retuned_low"], 0.8) << row;
  EXPECT_EQ(answer["retuning"][0]["criterion_name"], "band_settling_time.p95 (s)");
  // A budget that is not enough for all searches serves the last intervals.
  const ProgramResult less = program({"tune", "tuned.h5", "--extras", "retuning", "--retune-every", "2.5e5",
                                      "--budget", "4000", "--format", "json"});
  ASSERT_EQ(less.code, 0) << less.err;
  const auto last = nlohmann::json::parse(less.out);
  ASSERT_EQ(last["retuning"].size() + last["left_out"].size(), 4U) << less.out;
  EXPECT_GE(last["left_out"].size(), 1U);
  EXPECT_GE(last["retuning"].size(), 1U);
  EXPECT_EQ(last["retuning"].back()["to"], 1.0e6);
  EXPECT_EQ(tune({"--retune-every", "1e6"}).code, 2) << "one interval";
}

}  // namespace
}  // namespace zerocount::testing
