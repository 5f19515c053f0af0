#include "analysis/record/experiment_design/experiment_design.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/basis/document/answer.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::experiment_design {
namespace {

/// Manifest of an axis like the paper's with a noisy encoder. k1, k2 and β are known to a factor of 3, with a
/// coefficient of variation of 0.6.
std::string manifest_with(const std::string& more = "", double spread = 0.3, double k1 = 110.0,
                          double beta = 1e5) {
  return fmt::format(
      "zerocount: 1\nname: test\nseed: 3\ntrials: 100\ncommand: {{targets: [0]}}\n"
      "plant: {{inertia: 5.5e-4, presliding_damping: 0.2}}\n"
      "friction: {{k1: {{lognormal: {{median: {1}, cv: {0}}}}}, k2: {{lognormal: {{median: 750, cv: "
      "{0}}}}},\n"
      "  beta: {{lognormal: {{median: {2:e}, cv: {0}}}}}, alpha: {{lognormal: {{median: 0.5, cv: 0.3}}}},\n"
      "  breakaway: {{uniform: [0.25, 0.4]}}}}\n"
      "initial: {{encoder_phase: {{uniform: [0, 1]}}}}\nencoder: {{fine_errors: {{noise: 0.2}}}}\n{3}",
      spread, k1, beta, more);
}

study::Study study_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return manifest::parse_study(text, "m.yaml", overrides);
}

DesignSettings quick_settings() {
  DesignSettings settings;
  settings.duration = 1.2;
  settings.machines = 5;
  settings.search.max_protocols = 10;
  return settings;
}

/// The experiment design that the tests look at, computed once for all of them.
const ExperimentDesign& quick_design() {
  static const ExperimentDesign design = design_experiment(study_of(manifest_with()), quick_settings());
  return design;
}

const ExpectedParameter& parameter_of(const ExperimentDesign& design, const std::string& key) {
  return *std::ranges::find(design.parameters, key, &ExpectedParameter::key);
}

TEST(ExperimentDesign, StaysBelowBreakawayOnUnseenMachines) {
  const ExperimentDesign& design = quick_design();
  const std::vector<Machine> machines = drawn_machines(study_of(manifest_with()), 0, 40);
  int beyond = 0;
  for (const Machine& machine : machines) {
    const SimulatedRecord record = simulate(machine, design.protocol);
    EXPECT_FALSE(record.slid);
    beyond += record.travel > design.travel ? 1 : 0;
  }
  EXPECT_LE(beyond, 20);  // the travel that it tells is the largest of 7 machines
}

TEST(ExperimentDesign, StaysWithinTheAllowedTravel) {
  DesignSettings settings = quick_settings();
  settings.search.max_protocols = 6;
  settings.max_travel = 0.4 * quick_design().travel;
  const study::Study study = study_of(manifest_with());
  const ExperimentDesign design = design_experiment(study, settings);
  EXPECT_LE(design.travel, settings.max_travel);
  EXPECT_GT(design.travel, 0.1 * settings.max_travel);  // it uses what is allowed
  double travel = 0.0;
  for (const Machine& machine : drawn_machines(study, 0, settings.machines)) {
    for (const double angle : simulate(machine, design.protocol).angle)
      travel = std::max(travel, std::abs(angle));
  }
  travel = std::max(travel, simulate(design.median, design.protocol).travel);
  EXPECT_EQ(travel, design.travel);
}

TEST(ExperimentDesign, SimulationDetectsMachinesThatBreakAway) {
  const ExperimentDesign& design = quick_design();
  Machine weak = design.median;
  weak.parameters.friction.uniform.breakaway = 0.5 * design.shape.amplitude * design.frame.max_torque;
  EXPECT_TRUE(simulate(weak, design.protocol).slid);
}

