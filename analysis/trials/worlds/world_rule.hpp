#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/study.hpp"

/// Search for a rule that separates bad worlds from the others. A world is one draw of what all machines
/// share and nobody knows; it is bad if it misses the goal.
namespace zerocount::worlds {

/// Number of random permutations of a permutation test.
inline constexpr int permutations = 399;

/// The numbers 0, 1, …, size − 1 in a random order (Fisher and Yates).
/// @param number number of the permutation, which determines its random numbers
std::vector<std::size_t> permutation_of(std::size_t size, const random::RandomKey& key, std::uint32_t number);

/// The p-value of a statistic if `as_good` of the random permutations reach it: (1 + as_good)/(1 +
/// permutations).
inline double p_value_of_permutations(std::int64_t as_good) {
  return static_cast<double>(1 + as_good) / static_cast<double>(1 + permutations);
}

/// A quantity that differs between worlds (draws of what all machines share and nobody knows): an unknown
/// parameter, or a DerivedQuantity.
struct WorldInput {
  std::string name;  ///< Dotted path of a parameter, or name of a derived quantity.
  std::string unit;
  std::vector<double> values;  ///< [world] Value in `unit`.
  std::string meaning{};       ///< Meaning of a derived quantity; empty for a parameter.

  bool is_derived() const { return !meaning.empty(); }
};

/// The parameters that differ between worlds (draws of what all machines share and nobody knows) at a design
/// point, with their values.
std::vector<WorldInput> unknowns_of(const study::Study& study, std::int64_t point);

/// A condition of a rule, such as "friction.alpha > 1.4".
struct Condition {
  std::size_t input{0};
  bool above{false};
  double threshold{0.0};  ///< Threshold of the condition, halfway between the values of two worlds.
};

/// A rule on one or two parameters that separates bad worlds (draws of unknown parameters with which the goal
/// is missed) from the others. The parameters need not be the cause, because parameters that vary together
/// separate the worlds alike.
struct WorldRule {
  std::vector<Condition> conditions;
  /// True if the rule names (selects) worlds in which all conditions hold; false if one suffices.
  bool all{true};
  /// Conditions on other parameters that each hold in exactly the worlds that the rule names.
  std::vector<Condition> same{};
  std::int64_t bad{0};         ///< Number of bad worlds in all.
  std::int64_t bad_named{0};   ///< Number of bad worlds that the rule names (in which it holds).
  std::int64_t good{0};        ///< Number of good worlds in all.
  std::int64_t good_named{0};  ///< Number of good worlds that the rule names wrongly.
  /// Probability of such a rule if the worlds' rates did not depend on these parameters. It is twice the
  /// smaller of two p-values: for a rule that is as good, and for trends (Spearman) of the rates over the
  /// parameters of the rule that are as strong in its direction.
  double p_value{1.0};

  double error_rate() const {
    return static_cast<double>(bad - bad_named + good_named) / static_cast<double>(bad + good);
  }
};

/// Largest p-value at which a rule is reported.
inline constexpr double significance_of_rules = 0.05;

/// Finds the rule that separates the bad worlds (draws of unknown parameters with which the goal is missed)
/// best from the others.
///
///     for each input and each threshold between values of neighbouring worlds (31 quantiles of many):
///       error = mean of the proportions of bad worlds that are not named, and of others that are
///     one condition = that of the least error; of inputs with the same names the first, others in `same`
///     two conditions (and, or) take its place if they name at least two worlds fewer wrongly
///     p-value = by the same search on 399 permutations of the worlds' rates
///
/// @param rates [world] success rate or proportion in goal
/// @param bad [world] true if the rate is too low
/// @param seed seed of the permutations
/// @returns nothing if all worlds are bad or none is, or the p-value is above significance_of_rules
std::optional<WorldRule> find_rule(const std::vector<WorldInput>& inputs, const std::vector<double>& rates,
                                   const std::vector<bool>& bad, std::uint64_t seed);

/// Whether the rule holds in the world with this index.
bool names(const WorldRule& rule, const std::vector<WorldInput>& inputs, std::size_t world);

/// The rule as text: "friction.alpha > 1.4 1/s and friction.beta < 8e+04 1/rad".
std::string text_of(const WorldRule& rule, const std::vector<WorldInput>& inputs);

/// The condition as text: "friction.alpha > 1.4 1/s".
std::string text_of(const Condition& condition, const std::vector<WorldInput>& inputs);

}  // namespace zerocount::worlds
