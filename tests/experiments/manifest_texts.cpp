#include "tests/experiments/manifest_texts.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/study/study.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount {

std::string minimal_manifest(const std::string& more) {
  return manifest_commanding("{targets: [5]}", more);
}

std::string manifest_commanding(const std::string& command, const std::string& more) {
  return "zerocount: 1\n"
         "name: test\n"
         "seed: 1\n"
         "trials: 10\n"
         "command: " +
         command + "\n" + more;
}

std::string full_manifest() {
  return R"(zerocount: 1                       # manifest version
name: everything
description: Every section once
seed: 20020721
trials: 1000                       # per design point
design: monte_carlo
independent_points: false
plant:
  inertia: 5.54e-4                 # kg m^2
  presliding_damping: 0.2
  sliding_damping: 1.0e-3
friction:
  k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2, marginal: lognormal}}
  k2: {uniform: [600, 900]}
  beta: {lognormal: {median: 2.0e5, cv: 0.2}}
  alpha: {log_uniform: [0.1, 2.0]}
  lambda: 10
  n: 2
  breakaway: {triangular: [0.25, 0.3, 0.35]}
  coulomb_ratio: 0.8
  stribeck_velocity: 0.01
encoder: {fine: 1620000, coarse: 86400}
dac: {bits: 12, resolution: 2.4e-4}
controller: {sample_rate: 2000, kp: 0, ki: 3.85e-5, kd: 0, delay: {choice: [0, 1]}, anti_windup: clamp}
command: {targets: [{integers: [1, 30]}, 0], hold: 1.0}
initial:
  encoder_phase: {uniform: [0, 1]}
  position: {normal: {mean: 3, sd: 1}}
  hardening: 0
  preload: {truncated_normal: {mean: 0, sd: 0.01, low: -0.02, high: 0.02}}
verdict: {dwell: 0.05, window: 0.05}
retain: {trials: [0, 7]}
observed: {a: "stable", "b, controller.kp=0.0003, plant.inertia=0.0006": unstable}
sweep:
  cases: {a: {controller.ki: 3.85e-5}, b: {controller.ki: 9.45e-5, controller.anti_windup: none}}
  grid: {controller.kp: [0, 3.0e-4], plant.inertia: {linspace: [5.0e-4, 6.0e-4, 3]}}
)";
}

std::string extended_manifest() {
  return R"(zerocount: 1
name: extended
seed: 3
trials: 100
friction: {model: spring, breakaway: {uniform: [0.3, 0.4]}}
encoder:
  fine_errors: {eccentricity: 1.0e-5, eccentricity_angle: {uniform: [0, 6.28]}, noise: 0.1}
  coarse_errors: {interpolation: 0.05, interpolation_period: 2, missed: {uniform: [0, 1.0e-6]}}
dac: {offset: {normal: {mean: 0, sd: 1.0e-4}}, gain_error: 0.01, nonlinearity: 0.5, noise: 1.0e-5}
amplifier: {bandwidth: {lognormal: {median: 500, cv: 0.1}}}
controller:
  encoder: fine
  coarse: {kp: 1.0e-4, ki: 0, kd: 1.0e-3, encoder: coarse, fine_within: {integers: [10, 40]}, coarse_beyond: 500}
command:
  sequence: {targets: [-4000, {integers: [-10, 10]}, 5000], overrun: 300, cycles: 2, approach: bidirectional}
  hold: 1.5
  profile: {shape: s_curve, velocity_limit: 0.5, acceleration_limit: 20, jerk_limit: {uniform: [1000, 2000]}}
initial:
  velocity: {choice: [-0.01, 0.01]}
  integral: {uniform: [-0.1, 0.1]}
  history: {reversals: {integers: [0, 9]}, torque: 0.2}
sweep:
  cases:
    no-history: {initial.history.reversals: 0}
    sliding: {initial.mode: slide}
  grid: {controller.coarse.kd: [0, 1.0e-3], friction.model: [presliding, spring], command.profile.shape: [step, s_curve]}
)";
}

namespace {

constexpr const char* text_name = "m.yaml";

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + separator.size(), text.size()));
  }
  return parts;
}

bool is_fault(const std::string& line, const std::string& fault) {
  const std::vector<std::string> words = split(fault, " | ");
  const bool in_manifest = fault.starts_with("«") || (fault.front() >= '0' && fault.front() <= '9');
  const std::string place = (in_manifest ? std::string(text_name) + ":" : "") + words.front() + ": ";
  return line.starts_with(place) && std::all_of(words.begin() + 1, words.end(), [&](const std::string& word) {
           return line.find(word, place.size()) != std::string::npos;
         });
}

}  // namespace

::testing::AssertionResult has_faults(const std::vector<std::string>& warnings, std::string_view faults) {
  const std::vector<std::string> expected = split(faults, "\n");
  if (std::equal(warnings.begin(), warnings.end(), expected.begin(), expected.end(), is_fault))
    return ::testing::AssertionSuccess();
  ::testing::AssertionResult failed = ::testing::AssertionFailure() << "expected\n" << faults << "\nfound";
  for (const std::string& line : warnings) failed << "\n" << line;
  return failed;
}

::testing::AssertionResult has_faults(const std::string& message, std::string_view faults) {
  return has_faults(split(message, "\n"), faults);
}

std::string refusal_of(const std::string& text, const std::vector<std::string>& overrides,
                       const sections::ExternalInputs& external) {
  const MarkedText marked = marked_text(text);
  try {
    manifest::parse_study(marked.text, text_name, overrides, external);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input) throw;
    return with_marks(failure.what(), text_name, marked);
  }
  return "";
}

study::Study study_of(const std::string& text, const std::vector<std::string>& overrides,
                      const sections::ExternalInputs& external) {
  const MarkedText marked = marked_text(text);
  study::Study study = manifest::parse_study(marked.text, text_name, overrides, external);
  for (std::string& warning : study.warnings) warning = with_marks(std::move(warning), text_name, marked);
  return study;
}

std::vector<std::string_view> unstated_premises(const study::Study& study) {
  std::vector<std::string_view> unstated;
  for (const study::Premise& premise : study.premises) {
    const bool is_usual = premise.assumption == "no encoder noise" || premise.assumption == "no delay" ||
                          premise.assumption == "ideal amplifier";
    if (is_usual && premise.state == study::PremiseState::assumed) unstated.push_back(premise.assumption);
  }
  return unstated;
}

std::size_t column_of(const study::Study& study, const std::string& name) {
  for (std::size_t i = 0; i < study.columns.inputs.size(); ++i) {
    if (study.columns.inputs[i].name == name) return i;
  }
  throw std::invalid_argument("no input column " + name);
}

}  // namespace zerocount
