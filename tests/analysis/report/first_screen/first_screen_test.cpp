// The first screen: what is required and whether it is met, the gains in the open, and what is assumed.
#include "analysis/report/first_screen/first_screen.hpp"

#include "analysis/trials/summary/move_behaviour.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/sections/external_inputs.hpp"
#include "tests/analysis/report/run_studies.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

using testing::TemporaryFolder;
using testing::times_in;

TEST(Quantity, IsNotBrokenFromItsUnit) {
  EXPECT_EQ(quantity_text(50.0, "N m s/rad"), "50\u00a0N\u00a0m\u00a0s/rad");
  EXPECT_EQ(range_text(5e-4, 5e-3, "m/s"), "0.5 … 5\u00a0mm/s");
  EXPECT_EQ(list_text(std::vector{2e-5, 2.1e-5, 0.0}, "m"), "20, 21, 0\u00a0µm");
}

const char* const two_goals =
    "zerocount: 1\nname: two\nseed: 3\nmachines: 4\ntrials: 16\ncommand: {targets: [3, 30], hold: 0.15}\n"
    "goals: {small: {\"on\": [0], band: 2, within: 0.1, moves: 0.5},\n"
    "  large: {\"on\": [1], band: 1, within: 0.12, moves: 0.6, machines: 0.5, limits: {overshoot: 20}}}\n"
    "conditions: {plain: {}, heavy: {plant.inertia: 8.0e-4}}\n"
    "friction: {k1: {uniform: [100, 130], per: machine}}\ncontroller: {ki: 2.0e-5, delay: 0}\n"
    "verdict: {dwell: 0.02, window: 0.02}\n"
    "tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}}}\n";

/// The text of the first screen of a report on a study with this manifest.
std::string screen_of(const std::string& manifest, const FirstScreenParts& parts = {}) {
  const TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5", manifest);
  const reading::AllTrialsFile file(folder / "a.h5");
  return first_screen(reported_study(file), parts).html;
}

TEST(FirstScreen, HasAVerdictForEachGoalUnderEachCondition) {
  const std::string html = screen_of(two_goals);
  EXPECT_EQ(times_in(html, "data-head=\"verdict\""), 4U);
  EXPECT_EQ(times_in(html, "<td class=\"text\" data-head=\"condition\">plain<"), 2U);
  EXPECT_EQ(times_in(html, "<td class=\"text\" data-head=\"condition\">heavy<"), 2U);
  EXPECT_TRUE(says(html,
                   "<b>large</b> ±1\u00a0count for good after 120\u00a0ms; overshoot ≤ 20\u00a0counts; in "
                   "60&nbsp;% of moves 1 of 50&nbsp;% of the machines, with 95&nbsp;% confidence"));
  for (const char* const head : {"overshoot (95 %)", "peak torque", "moves that saturate"})
    EXPECT_EQ(times_in(html, std::string("data-head=\"") + head), 4U) << head;
}

TEST(FirstScreen, ShowsTheMovesOfEachGoalUnderItsCondition) {
  const TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5", two_goals);
  const reading::AllTrialsFile file(folder / "a.h5");
  const std::string html = first_screen(reported_study(file), {}).html;
  std::size_t at = 0;
  std::set<double> peaks;
  for (const summary::MoveBehaviour& row : summary::behaviour_in(file, file.study())) {
    peaks.insert(row.peak_torque.max);
    at = html.find("data-head=\"peak torque\">" + quantity_text(row.peak_torque.max, "N m") + ",", at + 1);
    ASSERT_NE(at, std::string::npos) << *row.goal << " " << *row.setting;
  }
  EXPECT_GE(peaks.size(), 3U);
}

TEST(FirstScreen, ShowsEveryGain) {
  const std::string html = screen_of(two_goals);
  EXPECT_EQ(times_in(html, "<details"), 0U);
  EXPECT_TRUE(says(html, ">ki</td>", "2e-5\u00a0N\u00a0m/count", "1e-5 … 0.0001"));  // the range of tune
}

TEST(FirstScreen, NamesEachAssumptionByItsSource) {
  const std::string html = screen_of(two_goals);
  const std::size_t given = html.find("given in the manifest");
  const std::size_t assumed = html.find("assumed: defaults");
  const std::size_t stated = html.find("stated as absent");
  const std::size_t away = html.find("assumed away");
  ASSERT_LT(given, assumed);
  ASSERT_LT(assumed, stated);
  ASSERT_LT(stated, away);
  const auto between = [&](std::size_t from, std::size_t to, const char* words) {
    return html.substr(from, to - from).find(words) != std::string::npos;
  };
  EXPECT_TRUE(between(given, assumed, "friction.k1</b> 100 … 130\u00a0N\u00a0m/rad, per machine"));
  EXPECT_TRUE(between(assumed, stated, "beta</b> 1e5"));
  EXPECT_TRUE(between(assumed, stated, "k2"));
  EXPECT_TRUE(between(stated, away, "no delay"));
  EXPECT_TRUE(between(away, html.size(), "no jitter"));
  EXPECT_FALSE(between(given, assumed, "controller.ki"));  // it is chosen, not assumed
}

