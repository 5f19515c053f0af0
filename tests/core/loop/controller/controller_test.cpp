// The control in one and in two phases, against its rule evaluated over lists of all samples.
#include "core/loop/controller/controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::loop {
namespace {

constexpr double lowest = -0.49;
constexpr double highest = 0.48;

/// What comes to a control, sample by sample.
struct Recording {
  double fine_per_coarse;
  double preset;                         ///< I before the first sample
  std::vector<std::int64_t> references;  ///< counts
  std::vector<EncoderReading> readings;
  std::vector<double> torques_in_force;  ///< N m

  std::size_t samples() const { return references.size(); }
  double count(EncoderChoice encoder, std::size_t k) const {
    return encoder == EncoderChoice::fine ? static_cast<double>(readings[k].fine)
                                          : static_cast<double>(readings[k].coarse) * fine_per_coarse;
  }
  double error(EncoderChoice encoder, std::size_t k) const {
    return static_cast<double>(references[k]) - count(encoder, k);
  }
  double error_before(EncoderChoice encoder, std::size_t k) const {
    return k == 0 ? 0.0 : error(encoder, k - 1);
  }
  double moved(EncoderChoice encoder, std::size_t k) const {
    return k == 0 ? 0.0 : count(encoder, k) - count(encoder, k - 1);
  }
};

struct Decisions {
  std::vector<double> torques;
  std::vector<double> integrals;
  std::vector<ControlPhase> phases;
  std::int64_t changes{0};

  bool changed_at(std::size_t k) const { return k > 0 && phases[k] != phases[k - 1]; }
};

/// The phase of every sample, each from the lists of all samples before it.
std::vector<ControlPhase> phases_by_the_rule(const ControllerParameters& p, const Recording& r) {
  const auto dwell = static_cast<std::size_t>(std::max(1.0, std::round(p.coarse.fine_dwell * p.sample_rate)));
  const auto settled = [&](std::size_t k) {
    return std::abs(r.error(p.coarse.encoder, k)) <= p.coarse.fine_within &&
           std::abs(r.moved(p.coarse.encoder, k)) <= p.coarse.fine_rate;
  };
  std::vector<ControlPhase> phases;
  for (std::size_t k = 0; k < r.samples(); ++k) {
    if (k == 0 || phases.back() == ControlPhase::fine) {
      const bool beyond = std::abs(r.error(p.encoder, k)) > p.coarse.coarse_beyond;
      phases.push_back(beyond ? ControlPhase::coarse : ControlPhase::fine);
      continue;
    }
    bool all_settled = k + 1 >= dwell;
    for (std::size_t j = 0; all_settled && j < dwell; ++j)
      all_settled = settled(k - j) && (j == 0 || phases[k - j] == ControlPhase::coarse);
    phases.push_back(all_settled ? ControlPhase::fine : ControlPhase::coarse);
  }
  return phases;
}

/// The whole control by the rule: every torque from the whole time since the last change of the phase.
Decisions decide_by_the_rule(const ControllerParameters& p, const Recording& r) {
  Decisions all;
  const bool two_phases = std::isfinite(p.coarse.coarse_beyond);
  all.phases =
      two_phases ? phases_by_the_rule(p, r) : std::vector<ControlPhase>(r.samples(), ControlPhase::fine);
  std::size_t since = 0;
  for (std::size_t k = 0; k < r.samples(); ++k) {
    if (all.changed_at(k)) {
      since = k;
      ++all.changes;
    }
    const bool coarse = all.phases[k] == ControlPhase::coarse;
    const EncoderChoice encoder = coarse ? p.coarse.encoder : p.encoder;
    const double kp = coarse ? p.coarse.kp : p.kp;
    const double ki = coarse ? p.coarse.ki : p.ki;
    const double kd = coarse ? p.coarse.kd : (two_phases ? 0.0 : p.kd);
    double integral = since == 0 ? r.preset : r.torques_in_force[since];
    for (std::size_t j = since; j <= k; ++j) {
      integral = integral + ki * (r.error(encoder, j) + r.error_before(encoder, j));
      if (p.anti_windup == AntiWindup::clamp) integral = std::max(lowest, std::min(highest, integral));
    }
    all.integrals.push_back(integral);
    all.torques.push_back(integral + kp * r.error(encoder, k) - kd * r.moved(encoder, k));
  }
  return all;
}

Decisions decide(const ControllerParameters& p, const Recording& r) {
  Controller controller(p, {r.fine_per_coarse}, r.preset, {{lowest, highest}});
  Decisions all;
  for (std::size_t k = 0; k < r.samples(); ++k) {
    all.torques.push_back(controller.update(r.references[k], r.readings[k], r.torques_in_force[k]));
    all.integrals.push_back(controller.integral());
    all.phases.push_back(controller.phase());
  }
  all.changes = controller.phase_changes();
  return all;
}

class Sampler {
 public:
  explicit Sampler(unsigned seed) : random_(seed) {}
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double log_uniform(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  std::int64_t integer(std::int64_t a, std::int64_t b) {
    return std::uniform_int_distribution<std::int64_t>(a, b)(random_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

 private:
  std::mt19937_64 random_;
};

/// A rotor that rests and wanders by turns, near the target and far from it, and a target that jumps.
Recording random_recording(Sampler& draw, std::size_t samples) {
  Recording r;
  r.fine_per_coarse = draw.chance(0.5) ? 18.75 : draw.uniform(1.0, 40.0);
  r.preset = draw.chance(0.5) ? 0.0 : draw.uniform(lowest, highest);
  double position = draw.uniform(-200.0, 200.0);
  double velocity = 0.0;
  std::int64_t reference = draw.integer(-30, 30);
  for (std::size_t k = 0; k < samples; ++k) {
    if (draw.chance(0.05)) velocity = draw.uniform(-20.0, 20.0);
    if (draw.chance(0.15)) velocity = draw.uniform(-0.5, 0.5);
    if (draw.chance(0.05)) position = static_cast<double>(reference) + draw.uniform(-20.0, 20.0);
    if (draw.chance(0.02)) reference = draw.integer(-100, 100);
    position += velocity;
    r.references.push_back(reference);
    r.readings.push_back({static_cast<std::int64_t>(std::floor(position)),
                          static_cast<std::int64_t>(std::floor(position / r.fine_per_coarse))});
    r.torques_in_force.push_back(k == 0 ? 0.0 : draw.uniform(lowest, highest));
  }
  return r;
}

ControllerParameters random_control(Sampler& draw) {
  ControllerParameters p;
  p.sample_rate = draw.log_uniform(100.0, 1e4);
  p.kp = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-5, 1e-2);
  p.ki = draw.chance(0.1) ? 0.0 : draw.log_uniform(1e-6, 1e-3);
  p.kd = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-5, 1e-2);
  p.anti_windup = draw.chance(0.5) ? AntiWindup::clamp : AntiWindup::none;
  p.encoder = draw.chance(0.5) ? EncoderChoice::fine : EncoderChoice::coarse;
  return p;
}

CoarsePhaseParameters random_coarse_phase(Sampler& draw, double sample_rate) {
  CoarsePhaseParameters c;
  c.kp = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-5, 1e-2);
  c.ki = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-6, 1e-3);
  c.kd = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-5, 1e-2);
  c.encoder = draw.chance(0.5) ? EncoderChoice::fine : EncoderChoice::coarse;
  // Whole limits are met exactly by the counts of a fine encoder.
  const bool whole = draw.chance(0.5);
  const auto limit = [&](double low, double high) {
    return whole ? std::round(draw.uniform(low, high)) : draw.uniform(low, high);
  };
  c.fine_within = limit(5.0, 40.0);
  c.fine_rate = draw.chance(0.3) ? 0.0 : limit(1.0, 20.0);
  c.fine_dwell = draw.chance(0.2) ? 0.0 : draw.uniform(0.5, 8.0) / sample_rate;
  c.coarse_beyond = c.fine_within + limit(0.0, 120.0);
  return c;
}

