// The block diagram: every block of the axis with its numbers, in frames that do not overlap, with text that
// they hold.
#include "analysis/report/first_screen/axis_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/text/text.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::report {
namespace {

struct Frame {
  double x, y, width, height;
};

std::vector<double> numbers_in(const std::string& text) {
  static const std::regex number("-?[0-9]+(\\.[0-9]+)?");
  std::vector<double> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at)
    numbers.push_back(std::stod(at->str()));
  return numbers;
}

std::vector<Frame> frames_of(const std::string& svg) {
  static const std::regex rect("<rect ([^/]*)/>");
  std::vector<Frame> frames;
  for (std::sregex_iterator at(svg.begin(), svg.end(), rect), end; at != end; ++at) {
    const std::vector<double> n = numbers_in((*at)[1].str());
    frames.push_back({n[0], n[1], n[2], n[3]});
  }
  return frames;
}

struct Line {
  double x, y;
  std::string text;
};

std::vector<Line> lines_of(const std::string& svg) {
  static const std::regex text(
      "<text[^>]* x=\"([0-9.-]+)\" y=\"([0-9.-]+)\">([^<]*)</text>|"
      "<text x=\"([0-9.-]+)\" y=\"([0-9.-]+)\">([^<]*)</text>");
  std::vector<Line> lines;
  for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at)
    lines.push_back({std::stod((*at)[1].str()), std::stod((*at)[2].str()), (*at)[3].str()});
  return lines;
}

bool overlap(const Frame& a, const Frame& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

std::vector<std::string> drawings_of(const study::Study& study) {
  const std::string svg = axis_svg(axis_diagram(study, 0));
  const std::size_t second = svg.find("<svg", 1);
  return {svg.substr(0, second), svg.substr(second)};
}

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

TEST(AxisDrawing, HoldsItsTextInFramesThatDoNotOverlap) {
  for (const std::string& manifest :
       {std::string("command: {targets: [3], hold: 0.15}\n"), long_controller, std::string(linear),
        std::string("command: {torque: {levels: [0.1, 0]}}\n")}) {
    for (const std::string& svg : drawings_of(axis(manifest))) {
      const std::vector<Frame> frames = frames_of(svg);
      ASSERT_GE(frames.size(), 4U);
      for (std::size_t i = 0; i < frames.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(frames[i], frames[j])) << i << " " << j;
      }
      for (const Line& line : lines_of(svg)) {
        // Labels of signals stand beside their lines.
        if (line.text.size() <= 3 || line.text.starts_with("Disturbance:")) continue;
        const auto holder = std::ranges::find_if(frames, [&](const Frame& frame) {
          return line.x > frame.x && line.x < frame.x + frame.width && line.y > frame.y &&
                 line.y < frame.y + frame.height;
        });
        ASSERT_NE(holder, frames.end()) << line.text;
        EXPECT_LT(line.x + 6.0 * static_cast<double>(text::display_width(line.text)),
                  holder->x + holder->width)
            << line.text;
      }
    }
  }
}

TEST(AxisDrawing, NamesEachBlockThatIsOnWithItsNumbers) {
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

TEST(AxisDrawing, SpeaksOfForcesAndLengthsOnALinearAxis) {
  const AxisDiagram diagram = axis_diagram(axis(linear), 0);
  EXPECT_EQ(diagram.plant.title, "Motor and slide");
  EXPECT_EQ(diagram.plant.lines.front(), "mass 2\u00a0kg");
  EXPECT_EQ(diagram.drive.lines.front(), "16\u00a0bit, ±40\u00a0N");
  EXPECT_EQ(diagram.encoder.lines.front(), "1 count = 10\u00a0nm");
  EXPECT_EQ(diagram.friction->title, "Friction: coulomb");
}

// A list is one parameter after the other, each with its range over the conditions.
TEST(AxisDrawing, ShowsTheValuesOfAllConditions) {
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

TEST(AxisDrawing, AnOpenLoopHasNoController) {
  const study::Study open = axis("command: {torque: {levels: [0.1, 0]}}\n");
  EXPECT_FALSE(axis_diagram(open, 0).controller);
  for (const std::string& svg : drawings_of(open)) EXPECT_EQ(svg.find("<circle"), std::string::npos);
}

TEST(AxisDrawing, EscapesNames) {
  AxisDiagram diagram = axis_diagram(axis("command: {targets: [3], hold: 0.15}\n"), 0);
  diagram.controller->lines.emplace_back("</svg><script>");
  EXPECT_EQ(axis_svg(diagram).find("<script"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::report
