// The block diagram: every block of the axis with its numbers. The browser's test looks at its layout.
#include "analysis/report/first_screen/first_screen.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

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

TEST(Diagram, NamesEachBlockThatIsOnWithItsNumbers) {
  const AxisDiagram diagram = axis_diagram(axis(long_controller), 0);
  std::string control;
  for (const std::string& line : diagram.controller->lines) control += line + "\n";
  for (const char* const words :
       {"kp 0.0001", "ki 2e-5", "notch 400", "low-pass 900", "observer 30", "derivative low-pass 400",
        "integral frozen within 1", "feed-forward velocity", "integrates within 40", "delay 1"})
    EXPECT_NE(control.find(words), std::string::npos) << words << "\n" << control;
  EXPECT_EQ(control.find("none"), std::string::npos) << control;
  EXPECT_EQ(control.find("dither"), std::string::npos) << control;
  EXPECT_EQ(diagram.friction->title, "Friction: presliding");
  EXPECT_EQ(diagram.disturbance->lines.size(), 2U);
}

TEST(Diagram, SpeaksOfForcesAndLengthsOnALinearAxis) {
  const AxisDiagram diagram = axis_diagram(axis(linear), 0);
  EXPECT_EQ(diagram.plant.title, "Motor and slide");
  EXPECT_EQ(diagram.plant.lines.front(), "mass 2\u00a0kg");
  EXPECT_EQ(diagram.drive.lines.front(), "16\u00a0bit, ±40\u00a0N");
  EXPECT_EQ(diagram.encoder.lines.front(), "1 count = 10\u00a0nm");
  EXPECT_EQ(diagram.friction->title, "Friction: coulomb");
}

// A list is one parameter after the other, each with its range over the conditions.
TEST(Diagram, ShowsTheValuesOfAllConditions) {
  const AxisDiagram diagram = axis_diagram(
      axis("command: {targets: [3], hold: 0.15}\nfriction: {k1: {lognormal: {median: 100, cv: 0.1}}}\n"
           "controller: {filters: [{notch: {frequency: 400, damping: 0.1, depth: 0.2}}]}\n"
           "disturbance: {ripple: [{amplitude: 8.0e-3, periods: 1}, {amplitude: {uniform: [1.0e-3, 3.0e-3]}, "
           "periods: 200}], vibration: [{amplitude: 0.002, frequency: 50}]}\n"
           "conditions: {empty: {}, loaded: {disturbance.ripple.0.amplitude: 0.045, "
           "controller.filters.0.frequency: 300, disturbance.vibration.0.frequency: 60, "
           "friction.k1: {lognormal: {median: 200, cv: 0.1}}}}\n"),
      0);
  EXPECT_EQ(diagram.disturbance->lines, (std::vector<std::string>{"ripple 0.008 … 0.045\u00a0N\u00a0m",
                                                                  "ripple 0.001 … 0.003\u00a0N\u00a0m",
                                                                  "0.002\u00a0N\u00a0m at 50 … 60\u00a0Hz"}));
  EXPECT_NE(std::ranges::find(diagram.controller->lines, "notch 300 … 400\u00a0Hz"),
            diagram.controller->lines.end());
  EXPECT_EQ(diagram.friction->lines.front(), "k1 about 100 … 200\u00a0N\u00a0m/rad");
}

TEST(Diagram, AnOpenLoopHasNoController) {
  const study::Study open = axis("command: {torque: {levels: [0.1, 0]}}\n");
  EXPECT_FALSE(axis_diagram(open, 0).controller);
  EXPECT_EQ(diagram_html(axis_diagram(open, 0)).find("sum"), std::string::npos);
}

TEST(Diagram, EscapesNames) {
  AxisDiagram diagram = axis_diagram(axis("command: {targets: [3], hold: 0.15}\n"), 0);
  diagram.controller->lines.emplace_back("</div><script>");
  EXPECT_EQ(diagram_html(diagram).find("<script"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::report
