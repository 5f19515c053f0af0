// The disturbance of a trial: lines drawn from a power spectral density, ripples along the rotor.
#include "core/trial/disturbance.hpp"

#include "core/random/random_numbers.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A random spectrum of a vibration with some points over two to four decades of frequency.
trial::SpectrumParameters random_spectrum(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  trial::SpectrumParameters spectrum;
  double frequency = std::pow(10.0, uniform(-1.0, 1.0));
  for (std::uint64_t i = 2 + random() % 5; i > 0; --i) {
    spectrum.density.push_back({frequency, random() % 6 == 0 ? 0.0 : std::pow(10.0, uniform(-12.0, -8.0))});
    frequency *= std::pow(10.0, uniform(0.2, 1.0));
  }
  spectrum.lines = static_cast<int>(20 + random() % 100);
  return spectrum;
}

/// Spectral density S at the frequency f, interpolated straight between the points: on logarithmic axes, or
/// on linear ones beside a zero.
double density_at(const trial::SpectrumParameters& spectrum, double f) {
  for (std::size_t i = 1; i < spectrum.density.size(); ++i) {
    const auto [f0, s0] = spectrum.density[i - 1];
    const auto [f1, s1] = spectrum.density[i];
    if (f > f1) continue;
    if (s0 == 0.0 || s1 == 0.0) return s0 + (s1 - s0) * (f - f0) / (f1 - f0);
    return s0 * std::pow(s1 / s0, std::log(f / f0) / std::log(f1 / f0));
  }
  return 0.0;
}

/// Integral of the spectral density between two frequencies, by the midpoint rule in the logarithm of the
/// frequency.
double integral(const trial::SpectrumParameters& spectrum, double low, double high) {
  constexpr int steps = 200000;
  const double ratio = std::pow(high / low, 1.0 / steps);
  double sum = 0.0;
  double f = low;
  for (int i = 0; i < steps; ++i, f *= ratio)
    sum += density_at(spectrum, f * std::sqrt(ratio)) * f * (ratio - 1.0);
  return sum;
}

motion::Disturbance drawn(const trial::SpectrumParameters& spectrum, std::uint64_t trial) {
  trial::DisturbanceParameters parameters;
  parameters.spectra.push_back(std::make_shared<const trial::SpectrumParameters>(spectrum));
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.spectrum = {3, 4};
  return trial::disturbance_of(parameters, 0.0, randomness);
}

TEST(DisturbanceSpectrum, MeanSquareOfABandIsTheIntegralOfTheDensity) {
  std::mt19937_64 random(20);
  for (int i = 0; i < 20; ++i) {
    const trial::SpectrumParameters spectrum = random_spectrum(random);
    const double first = spectrum.density.front().frequency;
    const double last = spectrum.density.back().frequency;
    const double from = first * std::pow(last / first, 0.2);
    const double to = first * std::pow(last / first, 0.7);
    for (const auto& [low, high] : {std::pair{first, last}, std::pair{from, to}}) {
      const double expected = integral(spectrum, low, high);
      EXPECT_NEAR(trial::mean_square(spectrum, low, high), expected, 1e-4 * expected + 1e-25) << i;
    }
  }
}

TEST(DisturbanceSpectrum, LinesHaveTheMeanSquareOfTheirBands) {
  std::mt19937_64 random(21);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const trial::SpectrumParameters spectrum = random_spectrum(random);
    const double first = spectrum.density.front().frequency;
    const double last = spectrum.density.back().frequency;
    const motion::Disturbance disturbance = drawn(spectrum, i);
    const double edge = first * std::pow(last / first, std::floor(0.5 * spectrum.lines) / spectrum.lines);
    double all = 0.0;
    double below = 0.0;
    for (const motion::Vibration& line : disturbance.vibration) {
      const double frequency = line.rate / two_pi;
      EXPECT_GE(frequency, first);
      EXPECT_LE(frequency, last);
      all += 0.5 * line.amplitude * line.amplitude;
      if (frequency < edge) below += 0.5 * line.amplitude * line.amplitude;
    }
    const double total = trial::mean_square(spectrum, first, last);
    EXPECT_NEAR(all, total, 1e-9 * total);
    EXPECT_NEAR(below, trial::mean_square(spectrum, first, edge), 1e-9 * total);
    EXPECT_NE(disturbance.vibration.front().phase, drawn(spectrum, i + 1).vibration.front().phase);
  }
}

