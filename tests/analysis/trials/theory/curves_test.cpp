// The curve of a Bode plot is the open loop, thinned.
#include "analysis/trials/theory/curves.hpp"

#include <nlohmann/json.hpp>

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/linear_loop.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

constexpr double pi = std::numbers::pi;

PointTheory examine(const study::Study& study, std::int64_t point) {
  std::vector<KnownRotor> none;
  return examine(study, point, 0, none);
}

/// The parameters of a control loop whose Bode curve is tested.
struct LoopParts {
  double stiffness{0.0};
  double damping{0.0};
  motion::PlantParameters plant;
  loop::ControllerParameters controller;
  LinearDrive drive;

  FrozenLoop frozen() const { return frozen_loop({stiffness, damping}, plant, {}, controller, drive); }
  /// The open-loop frequency response L at a frequency (Hz), by its formula.
  std::complex<double> response(double frequency) const {
    const double T = 1.0 / controller.sample_rate;
    const double resolution = loop::fine_resolution({});
    return OpenLoop(hold_plant({stiffness, damping}, plant, resolution, T, drive, controller.delay),
                    loop::linear_chain(controller, {}))
        .at_angle(2.0 * pi * frequency * T);
  }
};

class RandomParts {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

  LoopParts parts() {
    LoopParts parts;
    parts.stiffness = uniform(0.0, 1.0) < 0.3 ? 0.0 : log_uniform(50.0, 1000.0);
    parts.damping = parts.stiffness == 0.0 ? log_uniform(1e-4, 1e-2) : log_uniform(0.02, 0.5);
    parts.plant.inertia = log_uniform(1e-4, 1e-2);
    if (uniform(0.0, 1.0) < 0.6) {
      parts.plant.load = {.inertia = log_uniform(1e-5, 1e-2),
                          .stiffness = log_uniform(300.0, 2e4),
                          .damping = log_uniform(1e-4, 0.1)};
    }
    parts.controller.kp = log_uniform(1e-5, 1e-3);
    parts.controller.ki = log_uniform(1e-6, 1e-4);
    parts.controller.kd = log_uniform(1e-4, 5e-3);
    parts.controller.delay = uniform(0.0, 1.0) < 0.5 ? std::floor(uniform(0.0, 2.99)) : uniform(0.0, 2.99);
    if (uniform(0.0, 1.0) < 0.5) parts.drive.bandwidth = 500.0;
    return parts;
  }

 private:
  std::mt19937_64 random_{20};
};

double decibels(std::complex<double> value) {
  return 20.0 * std::log10(std::abs(value));
}