TEST(FirstScreen, ShowsTheHeadlineAndMarginsOfATuning) {
  const std::string html =
      screen_of(two_goals, {.headline = "proven", .margins = "<p>those of the tuning</p>"});
  EXPECT_TRUE(says(html, ">proven</p>", "those of the tuning"));
  EXPECT_FALSE(says(html, "crossover"));
}

TEST(FirstScreen, AStudyWithoutAGoalHasNoVerdicts) {
  const std::string html = screen_of(testing::rich_manifest(8));
  EXPECT_FALSE(says(html, "data-head=\"verdict\""));
  EXPECT_TRUE(says(html, "No goal is stated", "moves that saturate"));
}

// The block diagram: every block of the axis with its numbers. The browser's test looks at its layout.

study::Study axis(const std::string& more) {
  return manifest::parse_study("zerocount: 1\nname: axis\nseed: 1\ntrials: 2\n" + more, "test");
}

const std::string long_controller =
    "command: {targets: [3, 9, 27, 81, 0], hold: 0.15, profile: {shape: trapezoidal}}\n"
    "controller: {kp: 1.0e-4, ki: 2.0e-5, kd: 1.0e-4, delay: 1, derivative_cutoff: 400,\n"
    "  filters: [{notch: {frequency: 400, damping: 0.1, depth: 0.2}}, {lowpass: {frequency: 900, damping: "
    "0.7}}],\n"
    "  observer: {bandwidth: 30}, deadband: {enter: 1, leave: 2}, integrator_zone: 40,\n"
    "  feedforward: {velocity: 0.1, acceleration: 5.0e-4, friction: 0.2}}\n"
    "plant: {load: {inertia: 1.0e-4}}\namplifier: {bandwidth: 500}\n"
    "disturbance: {torque: 0.01, vibration: [{amplitude: 0.002, frequency: 50}]}\n"
    "encoder: {fine_errors: {noise: 0.2}}\n";

const char* const linear =
    "axis: linear\ncommand: {targets: [200], hold: 0.05}\nplant: {inertia: 2, presliding_damping: 300, "
    "sliding_damping: 10}\nfriction: {model: coulomb, breakaway: 5, coulomb_ratio: 1, stribeck_velocity: "
    "0.001}\n"
    "encoder: {resolution: 1.0e-8}\ndac: {bits: 16, range: 40}\ncontroller: {units: si, kp: 1.0e+6, ki: "
    "1.0e+8, "
    "kd: 2000}\n";

TEST(Diagram, NamesEachActiveBlockWithItsParameters) {
  const std::string html = diagram_html(axis(long_controller), 0);
  EXPECT_TRUE(says(html, ">kp 0.0001", ">ki 2e-5",
                   "<span>notch 400\u00a0Hz</span>\n<span>low-pass 900\u00a0Hz</span>", "observer 30",
                   "derivative low-pass 400", "integral frozen within 1", "feed-forward: velocity\u00a00.1",
                   "integrates within 40", "delay 1", "load 0.0001", "<b>Friction: presliding</b>",
                   "noise 0.2\u00a0counts rms", "bandwidth 500"));
  EXPECT_TRUE(says(
      html, "<b>Disturbance</b>\n<span>constant 0.01\u00a0N\u00a0m</span>\n<span>0.002\u00a0N\u00a0m at 50"));
  EXPECT_FALSE(says(html, "none") || says(html, "dither") || says(html, "coarse"));
  EXPECT_EQ(html.find_first_of("{}@#~|"), std::string::npos) << html;
}

TEST(Diagram, SpeaksOfForcesAndLengthsOnALinearAxis) {
  const std::string html = diagram_html(axis(linear), 0);
  EXPECT_TRUE(says(html, "<b>Motor and slide</b>\n<span>mass 2\u00a0kg</span>",
                   "<span>16\u00a0bit, ±40\u00a0N</span>", "<span>1 count = 10\u00a0nm</span>",
                   "<b>Friction: coulomb</b>", "ideal amplifier"));
  EXPECT_FALSE(says(html, "k1"));  // Coulomb's law has none
}

