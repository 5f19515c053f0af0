#include "core/loop/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"
#include "core/random/variates.hpp"

namespace zerocount::loop {
namespace {

/// Bandwidth limit, Hz: a torque settles within a picosecond. The series of a faster rise would leave the
/// range of a double.
constexpr double highest_bandwidth = 1e12;

}  // namespace

Drive::Drive(const DacParameters& dac, const AmplifierParameters& amplifier, int delay, double sample_time,
             const random::TrialRandomness& randomness)
    : dac_(dac),
      converter_errors_(has_errors(dac)),
      noise_{randomness.dac_noise, randomness.stream},
      trial_(randomness.trial),
      delay_(delay),
      rate_(2.0 * std::numbers::pi * std::min(amplifier.bandwidth, highest_bandwidth)),
      decay_per_sample_(numerics::exp(-rate_ * sample_time)) {}

double Drive::converted(std::int64_t k, std::int64_t code) const {
  const double torque = torque_with_errors(dac_, code);
  if (dac_.noise == 0.0) return torque;
  return torque + dac_.noise * random::standard_normal(
                                   random::random_bits_at(noise_, trial_, static_cast<std::uint64_t>(k)));
}

void Drive::follow(double input) {
  double lag = (course_.now - course_.settled) * decay_per_sample_;
  // A denormal lag would never decay further, and denormal arithmetic is slow.
  if (std::abs(lag) < std::numeric_limits<double>::min()) lag = 0.0;
  course_ = {course_.settled + lag, input, rate_};
}

}  // namespace zerocount::loop