/// The smallest angle between two phases, degrees.
double between(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

double degrees(std::complex<double> value) {
  return std::arg(value) * 180.0 / pi;
}

/// The curve equals the open loop at its points and on the straight lines that the figure draws between them.
TEST(BodeCurve, EqualsTheOpenLoopAtEveryFrequency) {
  RandomParts random;
  for (int i = 0; i < 60; ++i) {
    const LoopParts parts = random.parts();
    const double lowest = random.log_uniform(0.1, 10.0);
    const std::vector<BodePoint> curve = bode_curve(parts.frozen(), lowest);
    ASSERT_GT(curve.size(), 5U);
    EXPECT_LE(curve.size(), max_bode_points);
    EXPECT_NEAR(curve.front().frequency, lowest, 1e-9 * lowest);
    EXPECT_NEAR(curve.back().frequency, 0.5 * parts.controller.sample_rate, 1e-5);
    for (const BodePoint& point : curve) {
      const std::complex<double> value = parts.response(point.frequency);
      EXPECT_NEAR(point.magnitude, decibels(value), 1e-6);
      EXPECT_LT(between(point.phase, degrees(value)), 1e-5);
    }
    for (int k = 0; k < 200; ++k) {
      const double frequency = random.log_uniform(lowest, 0.49 * parts.controller.sample_rate);
      const auto after = std::find_if(curve.begin(), curve.end(),
                                      [&](const BodePoint& point) { return point.frequency > frequency; });
      const BodePoint& a = *std::prev(after);
      const BodePoint& b = *after;
      const double part = std::log(frequency / a.frequency) / std::log(b.frequency / a.frequency);
      const std::complex<double> value = parts.response(frequency);
      EXPECT_NEAR(a.magnitude + part * (b.magnitude - a.magnitude), decibels(value), 0.5) << frequency;
      EXPECT_LT(between(a.phase + part * (b.phase - a.phase), degrees(value)), 2.0) << frequency;
    }
  }
}

// J·θ¨ + cs·θ˙ = u under kp and ki: −180° of the integrals below the corner of cs/J, −270° above it, −180°
// again above the corner of ki and kp. About a spring: −90°, then 180° less past its natural frequency.
TEST(BodeCurve, HasTheTextbookPhase) {
  LoopParts sliding;
  sliding.damping = 1.0;
  sliding.plant.inertia = 1e-2;
  sliding.controller.ki = 1e-7;
  EXPECT_NEAR(bode_curve(sliding.frozen(), 1e-2).front().phase, -180.0, 1.0);
  sliding.damping = 1e-5;
  EXPECT_NEAR(bode_curve(sliding.frozen(), 0.1).front().phase, -270.0, 1.0);
  LoopParts spring;
  spring.stiffness = 110.0;
  spring.damping = 1e-4;
  spring.controller.kp = 0.0;
  const std::vector<BodePoint> curve = bode_curve(spring.frozen(), 0.1);
  EXPECT_NEAR(curve.front().phase, -90.0, 0.1);
  const auto past =
      std::find_if(curve.begin(), curve.end(), [](const BodePoint& p) { return p.frequency > 90.0; });
  EXPECT_NEAR(past->phase, -270.0 - 180.0 * past->frequency / 2000.0, 1.0);  // and the lag of the hold
}

// The resonance of two free masses is √(kL·(1/J + 1/JL)), the antiresonance √(kL/JL).
TEST(BodeCurve, DoesNotMissTheResonanceOfALoad) {
  RandomParts random;
  for (int i = 0; i < 50; ++i) {
    LoopParts parts;
    parts.damping = 1e-3;
    parts.plant.inertia = random.log_uniform(3e-4, 3e-3);
    const double load = parts.plant.inertia * random.log_uniform(0.05, 5.0);
    const double antiresonance = random.log_uniform(50.0, 200.0);
    const double stiffness = load * std::pow(2.0 * pi * antiresonance, 2);
    parts.plant.load = {.inertia = load, .stiffness = stiffness, .damping = random.log_uniform(1e-6, 1e-4)};
    parts.controller.kp = 3e-4;
    const double resonance = antiresonance * std::sqrt(1.0 + load / parts.plant.inertia);
    if (resonance > 800.0) continue;
    const std::vector<BodePoint> curve = bode_curve(parts.frozen(), 5.0);
    const auto by_magnitude = [](const BodePoint& a, const BodePoint& b) {
      return a.magnitude < b.magnitude;
    };
    const auto above = std::find_if(curve.begin(), curve.end(), [&](const BodePoint& p) {
      return p.frequency > std::sqrt(antiresonance * resonance);
    });
    const auto peak = std::max_element(above, curve.end(), by_magnitude);
    EXPECT_NEAR(peak->frequency, resonance, 1e-3 * resonance);
    double highest = -1e9;
    for (int k = -4000; k <= 4000; ++k)
      highest = std::max(highest, decibels(parts.response(resonance * (1.0 + 1e-3 * k / 4000.0))));
    EXPECT_NEAR(peak->magnitude, highest, 0.5);
    const auto low = std::min_element(curve.begin(), above, by_magnitude);
    EXPECT_NEAR(low->frequency, antiresonance, 2e-3 * antiresonance);
  }
}

TEST(BodeCurve, WithoutDampingHasThePhaseOfSmallDamping) {
  LoopParts parts;
  parts.plant.load = {.inertia = 5e-4, .stiffness = 2000.0, .damping = 1e-7};
  parts.controller.kp = 3e-4;
  const std::vector<double> kept{100.0, 400.0, 700.0};
  const std::vector<BodePoint> damped = bode_curve(parts.frozen(), 1.0, kept);
  parts.plant.load.damping = 0.0;
  const std::vector<BodePoint> undamped = bode_curve(parts.frozen(), 1.0, kept);
  const auto phase_at = [](const std::vector<BodePoint>& curve, double frequency) {
    const auto found = std::find_if(curve.begin(), curve.end(), [&](const BodePoint& point) {
      return std::abs(point.frequency - frequency) < 1e-9 * frequency;
    });
    EXPECT_NE(found, curve.end()) << frequency;
    return found == curve.end() ? std::nan("") : found->phase;
  };
  for (const double frequency : kept)
    EXPECT_NEAR(phase_at(undamped, frequency), phase_at(damped, frequency), 0.1) << frequency;
  EXPECT_NEAR(phase_at(undamped, 400.0) - phase_at(undamped, 100.0), 180.0, 60.0);
}

TEST(BodeCurve, IsEmptyWithoutGain) {
  LoopParts parts;
  parts.controller.ki = 0.0;
  EXPECT_TRUE(bode_curve(parts.frozen(), 1.0).empty());
}

const std::string head =
    "zerocount: 1\nname: curves\nseed: 3\ntrials: 40\n"
    "command: {targets: [5], hold: 0.1}\n";

/// The stability bound of criteria (6) and (7), written out for the paper's machine: k_ID = c·(k +
/// kp/Δx)/J·Δx·T/2.
double bound(double stiffness, double kp, double inertia = 5.54e-4) {
  const double dx = 2.0 * std::numbers::pi / 1620000.0;
  return 0.2 * (stiffness + kp / dx) / inertia * dx / 2000.0 / 2.0;
}

const CriterionCurve& curve(const std::vector<CriterionCurve>& curves, const std::string& criterion,
                            bool first) {
  for (const CriterionCurve& one : curves) {
    if (one.criterion == criterion && one.first == first) return one;
  }
  ADD_FAILURE() << criterion << " is missing";
  return curves.front();
}

TEST(CriterionCurves, AreTheBoundsOfThePaperForTheSoftestAndStiffestTrial) {
  const study::Study study = manifest::parse_study(
      head + "friction: {k1: {choice: [90, 100, 130]}, k2: {choice: [700, 800]}}\n", "test");
  const CriterionPlane plane{{"controller.ki", 1e-5, 6e-4, true}, {"controller.kp", 0.0, 8e-4}};
  const std::vector<CriterionCurve> curves = criterion_curves(study, 0, plane);
  ASSERT_EQ(curves.size(), 4U);
  for (const auto& [criterion, first, stiffness] :
       {std::tuple{"(6)", true, 90.0}, {"(6)", false, 130.0}, {"(7)", true, 790.0}, {"(7)", false, 930.0}}) {
    const CriterionCurve& found = curve(curves, criterion, first);
    EXPECT_GT(found.points.size(), 30U);
    for (const CurvePoint& point : found.points)
      EXPECT_NEAR(point.x, bound(stiffness, point.y), 1e-9 * point.x + 1e-15) << criterion << first;
  }
}

TEST(CriterionCurves, AreFoundInAPlaneWithoutTheGainToo) {
  const study::Study study = manifest::parse_study(head, "test");
  const CriterionPlane plane{{"plant.inertia", 2e-4, 2e-3}, {"friction.k1", 50.0, 200.0}};
  const std::vector<CriterionCurve> curves = criterion_curves(study, 0, plane);
  for (const CurvePoint& point : curve(curves, "(6)", true).points)
    EXPECT_NEAR(bound(point.y, 0.0, point.x), 3.85e-5, 1e-10);
}

TEST(CriterionCurves, AreEmptyIfTheCriteriaDoNotApply) {
  const CriterionPlane plane{{"controller.ki", 1e-5, 6e-4, true}, {"controller.kp", 0.0, 8e-4}};
  const study::Study coulomb = manifest::parse_study(head + "friction: {model: coulomb}\n", "test");
  EXPECT_TRUE(criterion_curves(coulomb, 0, plane).empty());
  CriterionPlane strange = plane;
  strange.y.parameter = "command.targets.0";
  EXPECT_TRUE(criterion_curves(manifest::parse_study(head, "test"), 0, strange).empty());
}

// The theory of design points in the answer of `check`.

document::Answer theory_with(const std::string& friction) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\ntrials: 1\nplant: {inertia: 2.0e-3, sliding_damping: 2.0e-3}\n"
      "dac: {bits: 24, resolution: 1.0e-6}\nencoder: {fine: 2000000}\n"
      "controller: {units: si, sample_rate: 2000, kp: 2, ki: 4, kd: 0.1}\n"
      "command: {targets: [100000], hold: 50}\nfriction: {" +
          friction + "}\n",
      "m.yaml", {});
  const document::AnswerDescription<PointTheory> answer{{.name = "theory", .meaning = "theory of a point"},
                                                        point_theory_description()};
  return answer.of(examine(study, 0));
}