// A list is one parameter after the other, each with its range over the conditions.
TEST(Diagram, ShowsTheValuesOfAllConditions) {
  const std::string html = diagram_html(
      axis("command: {targets: [3], hold: 0.15}\nfriction: {k1: {lognormal: {median: 100, cv: 0.1}}}\n"
           "controller: {filters: [{notch: {frequency: 400, damping: 0.1, depth: 0.2}}]}\n"
           "disturbance: {ripple: [{amplitude: 8.0e-3, periods: 1}, {amplitude: {uniform: [1.0e-3, 3.0e-3]}, "
           "periods: 200}], vibration: [{amplitude: 0.002, frequency: 50}]}\n"
           "conditions: {empty: {}, loaded: {disturbance.ripple.0.amplitude: 0.045, "
           "controller.filters.0.frequency: 300, disturbance.vibration.0.frequency: 60, "
           "friction.k1: {lognormal: {median: 200, cv: 0.1}}}}\n"),
      0);
  EXPECT_TRUE(
      says(html,
           "ripple 0.008 … 0.045\u00a0N\u00a0m</span>\n<span>ripple 0.001 … 0.003\u00a0N\u00a0m</span>\n"
           "<span>0.002\u00a0N\u00a0m at 50 … 60\u00a0Hz</span>",
           "<span>notch 300 … 400\u00a0Hz</span>", "<span>k1 about 100 … 200\u00a0N\u00a0m/rad</span>"));
}

TEST(Diagram, ShowsTheCoarsePhaseAfterTheFinePhase) {
  const std::string html = diagram_html(
      axis(
          "command: {targets: [3000], hold: 0.5}\ncontroller: {ki: 2.0e-5, filters: [{biquad: {b: [1, 0, 0], "
          "a: [0.5, 0]}}], coarse: {coarse_beyond: 300, kp: 2.0e-4}}\n"),
      0);
  EXPECT_LT(html.find("ki 2e-5"), html.find("coarse phase beyond 300"));
  EXPECT_LT(html.find("coarse phase beyond"), html.find("kp 0.0002"));
  EXPECT_TRUE(says(html, "biquad b 1, 0, 0; a 0.5, 0"));
}

TEST(Diagram, EscapesTheNameOfAPluginAndHasAllItsParameters) {
  plugin::ControllerPlugin law{.description = {"</div><script>", "1", "", {}}};
  for (int i = 0; i < 40; ++i)
    law.description.parameters.push_back({fmt::format("own{}", i), "1", "any", 0.5, 0.0, 1.0});
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: a\nseed: 3\ntrials: 1\ncommand: {targets: [3], hold: 0.15}\n"
      "controller: {plugin: own.so}\n",
      "a.yaml", {},
      {.plugin = sections::known_plugin(std::make_shared<const plugin::ControllerPlugin>(law))});
  const std::string html = diagram_html(study, 0);
  EXPECT_TRUE(says(html, "plugin &lt;/div&gt;&lt;script&gt;", "own0 0.5", "own39 0.5")) << html;
  EXPECT_FALSE(says(html, "<script"));
}

TEST(Diagram, NamesTheMassThatEachEncoderReads) {
  const std::string two_masses = "command: {targets: [3], hold: 0.15}\n";
  const std::string of_load = diagram_html(
      axis(two_masses +
           "plant: {load: {inertia: 1.0e-4, encoder: load, gap: 2.0e-4, friction: {model: coulomb, "
           "breakaway: 0.02}}}\ndisturbance: {load: {torque: 0.04}}\n"),
      0);
  EXPECT_TRUE(says(of_load, "<span>at the load, which closes the loop</span>", "gap 200",
                   "<span>friction of the load: coulomb, breakaway 0.02",
                   "constant 0.04\u00a0N\u00a0m on the load"))
      << of_load;
  EXPECT_FALSE(says(of_load, "velocity loop"));
  const std::string alone = diagram_html(axis(two_masses), 0);
  EXPECT_FALSE(says(alone, "motor, which") || says(alone, "of the load") || says(alone, "on the load"));

  // Two encoders: the position loop reads the load, the velocity loop the motor, and each has its own count.
  const std::string both = diagram_html(
      axis(two_masses +
           "plant: {load: {inertia: 1.0e-4}}\n"
           "encoder: {fine: 360000, fine_errors: {noise: 0.3}, load: {counts_per_revolution: 720000, "
           "fine_errors: "
           "{noise: 0.7}}}\n"
           "controller: {structure: cascade, cascade: {kv: 40, kp: 0.03, ki: 0.3, position: load, velocity: "
           "motor}}\n"),
      0);
  EXPECT_TRUE(says(both, "<span>1 count = 8.727", "at the load, which closes the position loop",
                   "at the motor: 1 count = 17.45", "motor: noise 0.3", "load: noise 0.7",
                   "the velocity loop reads the motor"))
      << both;
}

TEST(Diagram, AnOpenLoopHasNoController) {
  const std::string html = diagram_html(axis("command: {torque: {levels: [0.1, 0]}}\n"), 0);
  EXPECT_TRUE(says(html, "<b>Torque levels</b>\n<span>0.1, 0\u00a0N\u00a0m</span>"));
  EXPECT_FALSE(says(html, "sum") || says(html, "controller") || says(html, "hold"));
}

}  // namespace
}  // namespace zerocount::report
