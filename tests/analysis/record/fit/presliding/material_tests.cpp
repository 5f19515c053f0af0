#include "tests/analysis/record/fit/presliding/material_tests.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::testing {

TorqueProgramme& TorqueProgramme::ramp(double to, double rate) {
  const double from = torque_.empty() ? 0.0 : torque_.back();
  const double samples = std::ceil(std::abs(to - from) / rate / sample_time_);
  for (double i = 1.0; i < samples; i += 1.0) torque_.push_back(from + (to - from) * i / samples);
  torque_.push_back(to);
  return *this;
}

TorqueProgramme& TorqueProgramme::hold(double duration) {
  torque_.insert(torque_.end(), static_cast<std::size_t>(std::lround(duration / sample_time_)),
                 torque_.empty() ? 0.0 : torque_.back());
  return *this;
}

fit::ContactParameters random_contact(std::mt19937_64& random) {
  std::uniform_real_distribution<double> half_to_double(-std::numbers::ln2, std::numbers::ln2);
  const auto factor = [&] { return std::exp(half_to_double(random)); };
  fit::ContactParameters contact;
  contact.friction.k1 *= factor();
  contact.friction.k2 *= factor();
  contact.friction.beta *= factor();
  contact.plant.presliding_damping *= factor();
  contact.plant.inertia *= factor();
  contact.friction.alpha *= factor();
  contact.friction.n = std::uniform_real_distribution<double>(1.5, 2.5)(random);
  // The hardening limit at 0.1 N m, 1e-3 rad for the paper's kind of machine, is what is spread; λ follows.
  contact.friction.lambda = std::pow(0.1, contact.friction.n) / (1e-3 * factor());
  contact.friction.breakaway = 10.0;
  return contact;
}

namespace {

/// Advances the plant from sample k to the next sample, with a torque that acts `skew` samples late (early if
/// negative).
void advance_skewed(const fit::TestRecord& record, std::size_t k, double skew, plant::Plant& plant) {
  const auto torque_of = [&](double sample) {
    if (sample < 0.0) return motion::constant_torque(0.0);
    return record.torque[std::min(static_cast<std::size_t>(sample), record.torque.size() - 1)];
  };
  const double newest = static_cast<double>(k) - std::floor(skew);
  const double before = (skew - std::floor(skew)) * record.sample_time;
  if (before > 0.0) plant.advance(torque_of(newest - 1.0), before);
  plant.advance(torque_of(newest), record.sample_time - before);
}

}  // namespace

fit::TestRecord simulated_test(const motion::PlantParameters& rotor,
                               const friction::FrictionAlongRotor& friction, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random) {
  fit::TestRecord record;
  record.name = "simulated";
  record.sample_time = programme.sample_time();
  record.unit = 2.0 * std::numbers::pi / instrument.counts_per_revolution;
  record.counted = true;
  const double phase = std::uniform_real_distribution<double>(0.0, 1.0)(random);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (double torque : programme.torque()) {
    if (instrument.torque_step > 0.0) {
      torque = instrument.torque_step * std::nearbyint(torque / instrument.torque_step);
    }
    record.torque.push_back(motion::constant_torque(torque));
  }
  plant::Plant plant(rotor, friction, {}, {1e-11 * record.unit});
  for (std::size_t k = 0; k < record.torque.size(); ++k) {
    const double shaken = instrument.noise > 0.0 ? instrument.noise * noise(random) : 0.0;
    const double twist = k > 0 ? instrument.compliance * record.torque[k - 1].now : 0.0;
    record.reading.push_back(std::floor((plant.theta() + twist) / record.unit + phase + shaken));
    advance_skewed(record, k, instrument.skew, plant);
  }
  return record;
}

fit::TestRecord simulated_test(const fit::ContactParameters& contact, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random) {
  return simulated_test(contact.plant, {contact.friction, {}}, programme, instrument, random);
}

