#include "tests/support/odeint_trial.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "core/trial/open_loop.hpp"

namespace zerocount::testing {

namespace {

std::int64_t read_encoder(long double theta, double counts_per_revolution, double phase) {
  const double resolution = 2.0 * std::numbers::pi / counts_per_revolution;
  return static_cast<std::int64_t>(std::floor(theta / resolution + phase));
}

/// The sampled part of the loop: error, trapezoidal integral, PID and DAC, in double precision, with one
/// rounding per operation, in the stated order.
class SampledLoop {
 public:
  explicit SampledLoop(const trial::TrialParameters& p)
      : gains_(p.controller),
        resolution_(p.dac.resolution),
        lowest_(-std::ldexp(1.0, p.dac.bits - 1)),
        highest_(std::ldexp(1.0, p.dac.bits - 1) - 1.0),
        integral_(p.initial.integral),
        last_count_(read_encoder(-p.initial.velocity * (1.0L / p.controller.sample_rate), p.encoder.fine,
                                 p.initial.encoder_phase)) {}

  std::int64_t decide(std::int64_t target, std::int64_t count) {
    const std::int64_t error = target - count;
    const auto change = static_cast<double>(count - last_count_);
    integral_ = integral_ + gains_.ki * static_cast<double>(error + last_error_);
    if (gains_.anti_windup == loop::AntiWindup::clamp) {
      integral_ = std::clamp(integral_, lowest_ * resolution_, highest_ * resolution_);
    }
    const double torque = integral_ + gains_.kp * static_cast<double>(error) - gains_.kd * change;
    last_error_ = error;
    last_count_ = count;
    return static_cast<std::int64_t>(std::clamp(std::nearbyint(torque / resolution_), lowest_, highest_));
  }

 private:
  loop::ControllerParameters gains_;
  double resolution_;
  double lowest_;
  double highest_;
  double integral_;
  std::int64_t last_error_{0};
  std::int64_t last_count_;  // before the first sample that of a motion at the initial velocity up to 0
};

}  // namespace

std::vector<trial::SampleRecord> odeint_trial(const trial::TrialParameters& parameters, EventCounts* events) {
  OdeintMotion motion(parameters, trial::draw_history(parameters.initial.history, parameters.randomness));
  SampledLoop loop(parameters);
  const double rate = parameters.controller.sample_rate;
  const long double period = 1.0L / rate;
  const auto samples = static_cast<std::int64_t>(std::llround(parameters.command.hold * rate));
  const long double amplifier = 2 * std::numbers::pi_v<long double> * parameters.amplifier.bandwidth;
  OdeintMotion::Torque drive{0, 0, amplifier};
  const double whole = std::floor(parameters.controller.delay);
  const long double late = parameters.controller.delay - whole;  // samples
  std::deque<double> waiting(static_cast<std::size_t>(whole) + 1, 0.0);
  std::vector<trial::SampleRecord> records;
  for (const std::int64_t target : parameters.command.targets) {
    for (std::int64_t i = 0; i < samples; ++i) {
      trial::SampleRecord record;
      record.k = static_cast<std::int64_t>(records.size());
      record.t = static_cast<double>(record.k) / rate;
      record.target = target;
      record.count = read_encoder(motion.theta(), parameters.encoder.fine, parameters.initial.encoder_phase);
      record.coarse_count =
          read_encoder(motion.theta(), parameters.encoder.coarse, parameters.initial.encoder_phase);
      record.error = target - record.count;
      record.code = loop.decide(target, record.count);
      record.torque = static_cast<double>(record.code) * parameters.dac.resolution;
      record.theta = static_cast<double>(motion.theta());
      record.omega = static_cast<double>(motion.state()[1]);
      record.xp = static_cast<double>(motion.state()[2]);
      record.xh = static_cast<double>(motion.state()[3]);
      record.depth = motion.depth();
      record.mode = motion.sliding() ? trial::HookMode::slide : trial::HookMode::stick;
      waiting.push_back(record.torque);
      const auto drive_by = [&](double torque, long double time) {
        drive.settled = torque;
        if (amplifier == 0) drive.now = torque;
        motion.advance(drive, time);
        drive.now = drive.settled + (drive.now - drive.settled) * std::exp(-amplifier * time);
      };
      record.drive_torque = amplifier == 0 ? waiting[late > 0 ? 0 : 1] : static_cast<double>(drive.now);
      records.push_back(record);
      if (late > 0) drive_by(waiting[0], late * period);
      drive_by(waiting[1], (1 - late) * period);
      waiting.pop_front();
    }
  }
  if (events != nullptr) *events = motion.events();
  return records;
}

}  // namespace zerocount::testing
