#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/trials/worlds/world_rule.hpp"

/// The value of measuring one unknown parameter: how often the measurement would tell whether the goal is
/// reached.
namespace zerocount::worlds {

/// Smallest number of other worlds (possible values of what nobody knows) that remain possible after a
/// measurement.
inline constexpr std::size_t min_possible_worlds = 4;

/// Numbers of worlds (possible values of what nobody knows) for which a measurement of one parameter tells,
/// or does not, whether the goal is reached.
struct Learned {
  std::size_t input{0};
  /// Number of worlds in which the goal is reached, as it is in all worlds that remain possible.
  std::int64_t decided_good{0};
  /// Number of worlds that miss the goal, as do all worlds that remain possible.
  std::int64_t decided_bad{0};
  /// Number of good worlds (that reach the goal) for which all other worlds that remain possible miss it.
  std::int64_t rejected_good{0};
  /// Number of bad worlds (that miss the goal) for which all other worlds that remain possible reach it.
  std::int64_t missed_bad{0};
  /// Number of worlds for which the other worlds that remain possible are partly good and partly bad.
  std::int64_t open{0};
  /// p-value: probability that this or any other parameter would show as many decided minus misjudged worlds,
  /// if good and bad worlds had nothing to do with any of them: an unknown that does not matter decides too
  /// where few worlds are bad.
  double p_value{1.0};

  std::int64_t decided() const { return decided_good + decided_bad; }
  std::int64_t misjudged() const { return rejected_good + missed_bad; }
  /// Whether the measurement does better than a word that needs none: it finds more bad worlds than it
  /// rejects good ones ("all are good" finds and rejects none), and more good worlds than it misses bad ones
  /// ("all are bad"). A world that it leaves open is taken as by that word.
  bool does_better_than_no_measurement() const {
    return decided_bad > rejected_good && decided_good > missed_bad;
  }
};

/// The unknown parameters in order of what measuring them tells: number of decided minus misjudged worlds,
/// the largest first.
///
///     for each input, for each world taken for the truth:
///       possible = other worlds within ±precision of its value, or the four nearest if these are fewer
///       all possible worlds are like it: decided; all are unlike it: misjudged; otherwise open
///
/// @param bad [world] true if the world misses the goal
/// @param precision relative error of the measurement, above 0
/// @param seed seed of the 399 permutations for the p-values, which allow for the number of parameters and
/// for what these have in common (the smallest p-value of each permutation: Westfall and Young,
/// Resampling-Based Multiple Testing, 1993)
std::vector<Learned> what_to_learn(const std::vector<WorldInput>& inputs, const std::vector<bool>& bad,
                                   double precision, std::uint64_t seed);

/// Kind of record from which `zerocount identify` estimates the parameter or derived quantity, such as
/// "strokes that slide (identify --sliding)"; empty if there is none.
std::string_view record_of(std::string_view parameter);

}  // namespace zerocount::worlds
