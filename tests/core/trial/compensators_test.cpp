// The compensators of real drives, missed samples and the converter's sigma-delta, against a computation of
// each decision from the recorded counts by the equations (core/loop/equations.md).
#include "core/random/random_numbers.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

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

/// The state of the control law, and its decision at each sample that ran.
class LiteralControl {
 public:
  explicit LiteralControl(const trial::TrialParameters& p) : p_(p), integral_(p.initial.integral) {}

  /// The wanted torque with the dither, N m.
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

TEST(Compensators, DecideByTheirEquations) {
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