std::vector<TorqueProgramme> three_tests() {
  TorqueProgramme ramps;
  ramps.ramp(0.15, 0.1)
      .ramp(-0.15, 0.1)
      .ramp(0.15, 0.1)
      .ramp(0.0, 0.1)
      .ramp(0.1, 0.1)
      .ramp(-0.15, 0.1)
      .ramp(0.0, 0.1);
  TorqueProgramme steps;
  for (int i = 0; i < 2; ++i) steps.step(0.08).hold(0.1).step(0.0).hold(0.1);
  TorqueProgramme holds;
  holds.ramp(0.08, 0.1).hold(4.0).ramp(0.16, 0.1).hold(4.0);
  return {ramps, steps, holds};
}

std::vector<TorqueProgramme> one_test() {
  TorqueProgramme test;
  for (int i = 0; i < 2; ++i) test.step(0.08).hold(0.1).step(0.0).hold(0.1);
  test.ramp(0.12, 0.1).hold(4.0).ramp(-0.15, 0.1).ramp(0.15, 0.1).ramp(0.05, 0.1).ramp(0.2, 0.1).hold(4.0);
  return {test};
}

std::vector<TorqueProgramme> short_test() {
  TorqueProgramme test;
  test.step(0.08)
      .hold(0.05)
      .step(0.0)
      .hold(0.05)
      .ramp(0.1, 0.4)
      .hold(0.8)
      .ramp(-0.1, 0.4)
      .ramp(0.15, 0.4)
      .hold(0.8);
  return {test};
}

double true_value(const fit::ContactParameters& contact, const std::string& name, double skew) {
  const std::map<std::string, double> values{{"k1", contact.friction.k1},
                                             {"k2", contact.friction.k2},
                                             {"k1_plus_k2", contact.friction.k1 + contact.friction.k2},
                                             {"beta", contact.friction.beta},
                                             {"presliding_damping", contact.plant.presliding_damping},
                                             {"inertia", contact.plant.inertia},
                                             {"alpha", contact.friction.alpha},
                                             {"lambda", contact.friction.lambda},
                                             {"n", contact.friction.n},
                                             {"time_offset", skew}};
  return values.at(name);
}

namespace {

void count(const fit::Identification& found, const fit::ContactParameters& truth, double skew, int set,
           CoverageStudy& study) {
  study.parameters.resize(found.parameters.size());
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    const fit::ParameterEstimate& parameter = found.parameters[i];
    IntervalCoverage& coverage = study.parameters[i];
    coverage.name = parameter.name;
    if (parameter.status == fit::EstimateStatus::not_identifiable) ++coverage.open;
    if (parameter.status != fit::EstimateStatus::estimated) continue;
    const double value = true_value(truth, parameter.name, skew);
    ++coverage.estimated;
    if (parameter.low <= value && value <= parameter.high) ++coverage.held;
    const double error = (parameter.value - value) / parameter.standard_error;
    coverage.squared_errors += error * error;
    if (std::abs(error) > coverage.farthest) {
      coverage.farthest = std::abs(error);
      coverage.farthest_set = set;
    }
    coverage.half_widths +=
        0.5 * (parameter.high - parameter.low) / (parameter.name == "time_offset" ? 1.0 : parameter.value);
  }
  if (found.checks.passed) return;
  ++study.lacking;
  study.lacking_sets.push_back(set);
}

}  // namespace

CoverageStudy study_coverage(int first, int sets, const std::vector<TorqueProgramme>& programmes,
                             const TestInstrument& instrument, const fit::IdentificationOptions& options) {
  CoverageStudy study;
  study.sets = sets;
  for (int set = first; set < first + sets; ++set) {
    std::mt19937_64 random(static_cast<std::uint64_t>(set));
    const fit::ContactParameters truth = random_contact(random);
    std::vector<fit::TestRecord> records;
    for (const TorqueProgramme& programme : programmes) {
      records.push_back(simulated_test(truth, programme, instrument, random));
    }
    try {
      count(fit::identify(records, options), truth, instrument.skew, set, study);
    } catch (const Failure&) {
      ++study.refused;
    }
  }
  return study;
}

}  // namespace zerocount::testing
