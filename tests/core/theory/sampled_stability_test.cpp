#include <deque>

#include "core/theory/gains.hpp"
#include "core/theory/stability.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

const motion::PlantParameters machine;
const loop::EncoderParameters paper_encoder;

/// The sampled loop run sample by sample in physical units, the rotor between samples by the closed form of
/// the damped oscillator (complex exponents): an implementation apart from the one under test.
class LinearLoop {
 public:
  LinearLoop(double stiffness, const motion::PlantParameters& plant,
             const loop::ControllerParameters& controller, const LinearDrive& drive)
      : stiffness_(stiffness),
        plant_(plant),
        controller_(controller),
        drive_(drive),
        pending_(static_cast<std::size_t>(std::floor(controller.delay)) + 1, 0.0) {
    const std::complex<double> half = plant.presliding_damping / (2.0 * plant.inertia);
    const std::complex<double> root = std::sqrt(half * half - stiffness / plant.inertia);
    fast_ = -half - root;
    slow_ = -half + root;
  }

  void step() {
    const double count = angle_ / loop::fine_resolution(paper_encoder);
    if (k_ == 0) last_count_ = count;
    const double error = -count;
    integral_ += controller_.ki * (error + last_error_);
    pending_.push_back(integral_ + controller_.kp * error - controller_.kd * (count - last_count_));
    last_error_ = error;
    last_count_ = count;
    const double before = controller_.delay - std::floor(controller_.delay);
    hold(drive_.gain * pending_[0], before);
    hold(drive_.gain * pending_[1], 1.0 - before);
    pending_.pop_front();
    ++k_;
  }

  double size() const { return std::abs(angle_) + std::abs(velocity_) / 1000.0; }

 private:
  /// Advances the rotor by `samples` samples under a held input. The motor's torque is v + lag·exp(−rt), lag
  /// = 0 without an amplifier; the rotor's particular solution is v/k + follow·exp(−rt).
  void hold(double input, double samples) {
    const double T = samples / controller_.sample_rate;
    const double rate = 2.0 * std::numbers::pi * drive_.bandwidth;
    const double lag = drive_.bandwidth > 0.0 ? torque_ - input : 0.0;
    const double follow =
        lag / (plant_.inertia * rate * rate - plant_.presliding_damping * rate + stiffness_);
    const double rest = input / stiffness_;
    const double left = std::exp(-rate * T);
    const std::complex<double> x = angle_ - rest - follow;
    const std::complex<double> a = (velocity_ + rate * follow - slow_ * x) / (fast_ - slow_);
    const std::complex<double> b = x - a;
    angle_ = rest + follow * left + (a * std::exp(fast_ * T) + b * std::exp(slow_ * T)).real();
    velocity_ =
        -rate * follow * left + (a * fast_ * std::exp(fast_ * T) + b * slow_ * std::exp(slow_ * T)).real();
    torque_ = input + lag * left;
  }

  double stiffness_;
  motion::PlantParameters plant_;
  loop::ControllerParameters controller_;
  LinearDrive drive_;
  double torque_{0.0};  // of the motor
  std::deque<double> pending_;
  std::complex<double> fast_, slow_;
  double angle_{1e-5}, velocity_{0.0}, integral_{0.0}, last_error_{0.0}, last_count_{0.0};
  int k_{0};
};

/// Growth factor per sample of the linear loop's largest motion, measured over late windows of a simulation.
double simulated_growth(double stiffness, const motion::PlantParameters& plant,
                        const loop::ControllerParameters& controller, const LinearDrive& drive = {}) {
  LinearLoop loop(stiffness, plant, controller, drive);
  const auto largest_of_next = [&loop](int samples) {
    double largest = 0.0;
    for (int k = 0; k < samples; ++k) {
      loop.step();
      largest = std::max(largest, loop.size());
    }
    return largest;
  };
  constexpr int window = 2000;
  largest_of_next(window);  // the transient of the other eigenvalues
  const double early = largest_of_next(window);
  largest_of_next(4 * window);
  const double late = largest_of_next(window);
  return std::pow(late / early, 1.0 / (5 * window));
}

TEST(SampledStability, BoundOfTheMachineOfThePaperIsBelowTheContinuousOne) {
  const loop::ControllerParameters controller;
  const double sampled = sampled_critical_integral_gain(110.0, machine, paper_encoder, controller);
  EXPECT_NEAR(sampled, 3.57e-5, 0.5e-7);
  EXPECT_LT(sampled, critical_integral_gain(110.0, machine, paper_encoder, controller));
}

