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

namespace zerocount {

/// The mean of a profile where it is drawn, once for every rotor.
struct DrawnMean {
  Distribution distribution;
  Design design{Design::monte_carlo};
  SlotRandomness randomness;
};

/// The rotors along which one parameter of friction varies: a single one, or one for every rig. Each is a
/// function of the seed, the parameter's name and its own number. They are made when they are asked for, and
/// kept while they fit into `max_kept_bytes`: thousands of rigs take no time before they run. Safe to use
/// from many threads.
class Rotors {
 public:
  /// @param count how many there are. @param name dotted path of the parameter.
  Rotors(ProfileDescription description, std::optional<DrawnMean> mean, std::uint64_t seed,
         std::string_view name, std::int64_t count);

  std::int64_t count() const { return count_; }
  std::size_t harmonics() const { return amplitudes_.size(); }
  bool has_drawn_mean() const { return mean_.has_value(); }

  /// Mean of the ensemble that the rotor is of, in the parameter's unit.
  double mean(std::int64_t rotor) const;
  std::shared_ptr<const Profile> rotor(std::int64_t rotor) const;

  /// Limits that no rotor leaves whatever its random numbers, known without making any.
  Interval bounds() const;

  /// Limits that none of the rotors leaves: those of limits(Profile), over all of them.
  Interval all_limits() const;

 private:
  Profile realise(std::int64_t rotor) const;

  static constexpr std::size_t max_kept_bytes = std::size_t{1} << 26;

  ProfileDescription description_;
  std::optional<DrawnMean> mean_;
  RandomKey key_;
  std::int64_t count_;
  std::vector<double> amplitudes_;  // √S_m

  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const Profile>> kept_;  // [rotor], as far as there is room
  mutable std::optional<Interval> limits_;
};

}  // namespace zerocount
