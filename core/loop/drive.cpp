#include "core/loop/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/numerics/elementary_functions.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::loop {
namespace {

/// Largest bandwidth of the amplifier that is simulated, Hz: the torque then settles within a picosecond. The
/// series of a faster rise would leave the range of a double.
constexpr double max_bandwidth = 1e12;

}  // namespace

double lag_rate(const AmplifierParameters& amplifier) {
  return 2.0 * std::numbers::pi * std::min(amplifier.bandwidth, max_bandwidth);
}

TorqueDelay::TorqueDelay(double samples, double held)
    : waiting_(static_cast<std::size_t>(std::ceil(samples)), held),
      fraction_(samples - std::floor(samples)) {}

TorqueDelay::Leaving TorqueDelay::pass(double torque) {
  if (waiting_.empty()) return {torque, torque};
  const double leaving = std::exchange(waiting_[oldest_], torque);
  oldest_ = (oldest_ + 1) % waiting_.size();
  return {leaving, fraction_ > 0.0 ? waiting_[oldest_] : leaving};
}

Drive::Drive(const DacParameters& dac, const AmplifierParameters& amplifier, double delay, double sample_time,
             const random::TrialRandomness& randomness, bool jitter, double held)
    : converter_(dac, randomness),
      delay_(delay, held),
      rate_(lag_rate(amplifier)),
      sample_(part(sample_time)),
      before_(part(delay_.fraction() * sample_time)),
      after_(part(sample_time - before_.duration)),
      sample_time_(sample_time),
      delay_time_(delay * sample_time),
      input_(held),
      jitters_(jitter) {
  pieces_[0].course = motion::constant_torque(held);
}

Drive::Part Drive::part(double duration) const {
  return {duration, rate_ == 0.0 ? 1.0 : numerics::exp(-rate_ * duration)};
}

/// Passes a torque through delay and amplifier if samples may be late. At most three torques become due
/// between two samples, because these are less than two sample times apart.
void Drive::apply_late(double torque, const Lateness& late) {
  changes_.push_back({delay_time_ + late.now, torque});
  const double end = sample_time_ + late.next;
  TorquePiece last = pieces_[count_ - 1];
  count_ = 0;
  const auto add = [&](double duration) { last = pieces_[count_++] = follow(input_, last, part(duration)); };
  double from = late.now;
  std::size_t due = 0;
  for (; due < changes_.size() && changes_[due].due < end; ++due) {
    if (changes_[due].due > from) add(changes_[due].due - from);
    from = std::max(from, changes_[due].due);
    input_ = changes_[due].torque;
  }
  add(end - from);
  changes_.erase(changes_.begin(), changes_.begin() + static_cast<std::ptrdiff_t>(due));
  for (Change& change : changes_) change.due -= sample_time_;
}

void Drive::apply(double torque, const Lateness& late) {
  if (jitters_) return apply_late(torque, late);
  const TorqueDelay::Leaving input = delay_.pass(torque);
  const TorquePiece last = pieces_[count_ - 1];
  if (input.before == input.after) {
    pieces_[0] = follow(input.after, last, sample_);
    count_ = 1;
  } else {
    pieces_[0] = follow(input.before, last, before_);
    pieces_[1] = follow(input.after, pieces_[0], after_);
    count_ = 2;
  }
}

ConverterErrors::ConverterErrors(const DacParameters& dac, const random::TrialRandomness& randomness)
    : dac_(dac),
      any_(has_errors(dac)),
      noise_{randomness.dac_noise, randomness.stream},
      trial_(randomness.trial) {}

double ConverterErrors::with_errors(std::int64_t k, std::int64_t code) const {
  const double torque = torque_with_errors(dac_, code);
  if (dac_.noise == 0.0) return torque;
  return torque + dac_.noise * random::standard_normal_noise(
                                   random::random_bits_at(noise_, trial_, static_cast<std::uint64_t>(k)));
}

/// The piece of the motor's torque with the amplifier input `input` that follows the piece `last`.
/// @param part its duration, and the decay of the amplifier's lag in it.
TorquePiece Drive::follow(double input, const TorquePiece& last, const Part& part) const {
  if (rate_ == 0.0) return {motion::constant_torque(input), part.duration, 1.0};
  double lag = (last.course.now - last.course.settled) * last.decay;
  // A denormal lag would never decay further, and denormal arithmetic is slow.
  if (std::abs(lag) < std::numeric_limits<double>::min()) lag = 0.0;
  return {{last.course.settled + lag, input, rate_}, part.duration, part.decay};
}

}  // namespace zerocount::loop
