#pragma once

#include <cstdint>

#include "core/loop/parameters.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::loop {

/// Instants at which the samples of a trial are taken, and samples at which the controller runs. Sample k is
/// taken at
///
///   t_k + δ_k,   t_k = k·T,   δ_k = jitter·u_k,   u_k uniform in (0, 1), number k of its key,
///
/// and the controller does not run where the uniform number k of another key is below `missed`.
class SampleClock {
 public:
  SampleClock(const ControllerParameters& parameters, const random::TrialRandomness& randomness)
      : jitter_(parameters.jitter),
        missed_(parameters.missed),
        jitter_stream_{randomness.jitter, randomness.stream},
        missed_stream_{randomness.missed_samples, randomness.stream},
        trial_(randomness.trial) {}

  /// Time δ_k by which sample k is late, s.
  double lateness(std::int64_t k) const { return jitter_ > 0.0 ? jitter_ * uniform(jitter_stream_, k) : 0.0; }
  /// Whether the controller runs at sample k.
  bool runs(std::int64_t k) const { return missed_ == 0.0 || uniform(missed_stream_, k) >= missed_; }

 private:
  double uniform(const random::RandomStream& stream, std::int64_t k) const {
    return random::open_uniform(random::random_bits_at(stream, trial_, static_cast<std::uint64_t>(k)));
  }

  double jitter_;
  double missed_;
  random::RandomStream jitter_stream_;
  random::RandomStream missed_stream_;
  std::uint64_t trial_;
};

}  // namespace zerocount::loop