// The usual tests of the identification's own suite, in the same time and on the same machine.
TEST(ExperimentDesign, GivesNarrowerIntervalsThanTheUsualTest) {
  const ExperimentDesign& design = quick_design();
  testing::TorqueProgramme usual(design.frame.sample_time);
  for (int i = 0; i < 2; ++i) usual.step(0.06).hold(0.03).step(0.0).hold(0.03);
  usual.ramp(0.1, 1.5).hold(0.2).ramp(-0.12, 1.5).ramp(0.12, 1.5).ramp(0.0, 1.5).ramp(0.16, 1.5);
  usual.hold(1.2 - 0.05 - static_cast<double>(usual.torque().size()) * design.frame.sample_time)
      .ramp(0.0, 5.0);
  TorqueProtocol protocol;
  protocol.sample_time = design.frame.sample_time;
  protocol.torque = usual.torque();
  for (const double torque : protocol.torque)
    protocol.codes.push_back(std::lround(torque / design.frame.dac.resolution));
  const auto spread = [&](const TorqueProtocol& one) {
    return log_spread(design.median, one, simulate(design.median, one));
  };
  EXPECT_NEAR(static_cast<double>(protocol.torque.size()), static_cast<double>(design.frame.samples), 100.0);
  EXPECT_LT(std::exp(spread(design.protocol)), 0.8 * std::exp(spread(protocol)));
}

TEST(ExperimentDesign, EachListedImprovementLowersTheSpread) {
  const auto& improvements = quick_design().search.improvements;
  ASSERT_GE(improvements.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(improvements, std::greater<>(), &JudgedShape::spread));
}

// The widths of the linear theory are those that `identify` reports of simulated records.
TEST(ExperimentDesign, IdentifyReportsTheExpectedWidths) {
  const ExperimentDesign& design = quick_design();
  for (const Machine& machine : drawn_machines(study_of(manifest_with()), 0, 2)) {
    const SimulatedRecord record = simulate(machine, design.protocol);
    const Widths widths = expected_widths(machine, design.protocol, record);
    const auto found = identified(machine, design.protocol, record, {});
    EXPECT_LT(found.checks.widening, 1.25);
    for (const fit::ParameterEstimate& one : found.parameters) {
      const auto key = std::ranges::find(fit::coordinate_keys, one.key);
      if (one.key.empty() || one.status != fit::EstimateStatus::estimated) continue;
      const double expected = widths[static_cast<std::size_t>(key - fit::coordinate_keys.begin())];
      const double width =
          one.key == "friction.n" ? 0.5 * (one.high - one.low) : 0.5 * std::log(one.high / one.low);
      EXPECT_LT(width / expected, 1.5) << one.key;
      EXPECT_GT(width / expected, 1 / 1.5) << one.key;
    }
  }
}

std::string text_of(const ExperimentDesign& design) {
  const document::AnswerDescription<ExperimentDesign> answer{
      {.name = "experiment", .meaning = "a designed experiment"}, design_description()};
  return document::text(answer.of(design));
}

TEST(ExperimentDesign, ReportsParametersThatCannotBeIdentified) {
  DesignSettings settings = quick_settings();
  settings.search.max_protocols = 4;
  settings.machines = 2;
  const ExperimentDesign design =
      design_experiment(study_of(manifest_with(), {"friction.alpha=0.005", "encoder.fine=50000"}), settings);
  EXPECT_EQ(parameter_of(design, "friction.alpha").found.status, fit::EstimateStatus::not_identifiable);
  EXPECT_EQ(parameter_of(design, "friction.alpha").told, 0);
  EXPECT_EQ(parameter_of(design, "friction.k1").found.status, fit::EstimateStatus::estimated);
  EXPECT_NE(text_of(design).find("friction.alpha cannot be identified from this record, because "),
            std::string::npos)
      << text_of(design);
}