TEST(Controller, InOnePhaseEveryTorqueIsThatOfTheLawBitForBit) {
  Sampler draw(1);
  for (int i = 0; i < 200; ++i) {
    const ControllerParameters p = random_control(draw);
    const Recording r = random_recording(draw, 200);
    const Decisions decided = decide(p, r);
    const Decisions expected = decide_by_the_rule(p, r);
    ASSERT_EQ(decided.torques, expected.torques);
    ASSERT_EQ(decided.integrals, expected.integrals);
    ASSERT_EQ(decided.phases, expected.phases);
    ASSERT_EQ(decided.changes, 0);
  }
}

TEST(Controller, InTwoPhasesEveryTorqueAndPhaseIsThatOfTheRuleBitForBit) {
  Sampler draw(2);
  std::int64_t changes = 0;
  std::int64_t begun_coarse = 0;
  for (int i = 0; i < 1000; ++i) {
    ControllerParameters p = random_control(draw);
    p.coarse = random_coarse_phase(draw, p.sample_rate);
    const Recording r = random_recording(draw, 300);
    const Decisions decided = decide(p, r);
    const Decisions expected = decide_by_the_rule(p, r);
    ASSERT_EQ(decided.phases, expected.phases) << "control " << i;
    ASSERT_EQ(decided.torques, expected.torques) << "control " << i;
    ASSERT_EQ(decided.integrals, expected.integrals) << "control " << i;
    ASSERT_EQ(decided.changes, expected.changes) << "control " << i;
    changes += decided.changes;
    begun_coarse += decided.phases.front() == ControlPhase::coarse ? 1 : 0;
  }
  EXPECT_GT(changes, 5000);      // the recordings do exercise the rule
  EXPECT_GT(begun_coarse, 200);  // of 1000
  EXPECT_LT(begun_coarse, 950);
}

TEST(Controller, StaysInTheCoarsePhaseWithADwellLongerThanAnyTrial) {
  for (const double time : {1e15, 1e17, 1e300}) {
    ControllerParameters p;
    p.coarse.coarse_beyond = 50.0;
    p.coarse.fine_dwell = time;
    Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
    controller.update(0, {60, 3}, 0.0);
    for (int k = 0; k < 100; ++k) {
      controller.update(0, {0, 0}, 0.0);
      ASSERT_EQ(controller.phase(), ControlPhase::coarse);
    }
  }
}

}  // namespace
}  // namespace zerocount::loop