// The torque itself, over a time in which each line has many periods.
TEST(DisturbanceSpectrum, TorqueHasTheRmsOfTheDensity) {
  const trial::SpectrumParameters spectrum{{{2.0, 1e-10}, {20.0, 1e-9}, {200.0, 1e-12}}, 60};
  double sum = 0.0;
  constexpr int samples = 200000;
  const motion::Disturbance disturbance = drawn(spectrum, 5);
  for (int i = 0; i < samples; ++i) {
    const double torque = motion::value({disturbance, 1.17e-3 * i, 0.0});
    sum += torque * torque;
  }
  const double total = trial::mean_square(spectrum, 2.0, 200.0);
  EXPECT_NEAR(std::sqrt(sum / samples), std::sqrt(total), 0.02 * std::sqrt(total));
}

TEST(DisturbanceRipple, DependsOnTheAngleOfTheRotor) {
  trial::DisturbanceParameters parameters;
  parameters.ripple = {{0.01, 36.0, 0.0, 0.4}, {0.02, 0.0, 1e-3, 0.1}, {0.0, 5.0, 0.0, 0.0}};
  const double position = 1.234;
  const motion::Disturbance disturbance = trial::disturbance_of(parameters, position, {});
  ASSERT_EQ(disturbance.ripple.size(), 2u);
  for (const double theta : {0.0, 1e-4, -0.02}) {
    const double expected = 0.01 * std::sin(36.0 * (theta + position) + 0.4) +
                            0.02 * std::sin(two_pi * (theta + position) / 1e-3 + 0.1);
    EXPECT_NEAR(motion::value({disturbance, 0.0, theta}), expected, 1e-12);
  }
}

// The compensators of real drives, missed samples and the converter's sigma-delta, against a computation of
// each decision from the recorded counts by the equations (core/loop/equations.md).

trial::TrialParameters compensated_trial(std::uint64_t index) {
  trial::TrialParameters p =
      random_trial(index % 3 == 0 ? TrialKind::breaking_away : TrialKind::calm, 61000 + index);
  RandomBlocks draw(62000 + index);
  const double sample_rate = p.controller.sample_rate;
  p.controller.coarse = {};
  p.controller.blocks = {};
  p.command.profile = {};
  p.encoder.fine_errors = {};
  p.controller.encoder = loop::EncoderChoice::fine;
  if (draw.chance(0.7)) {
    p.controller.ki = draw.log_uniform(5e-6, 1e-4);
    p.controller.kp = draw.some(draw.log_uniform(1e-5, 1e-3));
    p.controller.kd = draw.some(draw.log_uniform(1e-5, 1e-3));
  }
  loop::ControlBlocks& blocks = p.controller.blocks;
  if (draw.chance(0.6))
    blocks.error_deadband = draw.blocks(BlockKind::error_deadband, sample_rate).error_deadband;
  if (draw.chance(0.6)) blocks.hold = draw.blocks(BlockKind::hold, sample_rate).hold;
  if (draw.chance(0.6)) blocks.standstill = draw.blocks(BlockKind::standstill, sample_rate).standstill;
  if (draw.chance(0.4)) blocks.deadband = draw.blocks(BlockKind::deadband, sample_rate).deadband;
  if (draw.chance(0.4))
    p.controller.dither = {draw.log_uniform(1e-5, 3e-3), sample_rate * draw.uniform(0.05, 0.5)};
  if (draw.chance(0.4)) p.controller.missed = draw.uniform(0.0, 0.4);
  p.dac.sigma_delta = draw.chance(0.4);
  p.command.targets = {p.command.targets.front(), p.command.targets.front() + static_cast<int>(index % 3),
                       p.command.targets.front() - 1};
  p.command.hold = 0.08;
  p.randomness.missed_samples = {17, 18};
  p.verdict.stop = false;
  return p;
}

/// The state of the control law, recomputed from the definition, with its decision at each sample of a trial.
class LiteralControl {
 public:
  explicit LiteralControl(const trial::TrialParameters& p) : p_(p), integral_(p.initial.integral) {}