// k1 and β are a factor of 3 off their guesses, which the spread of the manifest allows.
TEST(ExperimentDesign, ASecondExperimentFollowsFromTheFirst) {
  const study::Study guessed = study_of(manifest_with("", 0.6, 110.0 / 3.0, 3e5));
  const ExperimentDesign first = design_experiment(guessed, quick_settings());
  Machine truth = median_machine(study_of(manifest_with("", 0.3)), 0);
  const SimulatedRecord record = simulate(truth, first.protocol);
  ASSERT_FALSE(record.slid);
  const auto found = identified(truth, first.protocol, record, {});
  ASSERT_LT(found.checks.widening, 1.25);
  const study::Study told = study_of(
      "zerocount: 1\nname: second\nseed: 3\ntrials: 100\ncommand: {targets: [0]}\n"
      "initial: {encoder_phase: {uniform: [0, 1]}}\nencoder: {fine_errors: {noise: 0.2}}\n" +
      found.fragment);
  DesignSettings settings = quick_settings();
  const ExperimentDesign second = design_experiment(told, settings);
  const auto spread = [&](const ExperimentDesign& design) {
    const SimulatedRecord of_truth = simulate(truth, design.protocol);
    EXPECT_FALSE(of_truth.slid);
    return log_spread(truth, design.protocol, of_truth);
  };
  EXPECT_LT(spread(second), spread(first) + 0.02);
}

TEST(ExperimentDesign, ALinearAxisIsDesignedInForceAndPosition) {
  const std::string linear =
      "zerocount: 1\nname: linear\naxis: linear\ntravel: 0.1\nseed: 3\ntrials: 100\ncommand: {targets: [0]}\n"
      "plant: {inertia: 0.55, presliding_damping: 200, sliding_damping: 1}\n"
      "friction: {k1: 1.1e+5, k2: 7.5e+5, beta: 3.0e+6, lambda: 1.0e+5, breakaway: {uniform: [8, 12]},\n"
      "  stribeck_velocity: 1.0e-3}\n"
      "encoder: {resolution: 1.2e-7}\ndac: {resolution: 7.0e-3}\n"
      "controller: {units: si, ki: 1.0e+5}\ninitial: {encoder_phase: {uniform: [0, 1]}}\n";
  const ExperimentDesign design = design_experiment(study_of(linear), quick_settings());
  EXPECT_EQ(parameter_of(design, "friction.k1").unit, "N/m");
  EXPECT_EQ(parameter_of(design, "friction.k1").found.status, fit::EstimateStatus::estimated);
  EXPECT_TRUE(protocol_table(design).starts_with("t [s],force [N],code\n"));
  EXPECT_EQ(text_of(design).find("N m"), std::string::npos) << text_of(design);
}

TEST(ExperimentDesign, FilesHaveALineForEachSample) {
  const ExperimentDesign& design = quick_design();
  const auto samples = static_cast<std::ptrdiff_t>(design.protocol.torque.size());
  const std::string streamed = streamer_file(design.protocol);
  EXPECT_EQ(std::ranges::count(streamed, '\n'), samples);
  std::istringstream lines(streamed);
  double torque = 0.0;
  for (const double expected : design.protocol.torque) {
    ASSERT_TRUE(lines >> torque);
    ASSERT_EQ(torque, expected);
  }
  EXPECT_EQ(std::ranges::count(protocol_table(design), '\n'), samples + 1);
  EXPECT_TRUE(record_table(design).starts_with("t [s],torque [N m],count\n0,0,0\n"));
}

/// The message with which the design of an experiment for the study is refused; empty if it is not refused.
std::string refusal_of(const study::Study& study, const DesignSettings& settings) {
  try {
    design_experiment(study, settings);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

TEST(ExperimentDesign, RefusesLoadsOtherLawsAndImpossibleLimits) {
  DesignSettings settings = quick_settings();
  EXPECT_NE(refusal_of(study_of(manifest_with(), {"friction.model=lugre"}), settings).find("presliding"),
            std::string::npos);
  EXPECT_NE(refusal_of(study_of(manifest_with(""), {"plant.load.inertia=1e-4"}), settings).find("plant.load"),
            std::string::npos);
  settings.max_travel = 1e-7;
  EXPECT_NE(refusal_of(study_of(manifest_with()), settings).find("only 1e-07 rad are allowed"),
            std::string::npos);
  settings = quick_settings();
  settings.duration = 0.1;
  EXPECT_NE(refusal_of(study_of(manifest_with()), settings).find("too short"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::experiment_design