TEST(PointTheoryDescription, HasTheNumbersOfEachStatement) {
  const document::Answer answer = theory_with("k1: 110");
  const auto theory = document::json(answer);
  EXPECT_TRUE(theory["outside"].is_null());
  EXPECT_LT(theory["stable_below"]["low"], theory["unstable_above"]["low"]);
  EXPECT_EQ(theory["lowest_k1"], 110.0);
  EXPECT_EQ(theory["loops"].size(), 3U);
  const std::string text = document::text(answer);
  for (const char* key : {"stable_below", "sampled_below", "unstable_above", "gain", "dac_bound"}) {
    const std::string number = fmt::format("{:.3g}", theory[key]["low"].get<double>());
    EXPECT_TRUE(says(text, number)) << key << ": " << number << "\n" << text;
  }
}

study::Study machine_with_gap(const std::string& load, const std::string& cascade) {
  return manifest::parse_study(
      fmt::format(
          "zerocount: 1\nname: gap\nseed: 1\ntrials: 1\nplant: {{inertia: 2.0e-5, presliding_damping: "
          "1.0e-4, load: {{inertia: 2.0e-4, stiffness: 4000, damping: 0.05, gap: 1.0e-3, {}}}}}\n"
          "friction: {{model: none}}\nencoder: {{fine: 1000000}}\ncommand: {{targets: [100], hold: 1}}\n"
          "controller: {{sample_rate: 8000, delay: 1, derivative_cutoff: 300, {}}}\n",
          load, cascade),
      "m.yaml", {});
}

