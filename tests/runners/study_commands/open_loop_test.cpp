// Torque levels in place of targets, from the manifest to the table; and the columns of sample records that a
// study uses.

#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/trials/study_runner.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/odeint_trial.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* loads =
    "zerocount: 1\nname: loads\nseed: 11\ntrials: 12\n"
    "friction: {k2: {uniform: [600, 900]}}\n"
    "command: {torque: {levels: [0.1, 0.05, 0.15, 0], rate: 5}, hold: 0.05}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}}\n"
    "retain: {trials: [3]}\n"
    "sweep: {cases: {creeping: {friction.alpha: 0.5}, elastic: {friction.alpha: 0}}}\n";

class OpenLoop : public ::testing::Test {
 protected:
  OpenLoop() { folder.write("loads.yaml", loads); }
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder.path());
  }

  TemporaryFolder folder;
};

TEST_F(OpenLoop, SummaryLevelsAgreeWithTheTrials) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5", "--engine", "reference"}).code, 0);
  const auto json = nlohmann::json::parse(run({"summary", "loads.h5", "--format", "json"}).out);
  const study::Study study = manifest::load_study(folder / "loads.yaml");
  for (std::int64_t point = 0; point < 2; ++point) {
    const auto& found = json["points"][static_cast<std::size_t>(point)];
    EXPECT_EQ(found["open_loop"], 12);
    EXPECT_EQ(found["zero_count"], 0);
    EXPECT_TRUE(found["success_rate"].is_null());
    std::vector<double> sum(4), creep(4);
    for (std::int64_t index = 0; index < study.trials; ++index) {
      const trial::TrialOutcome outcome =
          trial::run_trial(study::study_trial(study, point, index).parameters);
      for (std::size_t level = 0; level < 4; ++level) {
        sum[level] += outcome.moves[level].final_position / 12.0;
        creep[level] += outcome.moves[level].creep / 12.0;
      }
    }
    ASSERT_EQ(found["levels"].size(), 4U);
    for (std::size_t level = 0; level < 4; ++level) {
      const auto& values = found["levels"][level];
      EXPECT_NEAR(values["position"]["mean"].get<double>(), sum[level], 1e-12 * std::abs(sum[level]));
      EXPECT_NEAR(values["creep"]["mean"].get<double>(), creep[level],
                  1e-12 * std::abs(creep[level]) + 1e-30);
      EXPECT_LT(values["position"]["low"].get<double>(), sum[level]);
      EXPECT_GT(values["position"]["high"].get<double>(), sum[level]);
      const double asked = std::vector<double>{0.1, 0.05, 0.15, 0.0}[level];
      EXPECT_NEAR(values["torque"].get<double>(), asked, 1.2e-4) << "half a code";
    }
  }
}

TEST_F(OpenLoop, TablesHaveTheLevels) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  const std::string table = run({"summary", "loads.h5"}).out;
  EXPECT_TRUE(says(table, "position (µrad)"));
  EXPECT_FALSE(says(table, "zero-count"));
}

/// The lines of a CSV file, each a number for each name of its header.
std::vector<std::map<std::string, double>> csv_lines(const std::string& text) {
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::istringstream file(text);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<std::map<std::string, double>> lines;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size()) << line;
    std::map<std::string, double>& numbers = lines.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i)
      numbers[names[i]] = std::stod(cells[i]);
  }
  return lines;
}

/// Expects the statistics of these values in the columns "<name>_mean [rad]", "<name>_low [rad]" … of a line.
void expect_statistics(const std::map<std::string, double>& line, const std::string& name,
                       const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double sd = std::sqrt(squares / (n - 1.0));
  const double half_width = 2.2009851601 * sd / std::sqrt(n);  // Student's t: 97.5 %, 11 degrees of freedom
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  const auto expect = [&](const char* statistic, double expected) {
    const std::string column = name + "_" + statistic + " [rad]";
    ASSERT_TRUE(line.contains(column)) << column;
    EXPECT_NEAR(line.at(column), expected, 1e-9 * std::abs(mean) + 1e-12) << column;
  };
  expect("mean", mean);
  expect("low", mean - half_width);
  expect("high", mean + half_width);
  expect("sd", sd);
  expect("min", *min);
  expect("max", *max);
}

