#include "core/loop/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/numerics/elementary_functions.hpp"
#include "core/random/variates.hpp"

namespace zerocount::loop {
namespace {

/// Bandwidth limit, Hz: a torque settles within a picosecond. The series of a faster rise would leave the
/// range of a double.
constexpr double highest_bandwidth = 1e12;

}  // namespace

TorqueDelay::TorqueDelay(double samples)
    : waiting_(static_cast<std::size_t>(std::ceil(samples)), 0.0), fraction_(samples - std::floor(samples)) {}

TorqueDelay::Leaving TorqueDelay::pass(double torque) {
  if (waiting_.empty()) return {torque, torque};
  const double leaving = std::exchange(waiting_[oldest_], torque);
  oldest_ = (oldest_ + 1) % waiting_.size();
  return {leaving, fraction_ > 0.0 ? waiting_[oldest_] : leaving};
}

Drive::Drive(const DacParameters& dac, const AmplifierParameters& amplifier, double delay, double sample_time,
             const random::TrialRandomness& randomness)
    : dac_(dac),
      converter_errors_(has_errors(dac)),
      noise_{randomness.dac_noise, randomness.stream},
      trial_(randomness.trial),
      delay_(delay),
      rate_(2.0 * std::numbers::pi * std::min(amplifier.bandwidth, highest_bandwidth)),
      sample_(part(sample_time)),
      before_(part(delay_.fraction() * sample_time)),
      after_(part(sample_time - before_.duration)) {}

Drive::Part Drive::part(double duration) const {
  return {duration, numerics::exp(-rate_ * duration)};
}

void Drive::apply(double torque) {
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

double Drive::converted(std::int64_t k, std::int64_t code) const {
  const double torque = torque_with_errors(dac_, code);
  if (dac_.noise == 0.0) return torque;
  return torque + dac_.noise * random::standard_normal(
                                   random::random_bits_at(noise_, trial_, static_cast<std::uint64_t>(k)));
}

/// The piece with this input after the piece `last`.
TorquePiece Drive::follow(double input, const TorquePiece& last, const Part& part) const {
  if (rate_ == 0.0) return {motion::constant_torque(input), part.duration, 1.0};
  double lag = (last.course.now - last.course.settled) * last.decay;
  // A denormal lag would never decay further, and denormal arithmetic is slow.
  if (std::abs(lag) < std::numeric_limits<double>::min()) lag = 0.0;
  return {{last.course.settled + lag, input, rate_}, part.duration, part.decay};
}

}  // namespace zerocount::loop