TEST(SampledStability, ApproachesTheContinuousBoundAtHighSampleRates) {
  loop::ControllerParameters controller;
  controller.kp = 3e-4;
  double last_gap = 1.0;
  for (const double rate : {4e3, 16e3, 64e3, 256e3}) {
    controller.sample_rate = rate;
    const double continuous = critical_integral_gain(110.0, machine, paper_encoder, controller);
    const double gap =
        1.0 - sampled_critical_integral_gain(110.0, machine, paper_encoder, controller) / continuous;
    EXPECT_GT(gap, 0.0);
    EXPECT_LT(gap, 0.3 * last_gap);  // the hold's delay of half a sample: an error of first order in T
    last_gap = gap;
  }
  EXPECT_LT(last_gap, 2e-3);
}

TEST(SampledStability, LinearLoopDecaysBelowTheBoundAndGrowsAboveIt) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> factor(0.5, 2.0), part(0.0, 1.0);
  int judged = 0;
  for (int i = 0; i < 40; ++i) {
    const double stiffness = 250.0 * factor(random);
    motion::PlantParameters plant = machine;
    plant.inertia *= factor(random);
    plant.presliding_damping *= factor(random);
    loop::ControllerParameters controller;
    controller.kp = 0.5 * part(random) * stiffness * loop::fine_resolution(paper_encoder);
    controller.kd = 2e-4 * part(random);
    controller.delay = static_cast<double>(random() % 13) / 4.0;
    LinearDrive drive{0.7 + 0.6 * part(random), 0.0};
    if (random() % 2 == 0) drive.bandwidth = 30.0 * std::pow(30.0, part(random));
    const double bound = sampled_critical_integral_gain(stiffness, plant, paper_encoder, controller, drive);
    if (bound == 0.0) continue;  // unstable without integral; its own test below
    ++judged;
    for (const double side : {0.99, 1.01}) {
      controller.ki = side * bound;
      const double growth = simulated_growth(stiffness, plant, controller, drive);
      const double radius = sampled_spectral_radius(stiffness, plant, paper_encoder, controller, drive);
      EXPECT_EQ(growth < 1.0, side < 1.0) << "trial " << i << ", delay " << controller.delay;
      EXPECT_EQ(radius < 1.0, side < 1.0) << "trial " << i << ", delay " << controller.delay;
    }
  }
  EXPECT_GT(judged, 30);
}

// The bound comes from the frequency response; the poles are those of the loop's map.
TEST(SampledCriticalIntegralGain, IsTheSmallestGainWithAPoleOnTheUnitCircle) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int judged = 0;
  for (int i = 0; i < 30; ++i) {
    const double stiffness = 50.0 * std::pow(20.0, part(random));
    loop::ControllerParameters controller;
    controller.kp = part(random) * stiffness * loop::fine_resolution(paper_encoder);
    controller.kd = i % 3 == 0 ? 0.0 : 1e-3 * part(random);
    controller.delay = i % 4 == 0 ? 30.0 * part(random) : 2.0 * part(random);
    const LinearDrive drive{1.0, i % 2 == 0 ? 0.0 : 300.0};
    const double bound = sampled_critical_integral_gain(stiffness, machine, paper_encoder, controller, drive);
    if (bound == 0.0) continue;
    ++judged;
    const auto radius = [&](double ki) {
      controller.ki = ki;
      return sampled_spectral_radius(stiffness, machine, paper_encoder, controller, drive);
    };
    EXPECT_NEAR(radius(bound), 1.0, 1e-9) << i;
    for (const double less : {1e-3, 0.1, 0.5, 0.9, 0.999}) EXPECT_LT(radius(less * bound), 1.0) << i;
  }
  EXPECT_GT(judged, 20);
}

TEST(SampledStability, SpectralRadiusIsTheGrowthOfTheLinearLoop) {
  for (const double delay : {0.0, 0.3, 1.0, 3.0}) {
    loop::ControllerParameters controller;
    controller.delay = delay;
    controller.kp = 1e-4;
    controller.kd = 1e-4;
    for (const LinearDrive& drive : {LinearDrive{}, LinearDrive{1.1, 150.0}}) {
      controller.ki = 1.02 * sampled_critical_integral_gain(300.0, machine, paper_encoder, controller, drive);
      EXPECT_NEAR(simulated_growth(300.0, machine, controller, drive),
                  sampled_spectral_radius(300.0, machine, paper_encoder, controller, drive), 2e-6);
    }
  }
}

TEST(SampledStability, DelayLowersTheBound) {
  loop::ControllerParameters controller;
  double last = 1.0;
  for (int delay = 0; delay < 5; ++delay) {
    controller.delay = delay;
    const double bound = sampled_critical_integral_gain(110.0, machine, paper_encoder, controller);
    EXPECT_LT(bound, last);
    EXPECT_GT(bound, 0.0);
    last = bound;
  }
}