TEST_F(OpenLoop, ExportedLevelsAreTheStatisticsOfTheMoves) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  ASSERT_EQ(run({"export", "loads.h5", "-o", "tables"}).code, 0);
  const std::vector<std::map<std::string, double>> lines = csv_lines(folder.read("tables/levels.csv"));
  const reading::AllTrialsFile file(folder / "loads.h5");
  const std::vector<trial::MoveOutcome> moves = file.outcomes(file.rows());
  ASSERT_EQ(moves.size(), 2U * 12U * 4U);
  ASSERT_EQ(lines.size(), 2U * 4U);
  for (std::size_t point = 0; point < 2; ++point) {
    for (std::size_t level = 0; level < 4; ++level) {
      const std::map<std::string, double>& line = lines[4 * point + level];
      std::vector<double> positions, creeps;
      double torque = 0.0;
      std::int64_t deepest = 0;
      for (std::size_t trial = 0; trial < 12; ++trial) {
        const trial::MoveOutcome& move = moves[(12 * point + trial) * 4 + level];
        positions.push_back(move.final_position);
        creeps.push_back(move.creep);
        torque += move.holding_torque / 12.0;
        deepest = std::max(deepest, move.reversal_depth);
      }
      const auto expect = [&](const char* column, double expected) {
        ASSERT_TRUE(line.contains(column)) << column;
        EXPECT_NEAR(line.at(column), expected, 1e-12) << column << " of level " << level;
      };
      expect("point", static_cast<double>(point));
      expect("move", static_cast<double>(level));
      expect("n", 12.0);
      expect("nonfinite", 0.0);
      expect("broke_away", 0.0);
      expect("torque [N m]", torque);
      expect("reversal_depth_max", static_cast<double>(deepest));
      expect_statistics(line, "position", positions);
      expect_statistics(line, "creep", creeps);
      EXPECT_EQ(line.size(), 19U) << "columns without an expectation";
    }
  }
}

TEST_F(OpenLoop, SampleRecordsHaveNoTarget) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  const reading::AllTrialsFile file(folder / "loads.h5");
  ASSERT_GT(file.trace_count(), 0);
  for (const layout::TraceRecord& record : file.trace_at(0, file.trace_count())) {
    EXPECT_EQ(record.target, 0);
    EXPECT_EQ(record.error, -record.count);
  }
  EXPECT_EQ(run({"trace", "loads.h5", "--point", "1", "--trial", "3"}).code, 0);
}

// The code of an exact torque is 0 (core/README.md).
TEST_F(OpenLoop, SampleRecordsOfAnExactTorqueHaveNoCode) {
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "exact.h5", "--set", "command.torque.through=exact"}).code, 0);
  const reading::AllTrialsFile file(folder / "exact.h5");
  double largest = 0.0;
  for (const layout::TraceRecord& record : file.trace_at(0, file.trace_count())) {
    EXPECT_EQ(record.code, 0);
    largest = std::max(largest, record.torque);
  }
  EXPECT_EQ(largest, 0.15);
}

