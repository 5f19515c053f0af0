#include "experiments/guides/guide_manifest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/parameters/handles.hpp"

namespace zerocount::guides {
namespace {

using parameters::AxisKind;

constexpr double acceleration = 1.0;  // m/s², which the converter's range allows beside friction
constexpr int frictionless_bits = 20;

/// Extreme values of the friction ranges, for which the control loop is designed: the lowest k1 and damping,
/// and the highest breakaway force. 0 if the guide does not have the parameter.
struct Lowest {
  double k1{0.0};
  double damping{0.0};
  double highest_breakaway{0.0};
};

Lowest lowest_of(const std::vector<GuideNumber>& parameters) {
  Lowest lowest;
  for (const GuideNumber& number : parameters) {
    if (number.quantity == parameter::friction::k1 ||
        number.quantity == parameter::friction::measured::final_stiffness)
      lowest.k1 = number.low;
    if (number.quantity == parameter::plant::presliding_damping) lowest.damping = number.low;
    if (number.quantity == parameter::friction::breakaway ||
        number.quantity == parameter::friction::measured::breakaway)
      lowest.highest_breakaway = number.high;
  }
  return lowest;
}

std::string written(double number) {
  return fmt::format("{:.4g}", number);
}

/// Text of a distribution over the range of a number: log-uniform if the ends differ by a factor of more than
/// 2, otherwise uniform; a plain number if both ends are equal.
std::string distribution(const GuideNumber& number) {
  if (number.origin == Origin::measured) return fmt::format("{}", number.low);
  if (number.low == number.high) return written(number.low);
  const char* const form = number.high > 2.0 * number.low ? "log_uniform" : "uniform";
  return fmt::format("{{{}: [{}, {}]}}", form, written(number.low), written(number.high));
}

/// The parameters of a section as lines of a manifest, each below a comment with its origin. Parameters of
/// nested sections are left out.
std::string section(const std::vector<GuideNumber>& parameters, std::string_view prefix, AxisKind axis,
                    std::string_view indent = "  ") {
  std::string text;
  for (const GuideNumber& number : parameters) {
    if (!number.quantity.starts_with(prefix)) continue;
    const std::string_view key = number.quantity.substr(prefix.size());
    if (key.find('.') != std::string_view::npos) continue;
    text += fmt::format("{0}# {1}: {2}\n{0}{3}: {4}   # {5}\n", indent,
                        origin_labels[static_cast<std::size_t>(number.origin)], number.source, key,
                        distribution(number), parameters::unit_on(axis, number.unit));
  }
  return text;
}

std::string friction_text(const std::vector<GuideNumber>& parameters, AxisKind axis) {
  const std::string measured = section(parameters, "friction.measured.", axis, "    ");
  return section(parameters, "friction.", axis) + (measured.empty() ? "" : "  measured:\n" + measured);
}

std::string controller(double mass, const Lowest& lowest, int sample_rate) {
  const double w = 2.0 * std::numbers::pi * sample_rate / 100.0;
  const double kp = mass * w * w;
  const double kd = 1.4 * mass * w;
  const double ki = (lowest.damping + kd) * (lowest.k1 + kp) / (4.0 * mass);
  return fmt::format(
      "controller:\n"
      "  units: si\n"
      "  sample_rate: {}   # Hz\n"
      "  # assumed: one sample from the reading to the torque; 0 states that there is none\n"
      "  delay: 1   # samples\n"
      "  # A start, not a tuning: see zerocount tune.\n"
      "  # kp: m·w^2 with w = 2·pi·sample_rate/100; kd: 1.4·m·w; ki: a quarter of criterion (6) with the "
      "lowest k1\n"
      "  kp: {}\n"
      "  ki: {}\n"
      "  kd: {}\n",
      sample_rate, written(kp), written(ki), written(kd));
}

std::string converter(const GuideAxis& axis, const Lowest& lowest) {
  const double range = 2.0 * lowest.highest_breakaway + axis.load.mass * acceleration;
  const double code = 0.5 * lowest.k1 * axis.resolution;
  const int bits = code > 0.0 ? std::clamp(2 + std::ilogb(range / code), 12, 24) : frictionless_bits;
  return fmt::format("dac: {{bits: {}, range: {}}}   # N\n", bits, written(range));
}

/// The sections `encoder` and `amplifier`. They have encoder noise and lag, because every axis has them and
/// zero counts depend on them.
std::string encoder_and_amplifier(const std::string& resolution) {
  return fmt::format(
      "encoder:\n"
      "{}"
      "  # assumed: at the middle of a count the reading seldom leaves it; 0 states that there is no noise\n"
      "  fine_errors: {{noise: 0.1}}   # counts rms\n"
      "amplifier:\n"
      "  # assumed: the current loop of a servo drive; 0 states that there is no lag\n"
      "  bandwidth: 1000   # Hz\n",
      resolution);
}

std::string hardware(const Guide& guide, const GuideAxis& axis, const Lowest& lowest) {
  switch (guide.axis) {
    case AxisKind::rotary:
      return "# resolution of encoder and converter: the defaults, which are those of the paper's machine\n" +
             encoder_and_amplifier("") + controller(axis.load.mass, lowest, 2000);
    case AxisKind::linear:
      break;
  }
  return encoder_and_amplifier(fmt::format("  resolution: {}   # m per count\n", written(axis.resolution))) +
         converter(axis, lowest) + controller(axis.load.mass, lowest, 10000);
}

std::string load_text(const Guide& guide, const GuideAxis& axis) {
  if (!has_load(guide)) return "";
  if (axis.spring) return fmt::format("# For a mass of {} kg.\n", written(axis.load.mass));
  return fmt::format("# For a preload of {} N and a mass of {} kg.\n", written(axis.load.preload),
                     written(axis.load.mass));
}

}  // namespace

std::string guide_manifest(const Guide& guide, const GuideAxis& axis) {
  const std::vector<GuideNumber> parameters = guide_parameters(guide, axis.load, axis.spring);
  return fmt::format(
      "# A starting point: {}. {} measured on your axis.\n"
      "# Replace {} by what zerocount identify finds in your records, and the loop by yours.\n"
      "{}"
      "# Each of the machines draws its friction once from these ranges. Sources: zerocount parameters "
      "--guides\n"
      "zerocount: 1\n"
      "name: {}\n"
      "description: {}, {}\n"
      "axis: {}\n"
      "seed: 1\n"
      "machines: 50\n"
      "trials: 200\n"
      "plant:\n"
      "  inertia: {}   # {}\n"
      "{}"
      "friction:\n"
      "  model: {}\n"
      "{}"
      "{}"
      "command: {{targets: [{{integers: [1, 30]}}, 0], hold: 0.5}}   # counts; s per move\n"
      "initial: {{encoder_phase: {{uniform: [0, 1]}}}}\n",
      guide.description, axis.spring ? "Only its spring and breakaway were" : "Nothing here was",
      axis.spring ? "the rest of the friction" : "the friction", load_text(guide, axis), guide.name,
      axis.spring ? "An axis with a measured spring" : "An unmeasured axis", guide.description,
      parameters::axis_labels[static_cast<std::size_t>(guide.axis)], written(axis.load.mass),
      parameters::unit_on(guide.axis, "kg m^2"), section(parameters, "plant.", guide.axis), guide.model,
      friction_text(parameters, guide.axis), hardware(guide, axis, lowest_of(parameters)));
}

}  // namespace zerocount::guides