  /// The torque that the control law wants at the sample, with the dither, N m.
  double decide(const trial::SampleRecord& sample) {
    const loop::ControlBlocks& b = p_.controller.blocks;
    const auto e = static_cast<double>(sample.target - sample.count);
    const auto count = static_cast<double>(sample.count);
    const bool first = !ran_;
    const bool new_target = ran_ && sample.target != target_;
    if (first) count_ = count;
    if (new_target) within_hold_ = within_standstill_ = 0;
    within_hold_ = std::abs(e) <= b.hold.enter ? within_hold_ + 1 : 0;
    within_standstill_ = std::abs(e) <= b.standstill.band ? within_standstill_ + 1 : 0;
    const bool stands = within_standstill_ >= samples(b.standstill.dwell) && !new_target;
    const bool stays = holding_ && std::abs(e) <= std::max(b.hold.enter, b.hold.leave);
    holding_ = !first && !new_target && (stays || within_hold_ >= samples(b.hold.dwell));
    const double size = std::abs(e);
    double acting = e;
    if (size <= b.error_deadband.band) {
      acting = 0.0;
    } else if (b.error_deadband.form == loop::DeadbandForm::subtract && b.error_deadband.band > 0.0) {
      acting = e > 0.0 ? e - b.error_deadband.band : e + b.error_deadband.band;
    }
    if (!holding_) {
      const double kp = stands ? b.standstill.kp : p_.controller.kp;
      const double ki = stands ? b.standstill.ki : p_.controller.ki;
      const double kd = stands ? b.standstill.kd : p_.controller.kd;
      frozen_ = size <= (frozen_ ? std::max(b.deadband.enter, b.deadband.leave) : b.deadband.enter);
      if (!frozen_) {
        integral_ += ki * (acting + acting_);
        if (p_.controller.anti_windup == loop::AntiWindup::clamp)
          integral_ = std::clamp(integral_, loop::lowest_torque(p_.dac), loop::highest_torque(p_.dac));
      }
      wanted_ = integral_ + kp * acting - kd * (count - count_);
    }
    acting_ = acting;
    count_ = count;
    target_ = sample.target;
    ran_ = true;
    const loop::Dither& dither = p_.controller.dither;
    const double halves =
        std::floor(2.0 * dither.frequency * static_cast<double>(sample.k) / p_.controller.sample_rate);
    return wanted_ + (std::fmod(halves, 2.0) == 0.0 ? dither.amplitude : -dither.amplitude);
  }

  bool holds() const { return holding_; }
  bool stands() const { return within_standstill_ > 0; }

 private:
  double samples(double dwell) const { return std::max(1.0, std::round(dwell * p_.controller.sample_rate)); }

  const trial::TrialParameters& p_;
  double integral_;
  double acting_{0.0};
  double count_{0.0};
  double wanted_{0.0};
  std::int64_t target_{0};
  double within_hold_{0.0};
  double within_standstill_{0.0};
  bool ran_{false};
  bool holding_{false};
  bool frozen_{false};
};

TEST(Compensators, FollowTheirEquations) {
  int held = 0;
  int missed = 0;
  int clipped = 0;
  for (std::uint64_t index = 0; index < 200; ++index) {
    const trial::TrialParameters p = compensated_trial(index);
    std::vector<trial::SampleRecord> samples;
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& sample) { samples.push_back(sample); };
    trial::run_trial(p, observers);
    LiteralControl control(p);
    double remainder = 0.0;
    std::int64_t code = 0;
    for (const trial::SampleRecord& sample : samples) {
      const double uniform = random::open_uniform(
          random::random_bits_at({p.randomness.missed_samples, p.randomness.stream}, p.randomness.trial,
                                 static_cast<std::uint64_t>(sample.k)));
      if (uniform < p.controller.missed) {
        ++missed;
        ASSERT_EQ(sample.code, code) << "trial " << index << " sample " << sample.k;
        continue;
      }
      const double wanted = control.decide(sample) + remainder;
      const double rounded = std::nearbyint(wanted / p.dac.resolution);
      const double limit = std::ldexp(1.0, p.dac.bits - 1);
      code = static_cast<std::int64_t>(std::clamp(rounded, -limit, limit - 1.0));
      ASSERT_EQ(sample.code, code) << "trial " << index << " sample " << sample.k;
      const bool clips = rounded != static_cast<double>(code);
      clipped += clips ? 1 : 0;
      if (p.dac.sigma_delta) remainder = clips ? 0.0 : wanted - static_cast<double>(code) * p.dac.resolution;
      held += control.holds() ? 1 : 0;
    }
  }
  EXPECT_GT(held, 1000);
  EXPECT_GT(missed, 1000);
  EXPECT_GT(clipped, 100);
}

}  // namespace
}  // namespace zerocount::testing