TEST(SampleRecords, HaveTheColumnsThatTheStudyUsesInEveryFormat) {
  const TemporaryFolder folder;
  folder.write("study.yaml",
               "zerocount: 1\nname: two phases\nseed: 2\ntrials: 2\n"
               "dac: {offset: 1.0e-4}\n"
               "controller: {coarse: {coarse_beyond: 500}}\n"
               "command: {targets: [3000], hold: 0.1, profile: {shape: trapezoidal}}\n"
               "retain: {trials: [1]}\n");
  const auto run = [&](const std::vector<std::string>& words) {
    return zerocount_program(words, folder.path());
  };
  ASSERT_EQ(run({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  const reading::AllTrialsFile file(folder / "out.h5");
  const std::vector<layout::TraceRecord> kept = file.trace_at(0, file.trace_count());
  const ProgramResult trace = run({"trace", "out.h5", "--trial", "1", "--format", "json"});
  ASSERT_EQ(trace.code, 0) << trace.err;
  const auto samples = nlohmann::json::parse(trace.out)["samples"];
  ASSERT_EQ(samples.size(), kept.size());
  bool coarse = false, moving = false;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(samples[i]["reference"].get<std::int64_t>(), kept[i].reference);
    EXPECT_EQ(samples[i]["phase"], kept[i].phase == loop::ControlPhase::coarse ? "coarse" : "fine");
    EXPECT_EQ(samples[i]["drive_torque"].get<double>(), kept[i].drive_torque);
    EXPECT_NEAR(kept[i].drive_torque, kept[i].torque + 1.0e-4, 1e-15);
    coarse = coarse || kept[i].phase == loop::ControlPhase::coarse;
    moving = moving || (kept[i].reference != 0 && kept[i].reference != 3000);
  }
  EXPECT_TRUE(coarse && moving);
}

// A linear stage whose integral gain is too low for its hold: nobody is told that it is unstable, and the
// hold that is advised decides.

constexpr const char* slow_stage =
    "zerocount: 1\nname: stage\naxis: linear\nseed: 19900701\ntrials: 40\n"
    "plant: {inertia: 5, presliding_damping: 1500, sliding_damping: 50}\n"
    "friction: {k1: {uniform: [0.9e+5, 1.1e+5]}, k2: {uniform: [1.6e+7, 2.4e+7]},\n"
    "           beta: {lognormal: {median: 2.0e+6, cv: 0.2}}, alpha: {log_uniform: [0.1, 2]},\n"
    "           lambda: 1.0e+8, breakaway: 12, stribeck_velocity: 1.0e-3}\n"
    "encoder: {resolution: 1.0e-9}\n"
    "dac: {bits: 20, resolution: 5.0e-5}\n"
    "controller: {sample_rate: 10000, kp: 0, ki: 5.0e-6}\n"
    "command: {targets: [{integers: [-30, 30]}, 0, {integers: [-30, 30]}, 0, {integers: [-30, 30]}, 0], "
    "hold: 0.3}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, preload: {uniform: [-1, 1]}}\n"
    "verdict: {dwell: 0.02, window: 0.05}\n";
constexpr std::int64_t moves_of_stage = 240;

/// Numbers of moves of different outcomes, counted by the test from recorded samples.
struct Recorded {
  std::int64_t off_target{0};
  std::int64_t still_falling{0};
  std::int64_t arrived{0};
};

class SlowStage : public ::testing::Test {
 protected:
  SlowStage() { folder_.write("stage.yaml", slow_stage); }
  ProgramResult run(std::vector<std::string> words, const std::vector<std::string>& settings = {}) const {
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    return zerocount_program(words, folder_.path());
  }
  Recorded recorded(const std::string& file) const {
    Recorded counted;
    const reading::AllTrialsFile study(folder_.path() / file);
    for (const trial::MoveOutcome& move : study.outcomes(study.rows())) {
      counted.arrived += move.arrived;
      if (move.outcome != trial::Outcome::off_target) continue;
      ++counted.off_target;
      counted.still_falling += std::abs(move.final_error) < std::abs(move.midway_error);
    }
    return counted;
  }
  nlohmann::json undecided(const std::string& file) const {
    return nlohmann::json::parse(run({"summary", file, "--format", "json"}).out)["points"][0]["undecided"];
  }

  /// Number of moves that arrive when the stage is run again with the duration (`hold`) that the summary of a
  /// first run advises.
  std::int64_t arrived_with_advised_hold(std::vector<std::string> settings) const {
    EXPECT_EQ(run({"run", "stage.yaml", "-q", "-o", "slow.h5"}, settings).code, 0);
    const nlohmann::json said = undecided("slow.h5");
    if (!said["hold_at_least"].is_number()) return 0;
    settings.push_back(fmt::format("command.hold={}", said["hold_at_least"].get<double>()));
    EXPECT_EQ(run({"run", "stage.yaml", "-q", "-o", "advised.h5"}, settings).code, 0);
    return recorded("advised.h5").arrived;
  }

  TemporaryFolder folder_;
};

TEST_F(SlowStage, IsCalledUndecidedWithTheHoldThatWouldDecide) {
  ASSERT_EQ(run({"run", "stage.yaml", "-q", "-o", "slow.h5"}).code, 0);
  const Recorded counted = recorded("slow.h5");
  EXPECT_LT(counted.arrived, moves_of_stage / 5);
  EXPECT_GT(counted.off_target, moves_of_stage / 2);

  const nlohmann::json said = undecided("slow.h5");
  EXPECT_EQ(said["moves"], moves_of_stage);
  EXPECT_EQ(said["off_target"], counted.off_target);
  EXPECT_EQ(said["still_falling"], counted.still_falling);
  // Of a time constant T·(k1 + k2)·Δx/(2·ki) of 0.16 to 0.24 s, up to ln(2·30) are needed.
  EXPECT_GT(said["hold_at_least"], 0.6);
  EXPECT_LT(said["hold_at_least"], 1.1);

  const std::string table = run({"summary", "slow.h5"}).out;
  const std::string sentence = fmt::format(
      "\n{} of 240 moves ended more than one count off their target without oscillating; the error "
      "was still falling in {} of 240 moves at the end of the hold",
      counted.off_target, counted.still_falling);
  const std::string advice = fmt::format(
      "; hold ≥ about {} s\nSuch moves are undecided: neither stable nor "
      "shown unstable.",
      said["hold_at_least"].get<double>());
  EXPECT_TRUE(says(table, sentence)) << sentence << "\n" << table;
  EXPECT_TRUE(says(table, advice)) << advice << "\n" << table;
}

TEST_F(SlowStage, ArrivesWithTheAdvisedHold) {
  EXPECT_GE(arrived_with_advised_hold({}), moves_of_stage * 95 / 100);
  EXPECT_EQ(undecided("advised.h5")["still_falling"], 0);
}

// The count chatters on its edges: some of these moves count as oscillating, and the last edge takes its
// time.
TEST_F(SlowStage, ArrivesWithTheAdvisedHoldUnderAProportionalGain) {
  EXPECT_GE(arrived_with_advised_hold({"controller.kp=0.01"}), moves_of_stage * 95 / 100);
  EXPECT_GT(undecided("slow.h5")["falling_with_ripple"], 0);
  const std::string table = run({"summary", "slow.h5"}).out;
  EXPECT_TRUE(says(table, "; it was falling, with a ripple of one count, in "));
}

TEST_F(SlowStage, CheckWarnsBeforeItRuns) {
  const std::string slow = run({"check", "stage.yaml"}).err;
  EXPECT_TRUE(says(slow, "warning: point 0 (all): the loop's slowest time constant is 0.2",
                   "longer than the hold of 0.3 s: moves may end before they arrive"));
  const std::string slower = run({"check", "stage.yaml"}, {"controller.ki=1.0e-6"}).err;
  EXPECT_TRUE(says(slower, "exceeds the hold of 0.3 s; a move of "));
  EXPECT_EQ(run({"check", "stage.yaml"}, {"command.hold=1.1"}).err, "");
}

// The rates of a study against a Monte Carlo that has nothing in common with it: other random numbers, other
// distributions code, another integrator, measures written again from their definitions.

/// Number of trials of the study under test, and of the independent Monte Carlo that judges it.
struct Numbers {
  int study;
  int judge;
};

struct Histogram {
  int trials{0};
  int zero_count{0};
  int stable{0};
  int broke_away{0};
  std::vector<double> settling_times;  // s
};

std::string manifest(double ki, int trials) {
  return "zerocount: 1\nname: rates\nseed: 77\ntrials: " + std::to_string(trials) +
         "\nfriction: {k1: {uniform: [80, 140]}, k2: {uniform: [600, 900]}, alpha: {log_uniform: [0.2, 2]}}\n"
         "controller: {ki: " +
         fmt::format("{}", ki) +
         "}\ncommand: {targets: [{integers: [1, 20]}], hold: 0.12}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}}\nverdict: {dwell: 0.02, window: 0.02}\n";
}

Histogram tally_of_study(double ki, int trials) {
  const study::Study study = manifest::parse_study(manifest(ki, trials), "rates.yaml");
  EXPECT_EQ(study::study_trial(study, 0, 0).parameters.controller.ki, ki);
  Histogram histogram;
  for (std::int64_t row = 0; row < study.trials; ++row) {
    const trial::MoveOutcome move = trials::run_study_trial(study, row).outcome.moves[0];
    ++histogram.trials;
    histogram.zero_count += move.outcome == trial::Outcome::zero_count;
    histogram.stable += move.stable;
    histogram.broke_away += move.broke_away;
    if (move.arrived) histogram.settling_times.push_back(move.arrival_time);
  }
  return histogram;
}

trial::TrialParameters random_machine(std::mt19937_64& random, double ki) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  trial::TrialParameters p;
  p.friction.uniform.k1 = uniform(80, 140);
  p.friction.uniform.k2 = uniform(600, 900);
  p.friction.uniform.alpha = std::exp(uniform(std::log(0.2), std::log(2.0)));
  p.controller.ki = ki;
  p.command = {{std::uniform_int_distribution<std::int64_t>(1, 20)(random)}, 0.12};
  p.initial.encoder_phase = uniform(0, 1);
  return p;
}

Histogram tally_of_judge(double ki, int trials) {
  std::mt19937_64 random(20021);
  Histogram histogram;
  for (int i = 0; i < trials; ++i) {
    EventCounts events;
    const std::vector<trial::SampleRecord> samples = odeint_trial(random_machine(random, ki), &events);
    const auto zero = [](const trial::SampleRecord& s) { return s.error == 0; };
    const auto within_one = [](const trial::SampleRecord& s) { return std::abs(s.error) <= 1; };
    auto arrival = samples.end();
    for (auto at = samples.begin(); samples.end() - at >= 40 && arrival == samples.end(); ++at) {
      if (std::all_of(at, at + 40, zero)) arrival = at;
    }
    const bool arrived = arrival != samples.end();
    ++histogram.trials;
    histogram.zero_count += std::all_of(samples.end() - 40, samples.end(), zero);
    histogram.stable += arrived && std::all_of(arrival, samples.end(), within_one);
    histogram.broke_away += events.breakaways > 0;
    if (arrived) histogram.settling_times.push_back(static_cast<double>(arrival - samples.begin()) / 2000.0);
  }
  return histogram;
}

/// Distance of two proportions in standard errors of their difference.
double distance(int k1, int n1, int k2, int n2) {
  const double p = static_cast<double>(k1 + k2) / (n1 + n2);
  if (p == 0.0 || p == 1.0) return 0.0;
  return (static_cast<double>(k1) / n1 - static_cast<double>(k2) / n2) /
         std::sqrt(p * (1 - p) * (1.0 / n1 + 1.0 / n2));
}

/// Two-sample Kolmogorov–Smirnov statistic times √(nm/(n+m)); above 2.0 with a probability below 7e-4.
double kolmogorov_smirnov(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double largest = 0.0;
  std::vector<double> places = a;
  places.insert(places.end(), b.begin(), b.end());
  for (const double x : places) {
    const auto below = [x](const std::vector<double>& v) {
      return static_cast<double>(std::upper_bound(v.begin(), v.end(), x) - v.begin()) /
             static_cast<double>(v.size());
    };
    largest = std::max(largest, std::abs(below(a) - below(b)));
  }
  const auto n = static_cast<double>(a.size());
  const auto m = static_cast<double>(b.size());
  return largest * std::sqrt(n * m / (n + m));
}

class IndependentRates : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Gains, IndependentRates, ::testing::Values(3.85e-5, 9.45e-5));

