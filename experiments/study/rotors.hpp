#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "core/friction/profile.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/study/draws.hpp"

namespace zerocount::study {

/// Distribution of the mean of a friction parameter that varies along the axis. The mean is drawn once for
/// every rotor.
struct DrawnMean {
  distributions::Distribution distribution;
  Design design{Design::monte_carlo};
  SlotRandomness randomness;
  /// Number of worlds (possible sets of the shared unknown values) among which the rotors are divided; 0: no
  /// worlds.
  std::uint64_t worlds{0};
  /// Key of the random order in which the rotors take Sobol points; for the design sobol.
  random::RandomKey places{};

  bool operator==(const DrawnMean&) const = default;
};

/// The profiles of one friction parameter: a single rotor, or one rotor per machine. A profile is a function
/// of the seed, the name of the parameter and the index of the rotor. Profiles are created on demand and
/// cached up to `max_kept_bytes`, so that thousands of machines need no setup time. Thread-safe.
class Rotors {
 public:
  /// @param count number of rotors
  /// @param name dotted path of the parameter
  Rotors(distributions::ProfileDescription description, std::optional<DrawnMean> mean, std::uint64_t seed,
         std::string_view name, std::int64_t count);

  /// Copy with the same random numbers and a wider spread: the random field, and the mean if it is drawn,
  /// deviate `factor` times as much from their centres (distributions::widened).
  std::shared_ptr<const Rotors> widened(double factor) const;

  /// Whether all profiles of this object and of the other one are equal.
  bool is_same(const Rotors& other) const;

  std::int64_t count() const { return count_; }
  std::size_t harmonics() const { return amplitudes_.size(); }
  /// Distribution of the mean; empty if the mean is fixed.
  const std::optional<DrawnMean>& drawn_mean() const { return mean_; }

  /// Mean of the random field of this rotor, in the parameter's unit.
  double mean(std::int64_t rotor) const;
  std::shared_ptr<const friction::Profile> rotor(std::int64_t rotor) const;

  /// The mean of the friction parameter along a rotor at this quantile of the mean's distribution; the fixed
  /// mean if it is not drawn.
  double mean_at(double quantile) const;

  /// The friction parameter along a rotor for which some random numbers are given: the quantile of its mean,
  /// the value of its Gaussian random field g at one position, or both. The field of the rotor is conditioned
  /// on this value: with Δ = field − g(position) and the correlation function ρ of the field, it becomes g(θ)
  /// + Δ·ρ(θ − position).
  friction::Profile rotor_with(std::int64_t rotor, std::optional<double> mean_quantile,
                               std::optional<double> field, double position) const;

  /// Interval that contains all values of the friction parameter on all possible rotors, computed without
  /// creating the rotors' profiles.
  numerics::Interval bounds() const;

  /// Interval that contains all values of the friction parameter on the actual rotors: hull of
  /// distributions::limits() of their profiles.
  numerics::Interval all_limits() const;

 private:
  Rotors(const distributions::ProfileDescription& description, std::optional<DrawnMean> mean,
         const random::RandomKey& key, std::int64_t count);

  friction::Profile realise(std::int64_t rotor, double mean) const;

  static constexpr std::size_t max_kept_bytes = std::size_t{1} << 26;

  distributions::ProfileDescription description_;
  std::optional<DrawnMean> mean_;
  random::RandomKey key_;
  std::int64_t count_;
  std::vector<double> amplitudes_;  // √S_m

  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const friction::Profile>>
      kept_;  // [rotor] cache, limited by max_kept_bytes
  mutable std::optional<numerics::Interval> limits_;
};

}  // namespace zerocount::study