// The bound of the integral gain and the loops are of all states of the load: what is stable in contact is
// not said to be stable where the motor alone is not.
TEST(PointTheory, IncludesTheMotorAloneInsideTheGap) {
  const std::string cascade = "structure: cascade, cascade: {kv: 40, kp: 0.12, ki: 1}";
  const PointTheory theory = examine(machine_with_gap("encoder: motor", cascade), 0);
  ASSERT_EQ(theory.loops.size(), 2U);
  EXPECT_EQ(theory.loops[0].stability, std::set{LoopStability::stable});
  EXPECT_EQ(theory.loops[1].name, "without friction, the motor alone in the gap");
  EXPECT_EQ(theory.loops[1].stability, std::set{LoopStability::unstable});
  EXPECT_LT(theory.loops[1].gain.low, 0.0);
  EXPECT_EQ(theory.gain.sampled_stable, std::set{false});
  EXPECT_TRUE(theory.cut.empty());
  const PointTheory cut = examine(machine_with_gap("encoder: load", cascade), 0);
  EXPECT_EQ(cut.loops.size(), 1U);
  EXPECT_EQ(cut.cut, std::vector<std::string>{"the motor alone in the gap"});
}

// About a spring an underdamped loop rings for long in the linear theory, and its moves arrive: hysteresis
// ends the ringing. Without friction nothing does.
TEST(PointTheory, WarnsOfSlowRingingOnlyIfNoHysteresisEndsIt) {
  const auto approach_of = [](const std::string& friction) {
    const study::Study study =
        manifest::parse_study("zerocount: 1\nname: ring\nseed: 1\ntrials: 1\nfriction: {" + friction +
                                  "}\nplant: {presliding_damping: 2.0e-3}\ncontroller: {kp: 1.0e-5, ki: 0}\n"
                                  "command: {targets: [3], hold: 0.3}\n",
                              "m.yaml", {});
    return examine(study, 0).approach;
  };
  const Approach on_spring = approach_of("k1: 110, alpha: 0");
  EXPECT_GT(on_spring.time_constant.high, 0.3);
  EXPECT_FALSE(on_spring.exceeds_hold());
  const Approach free = approach_of("model: none");
  EXPECT_GT(free.time_constant.high, 0.3);
  EXPECT_TRUE(free.exceeds_hold());
}

// A double integrator under integral action alone: each gain makes it grow. There is no margin, and the
// reason is told.
TEST(PointTheory, ReportsALoopThatNoGainStabilises) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: free\nseed: 1\ntrials: 1\nfriction: {model: none}\nplant: {presliding_damping: "
      "1.0e-3}\n"
      "controller: {kp: 0, ki: 1.0e-5}\ncommand: {targets: [100], hold: 1}\n",
      "m.yaml", {});
  const PointTheory theory = examine(study, 0);
  ASSERT_EQ(theory.loops.size(), 1U);
  EXPECT_TRUE(theory.loops[0].gain.empty());
  const document::AnswerDescription<LoopRanges> answer{{.name = "loop", .meaning = "a loop"},
                                                       loop_description()};
  const document::Answer told = answer.of(theory.loops[0]);
  EXPECT_TRUE(says(document::text(told), "none: no gain stabilises it")) << document::text(told);
  EXPECT_TRUE(document::json(told)["no_gain_stabilises"]);
  EXPECT_TRUE(document::json(told)["gain_margin"]["low"].is_null());
}

// A rotor that stays the same from point to point is searched once.
TEST(PointTheory, ReusingTheRotorsOfThePreviousPointChangesNothing) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\nmachines: 5\ntrials: 5\ncommand: {targets: [1], hold: 1}\nsweep:\n "
      " "
      "cases:\n"
      "    a: {friction.k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.3}}}\n"
      "    b: {friction.k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.3}}, controller.ki: "
      "2.0e-5}\n"
      "    c: {friction.k1: {profile: {mean: 90, cv: 0.2, correlation_length: 0.3}}}\n",
      "m.yaml", {});
  std::vector<KnownRotor> known;
  std::set<double> lowest;
  for (const std::int64_t point : {0, 1, 2, 0}) {
    const PointTheory theory = examine(study, point, 0, known);
    EXPECT_EQ(theory.lowest.k1.low, examine(study, point).lowest.k1.low) << point;
    EXPECT_EQ(theory.lowest.k1.high, examine(study, point).lowest.k1.high) << point;
    lowest.insert(theory.lowest.k1.low);
  }
  EXPECT_EQ(lowest.size(), 2U);
}

}  // namespace
}  // namespace zerocount::theory
