#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/study.hpp"

/// A rule that separates bad worlds from the others.
namespace zerocount::worlds {

/// Number of permutations of a test.
inline constexpr int permutations = 399;

/// 0, 1, …, size − 1 in a random order (Fisher and Yates), with the numbers of one permutation.
std::vector<std::size_t> permutation_of(std::size_t size, const random::RandomKey& key, std::uint32_t number);

/// The p-value of a statistic that `as_good` permutations reach: (1 + as_good)/(1 + permutations).
inline double p_value_of_permutations(std::int64_t as_good) {
  return static_cast<double>(1 + as_good) / static_cast<double>(1 + permutations);
}

/// A quantity that differs between worlds: an unknown parameter, or a DerivedQuantity.
struct WorldInput {
  std::string name;  ///< Dotted path of a parameter, or name of a derived quantity.
  std::string unit;
  std::vector<double> values;  ///< [world] Value.
  std::string meaning{};       ///< Meaning of a derived quantity; empty for a parameter.

  bool is_derived() const { return !meaning.empty(); }
};

/// The unknown parameters of a study at a design point.
std::vector<WorldInput> unknowns_of(const study::Study& study, std::int64_t point);

/// A condition of a rule, such as "friction.alpha > 1.4".
struct Condition {
  std::size_t input{0};
  bool above{false};
  double threshold{0.0};  ///< Threshold halfway between the values of two worlds.
};

/// A rule on one or two parameters that separates bad worlds from the others. The parameters need not be the
/// cause, because parameters that vary together separate the worlds alike.
struct WorldRule {
  std::vector<Condition> conditions;
  /// True if the rule names worlds in which all conditions hold; false if one suffices.
  bool all{true};
  /// Conditions on other inputs. Each of them alone names the same worlds.
  std::vector<Condition> same{};
  std::int64_t bad{0};         ///< Number of bad worlds.
  std::int64_t bad_named{0};   ///< Number of bad worlds that the rule names.
  std::int64_t good{0};        ///< Number of other worlds.
  std::int64_t good_named{0};  ///< Number of other worlds that the rule names wrongly.
  /// Probability of such a rule if the worlds' rates did not depend on these parameters. It is twice the
  /// smaller of two p-values: for a rule that is as good, and for trends (Spearman) of the rates over the
  /// parameters of the rule that are as strong in its direction.
  double p_value{1.0};

  double error_rate() const {
    return static_cast<double>(bad - bad_named + good_named) / static_cast<double>(bad + good);
  }
};

/// Largest p-value of a rule that is reported.
inline constexpr double significance_of_rules = 0.05;

/// Finds the rule that separates the bad worlds best.
///
///     for each input and each threshold between values of neighbouring worlds (31 quantiles of many):
///       error = mean of the proportions of bad worlds that are not named, and of others that are
///     one condition = that of the least error; of inputs with the same names the first, others in `same`
///     two conditions (and, or) take its place if they name at least two worlds fewer wrongly
///     p-value = by the same search on 399 permutations of the worlds' rates
///
/// @param rates [world] @param bad [world] those with rates too low @param seed of the permutations
/// @returns nothing if all worlds are bad or none is, or the p-value is above significance_of_rules
std::optional<WorldRule> find_rule(const std::vector<WorldInput>& inputs, const std::vector<double>& rates,
                                   const std::vector<bool>& bad, std::uint64_t seed);

/// Whether the rule names the world.
bool names(const WorldRule& rule, const std::vector<WorldInput>& inputs, std::size_t world);

/// "friction.alpha > 1.4 1/s and friction.beta < 8e+04 1/rad".
std::string text_of(const WorldRule& rule, const std::vector<WorldInput>& inputs);

/// "friction.alpha > 1.4 1/s".
std::string text_of(const Condition& condition, const std::vector<WorldInput>& inputs);

}  // namespace zerocount::worlds
