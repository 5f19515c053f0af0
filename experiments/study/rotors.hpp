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

/// Distribution of the mean of a profile, drawn once for every rotor.
struct DrawnMean {
  distributions::Distribution distribution;
  Design design{Design::monte_carlo};
  SlotRandomness randomness;
  std::uint64_t worlds{0};     ///< that the rotors are dealt to
  random::RandomKey places{};  ///< of their order, in the design sobol

  bool operator==(const DrawnMean&) const = default;
};

/// The profiles of one friction parameter: a single rotor, or one rotor per machine. A profile is a function
/// of the seed, the parameter's name and the rotor's number. Profiles are created on demand and cached up to
/// `max_kept_bytes`, so that thousands of machines need no setup time. Thread-safe.
class Rotors {
 public:
  /// @param count number of rotors @param name dotted path of the parameter
  Rotors(distributions::ProfileDescription description, std::optional<DrawnMean> mean, std::uint64_t seed,
         std::string_view name, std::int64_t count);

  /// Rotors with the same random numbers, whose random field, and mean if it is drawn, deviate `factor` times
  /// as much from their centres (distributions::widened).
  std::shared_ptr<const Rotors> widened(double factor) const;

  /// Whether all profiles are equal.
  bool is_same(const Rotors& other) const;

  std::int64_t count() const { return count_; }
  std::size_t harmonics() const { return amplitudes_.size(); }
  /// Nothing if the mean is fixed.
  const std::optional<DrawnMean>& drawn_mean() const { return mean_; }

  /// Mean of the random field of this rotor, in the parameter's unit.
  double mean(std::int64_t rotor) const;
  std::shared_ptr<const friction::Profile> rotor(std::int64_t rotor) const;

  /// The mean at this quantile of its distribution; the fixed mean if it is not drawn.
  double mean_at(double quantile) const;

  /// The profile of a rotor of which some random numbers are given: the quantile of its mean, and the value
  /// of its field g at a position. The field is that of the rotor, conditional on this value: Δ = field −
  /// g(position) is added with the correlation ρ of the field, g(θ) + Δ·ρ(θ − position).
  friction::Profile rotor_with(std::int64_t rotor, std::optional<double> mean_quantile,
                               std::optional<double> field, double position) const;

  /// Bounds for all random numbers, computed without creating a profile.
  numerics::Interval bounds() const;

  /// Bounds of the actual rotors: limits(Profile) over all of them.
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