TEST(SampledStability, LoopGainIncludesTheGainOfTheDrive) {
  const loop::ControllerParameters controller;
  EXPECT_NEAR(sampled_critical_integral_gain(110.0, machine, paper_encoder, controller, {1.5, 0.0}),
              sampled_critical_integral_gain(110.0, machine, paper_encoder, controller) / 1.5, 1e-12);
}

TEST(SampledStability, NoIntegralGainIsStableIfTheLoopWithoutIntegralIsUnstable) {
  loop::ControllerParameters controller;
  controller.kp = 1.0;  // N m/count: far beyond what half a sample of delay allows
  EXPECT_EQ(sampled_critical_integral_gain(110.0, machine, paper_encoder, controller), 0.0);
}

// A slow integral control: T·(k·Δx + kp)/(2·ki), to the first order in T/τ and in what the rotor itself
// takes.
TEST(SlowestTimeConstant, IsProportionalToTheStiffnessForASlowIntegral) {
  for (const double stiffness : {110.0, 860.0}) {
    for (const double kp : {0.0, 6.21e-4}) {
      loop::ControllerParameters controller;
      controller.kp = kp;
      controller.ki = 5e-8;
      const double expected = (stiffness * loop::fine_resolution(paper_encoder) + kp) /
                              (2.0 * controller.ki * controller.sample_rate);
      EXPECT_NEAR(slowest_time_constant(stiffness, machine, paper_encoder, controller), expected,
                  0.02 * expected);
    }
  }
}

TEST(SlowestTimeConstant, MatchesTheSimulatedDecay) {
  for (const double ki : {3e-7, 1e-6, 5e-6}) {
    loop::ControllerParameters controller;
    controller.ki = ki;
    LinearLoop loop(110.0, machine, controller, {});
    const double tau = slowest_time_constant(110.0, machine, paper_encoder, controller);
    const int samples = static_cast<int>(tau * controller.sample_rate) + 1;
    const auto largest_over = [&](int size) {
      double largest = 0.0;
      for (int k = 0; k < size; ++k) {
        loop.step();
        largest = std::max(largest, loop.size());
      }
      return largest;
    };
    const int stretch = std::max(40 * samples, 200);
    largest_over(5 * samples);
    const double before = largest_over(stretch);
    const double after = largest_over(stretch);
    const double elapsed = static_cast<double>(stretch) / controller.sample_rate;
    EXPECT_NEAR(elapsed / std::log(before / after), tau, 0.1 * tau) << ki;
  }
}

// A mass with damping under proportional control rings with 2·J/c, and creeps with c/k where c is large: the
// textbook's continuous loop, to which fast sampling is near.
TEST(SlowestTimeConstant, IncludesOscillatingModes) {
  constexpr double stiffness = 1.0;  // N m/rad, of kp
  for (const double damping : {2e-3, 0.0131, 0.02, 0.1}) {
    const motion::PlantParameters mass{.inertia = 2e-4, .presliding_damping = damping};
    loop::ControllerParameters controller;
    controller.sample_rate = 1e5;
    controller.ki = 0.0;
    controller.kp = stiffness * loop::fine_resolution(paper_encoder);
    const double of_decay = 0.5 * damping / mass.inertia;
    const double squared = stiffness / mass.inertia;
    const double slowest =
        of_decay * of_decay < squared ? of_decay : of_decay - std::sqrt(of_decay * of_decay - squared);
    EXPECT_NEAR(slowest_time_constant(0.0, mass, paper_encoder, controller), 1.0 / slowest, 0.01 / slowest)
        << damping;
  }
}

TEST(SlowestTimeConstant, IsInfiniteBeyondTheBound) {
  loop::ControllerParameters controller;
  const double bound = sampled_critical_integral_gain(110.0, machine, paper_encoder, controller);
  controller.ki = 1.001 * bound;
  EXPECT_TRUE(std::isinf(slowest_time_constant(110.0, machine, paper_encoder, controller)));
  controller.ki = 0.9 * bound;
  EXPECT_TRUE(std::isfinite(slowest_time_constant(110.0, machine, paper_encoder, controller)));
  controller.ki = 0.0;
  EXPECT_TRUE(std::isfinite(slowest_time_constant(110.0, machine, paper_encoder, controller)));
}

TEST(SampledCriticalIntegralGain, IsZeroForAFreeRotorWithoutProportionalGain) {
  for (const double damping : {0.0, 1e-4, 0.05, 3.0}) {  // the search has no gain to begin with
    const motion::PlantParameters free{.inertia = 5.54e-4, .presliding_damping = damping};
    EXPECT_EQ(sampled_critical_integral_gain(0.0, free, paper_encoder, {.kd = 1e-3}), 0.0) << damping;
  }
}

}  // namespace
}  // namespace zerocount::theory
