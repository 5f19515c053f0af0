#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/worlds/world_rule.hpp"

/// The value of measuring one unknown parameter.
namespace zerocount::worlds {

/// Smallest number of worlds that remain possible after a measurement.
inline constexpr std::size_t min_possible_worlds = 4;

/// Numbers of worlds for which a measurement of one parameter decides, or does not, whether the goal is
/// reached.
struct Learned {
  std::size_t input{0};
  /// Number of worlds in which the goal is reached, as it is in all worlds that remain possible.
  std::int64_t decided_good{0};
  /// Number of worlds that miss the goal, as do all worlds that remain possible.
  std::int64_t decided_bad{0};
  /// Number of good worlds for which all other worlds that remain possible miss the goal.
  std::int64_t rejected_good{0};
  /// Number of bad worlds for which all other worlds that remain possible reach the goal.
  std::int64_t missed_bad{0};
  std::int64_t open{0};  ///< Number of worlds for which worlds of both kinds remain possible.
  /// Probability of as many decided, less misjudged, for this or any other parameter, if good and bad worlds
  /// had nothing to do with any of them: an unknown that does not matter decides too where few worlds are
  /// bad.
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

/// The parameters in order of decided − misjudged worlds, the most first.
///
///     for each input, for each world taken for the truth:
///       possible = other worlds within ±precision of its value, or the four nearest if these are fewer
///       all possible worlds are like it: decided; all are unlike it: misjudged; otherwise open
///
/// @param bad [world] @param precision relative error of the measurement, above 0 @param seed of the 399
/// permutations for the p-values, which allow for the number of parameters and for what these have in common
/// (the smallest p-value of each permutation: Westfall and Young, Resampling-Based Multiple Testing, 1993)
std::vector<Learned> what_to_learn(const std::vector<WorldInput>& inputs, const std::vector<bool>& bad,
                                   double precision, std::uint64_t seed);

/// Record from which `zerocount identify` estimates the parameter or derived quantity, such as "strokes that
/// slide (identify --sliding)"; empty if there is none.
std::string_view record_of(std::string_view parameter);

}  // namespace zerocount::worlds