void expect_agreement_of_rates(double ki, const Numbers& trials) {
  const Histogram study = tally_of_study(ki, trials.study);
  const Histogram judge = tally_of_judge(ki, trials.judge);
  const auto z = [&](int Histogram::*count) {
    return distance(study.*count, study.trials, judge.*count, judge.trials);
  };
  EXPECT_LT(std::abs(z(&Histogram::zero_count)), 3.5);
  EXPECT_LT(std::abs(z(&Histogram::stable)), 3.5);
  EXPECT_LT(std::abs(z(&Histogram::broke_away)), 3.5);
  EXPECT_LT(kolmogorov_smirnov(study.settling_times, judge.settling_times), 2.0);
  std::printf(
      "zero-count %.3f / %.3f, stable %.3f / %.3f, broke away %.3f / %.3f\n",
      static_cast<double>(study.zero_count) / study.trials,
      static_cast<double>(judge.zero_count) / judge.trials, static_cast<double>(study.stable) / study.trials,
      static_cast<double>(judge.stable) / judge.trials, static_cast<double>(study.broke_away) / study.trials,
      static_cast<double>(judge.broke_away) / judge.trials);
}

TEST_P(IndependentRates, AgreeWithinSamplingError) {
  expect_agreement_of_rates(GetParam(), {1000, 150});
}

TEST_P(IndependentRates, DISABLED_AgreeWithinTheSamplingErrorOfManyTrials) {
  expect_agreement_of_rates(GetParam(), {4000, 500});
}

}  // namespace
}  // namespace zerocount::testing
