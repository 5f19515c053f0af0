#include "analysis/trials/worlds/world_rule.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/study/group_inputs.hpp"

namespace zerocount::worlds {

std::vector<std::size_t> permutation_of(std::size_t size, const random::RandomKey& key,
                                        std::uint32_t number) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = size - 1; i > 0; --i) {
    const double u =
        random::open_uniform(random::random_bits({.key = key, .stream = number}, i, random::Draw::trial));
    std::swap(order[i], order[static_cast<std::size_t>(u * static_cast<double>(i + 1))]);
  }
  return order;
}

namespace {

constexpr std::size_t max_thresholds = 31;
constexpr std::size_t max_inputs_in_pairs = 8;
constexpr std::int64_t worlds_worth_a_condition = 2;

using Labels = std::vector<std::uint8_t>;  ///< [world] 1 if the world is bad (misses the goal), otherwise 0.
using Conditions = std::vector<Condition>;

/// [world] The thresholds that are tried for one parameter, and the interval between them in which each
/// world's value lies.
struct Bins {
  std::vector<double> thresholds;  ///< Thresholds in ascending order.
  std::vector<std::size_t> of_world;
};

Bins bins_of(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  Bins bins;
  const std::size_t gaps = sorted.size() - 1;
  const std::size_t count = std::min(gaps, max_thresholds);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t gap = count == gaps ? i : (i + 1) * gaps / (count + 1);
    const double between = std::midpoint(sorted[gap], sorted[gap + 1]);
    if (sorted[gap] < between && between < sorted[gap + 1]) bins.thresholds.push_back(between);
  }
  for (const double value : values) {
    const auto above = std::upper_bound(bins.thresholds.begin(), bins.thresholds.end(), value);
    bins.of_world.push_back(static_cast<std::size_t>(above - bins.thresholds.begin()));
  }
  return bins;
}

/// Numbers of bad and of good worlds that satisfy a rule.
struct Named {
  std::int64_t bad{0};
  std::int64_t good{0};
};

/// A rule that is tried, and how well it separates bad worlds from the others. If it has a single condition,
/// both parameters are the same.
struct Candidate {
  std::vector<Condition> conditions;
  bool all{true};
  Named named;
  /// Mean of two proportions: of bad worlds that do not satisfy the rule, and of good worlds that do.
  double error{1.0};
  std::int64_t wrong{0};

  bool is_better_than(const Candidate& other) const {
    return std::pair(error, wrong) < std::pair(other.error, other.wrong);
  }
};

class Search {
 public:
  Search(const std::vector<Bins>& bins, const Labels& bad) : bins_(bins), bad_(bad) {
    for (const std::uint8_t one : bad) (one != 0 ? all_.bad : all_.good) += 1;
    for (std::size_t input = 0; input < bins_.size(); ++input)
      singles_.emplace_back(best_single(input), input);
    std::stable_sort(singles_.begin(), singles_.end(),
                     [](const auto& a, const auto& b) { return a.first.is_better_than(b.first); });
  }

  Candidate best_of_one_condition() const { return singles_.front().first; }

  /// The best single condition on each parameter, the best first.
  std::vector<Condition> single_conditions() const {
    std::vector<Condition> conditions;
    for (const auto& [single, input] : singles_) {
      if (!single.conditions.empty()) conditions.push_back(single.conditions.front());
    }
    return conditions;
  }

  Candidate best() {
    const Candidate single = best_of_one_condition();
    Candidate pair;
    const std::size_t count = std::min(singles_.size(), max_inputs_in_pairs);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) try_pair(singles_[i].second, singles_[j].second, pair);
    }
    const bool worth_it = !pair.conditions.empty() && pair.error < single.error &&
                          pair.wrong + worlds_worth_a_condition <= single.wrong;
    return worth_it ? pair : single;
  }

 private:
  /// Replaces `best` by the rule with these worlds and conditions, if that is better.
  /// @param named worlds that satisfy the rule
  /// @param all whether all conditions must hold
  /// @param conditions function that makes the conditions of the rule
  void consider(Candidate& best, const Named& named, bool all, const auto& conditions) const {
    Candidate candidate{{}, all, named, 1.0, all_.bad - named.bad + named.good};
    candidate.error = 0.5 * (static_cast<double>(all_.bad - named.bad) / static_cast<double>(all_.bad) +
                             static_cast<double>(named.good) / static_cast<double>(all_.good));
    if (!candidate.is_better_than(best)) return;
    candidate.conditions = conditions();
    best = std::move(candidate);
  }

  Candidate best_single(std::size_t input) const {
    const Bins& bins = bins_[input];
    std::vector<Named> in_bin(bins.thresholds.size() + 1);
    for (std::size_t world = 0; world < bad_.size(); ++world) {
      Named& one = in_bin[bins.of_world[world]];
      (bad_[world] != 0 ? one.bad : one.good) += 1;
    }
    Candidate best;
    Named below;
    for (std::size_t i = 0; i < bins.thresholds.size(); ++i) {
      below.bad += in_bin[i].bad;
      below.good += in_bin[i].good;
      for (const bool above : {false, true}) {
        const Named named = above ? Named{all_.bad - below.bad, all_.good - below.good} : below;
        consider(best, named, true, [&] { return Conditions{{input, above, bins.thresholds[i]}}; });
      }
    }
    return best;
  }

  /// Tries rules with a condition on each of two parameters: the bad worlds are those in one quadrant of the
  /// two thresholds, or in the other three. Updates `best`.
  void try_pair(std::size_t first, std::size_t second, Candidate& best) {
    const Bins& a = bins_[first];
    const Bins& b = bins_[second];
    const std::size_t width = b.thresholds.size() + 2;
    // [i][j] worlds below threshold i of the first parameter and below threshold j of the second.
    below_.assign((a.thresholds.size() + 2) * width, {});
    for (std::size_t world = 0; world < bad_.size(); ++world) {
      Named& one = below_[(a.of_world[world] + 1) * width + b.of_world[world] + 1];
      (bad_[world] != 0 ? one.bad : one.good) += 1;
    }
    for (std::size_t i = 1; i < a.thresholds.size() + 2; ++i) {
      for (std::size_t j = 1; j < width; ++j) {
        Named& one = below_[i * width + j];
        const auto add = [&](std::size_t at, std::int64_t sign) {
          one.bad += sign * below_[at].bad;
          one.good += sign * below_[at].good;
        };
        add((i - 1) * width + j, 1);
        add(i * width + j - 1, 1);
        add((i - 1) * width + j - 1, -1);
      }
    }
    const std::size_t last = a.thresholds.size() + 1;
    for (std::size_t i = 0; i < a.thresholds.size(); ++i) {
      for (std::size_t j = 0; j < b.thresholds.size(); ++j) {
        const Named both = below_[(i + 1) * width + j + 1];
        const Named in_a = below_[(i + 1) * width + width - 1];
        const Named in_b = below_[last * width + j + 1];
        for (const bool above_a : {false, true}) {
          for (const bool above_b : {false, true}) {
            const auto quadrant = [&](std::int64_t Named::*of) {
              const std::int64_t row = above_a ? in_b.*of - both.*of : both.*of;
              const std::int64_t rest = above_a ? all_.*of - in_a.*of : in_a.*of;
              return above_b ? rest - row : row;
            };
            const Named named{quadrant(&Named::bad), quadrant(&Named::good)};
            const Named others{all_.bad - named.bad, all_.good - named.good};
            const auto conditions = [&](bool inside) {
              return Conditions{{first, above_a == inside, a.thresholds[i]},
                                {second, above_b == inside, b.thresholds[j]}};
            };
            consider(best, named, true, [&] { return conditions(true); });
            consider(best, others, false, [&] { return conditions(false); });
          }
        }
      }
    }
  }

  const std::vector<Bins>& bins_;
  const Labels& bad_;
  Named all_;
  std::vector<std::pair<Candidate, std::size_t>>
      /// Best rule with one condition on each parameter, and the parameter's index; the best first.
      singles_;
  std::vector<Named> below_;
};

/// Ranks of values minus the mean of all ranks, scaled to a sum of squares of 1. Ties have their mean rank.
std::vector<double> scaled_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i)
      ranks[order[i]] =
          0.5 * static_cast<double>(first + end - 1) - 0.5 * static_cast<double>(order.size() - 1);
    first = end;
  }
  const double norm = std::sqrt(std::inner_product(ranks.begin(), ranks.end(), ranks.begin(), 0.0));
  for (double& rank : ranks) rank = norm > 0.0 ? rank / norm : 0.0;
  return ranks;
}

/// Values and rates of the worlds in the form that the search for a rule needs.
struct RankedWorlds {
  std::vector<Bins> bins;  ///< [parameter] Thresholds, and the interval between them of each world.
  std::vector<std::vector<double>> inputs;  ///< [parameter][world] Scaled ranks of the worlds' values.
  std::vector<double> rates;                ///< [world] Scaled ranks of the worlds' rates.
  Labels bad;
};

double correlation(const std::vector<double>& input, const std::vector<double>& rates,
                   const std::vector<std::size_t>& order) {
  double sum = 0.0;
  for (std::size_t world = 0; world < order.size(); ++world) sum += input[world] * rates[order[world]];
  return sum;
}

/// Trend of the worlds' rates towards the side of the parameter on which the condition holds: Spearman's rank
/// correlation, positive if the rates fall towards that side.
double trend_of(const Condition& condition, const RankedWorlds& worlds) {
  std::vector<std::size_t> same(worlds.rates.size());
  std::iota(same.begin(), same.end(), std::size_t{0});
  const double rho = correlation(worlds.inputs[condition.input], worlds.rates, same);
  return condition.above ? -rho : rho;
}

/// Results of the same search after random permutations of the worlds' rates, for p-values.
struct Permuted {
  std::vector<Candidate> rules;
  /// [permutation] Largest magnitude of Spearman's correlation between rates and any parameter.
  std::vector<double> strongest_trends;

  Permuted(const RankedWorlds& worlds, std::uint64_t seed) {
    const random::RandomKey key = designs::random_key(seed, "worlds/permutations");
    for (std::uint32_t i = 0; i < permutations; ++i) {
      const std::vector<std::size_t> order = permutation_of(worlds.bad.size(), key, i);
      Labels bad;
      for (const std::size_t world : order) bad.push_back(worlds.bad[world]);
      rules.push_back(Search(worlds.bins, bad).best());
      double strongest = 0.0;
      for (const std::vector<double>& input : worlds.inputs)
        strongest = std::max(strongest, std::abs(correlation(input, worlds.rates, order)));
      strongest_trends.push_back(strongest);
    }
  }

  double p_value_of(const Candidate& rule, const RankedWorlds& worlds) const {
    const double by_rules = p_value_of_permutations(
        std::ranges::count_if(rules, [&](const Candidate& one) { return !rule.is_better_than(one); }));
    double by_trends = 0.0;
    for (const Condition& condition : rule.conditions) {
      const double trend = trend_of(condition, worlds);
      by_trends = std::max(by_trends, p_value_of_permutations(std::ranges::count_if(
                                          strongest_trends, [&](double one) { return one >= trend; })));
    }
    return std::min(1.0, 2.0 * std::min(by_rules, by_trends));
  }
};

bool holds(const Condition& condition, double value) {
  return condition.above ? value > condition.threshold : value < condition.threshold;
}

/// Whether both conditions hold in the same worlds.
bool names_alike(const Condition& a, const Condition& b, const std::vector<WorldInput>& inputs) {
  const std::vector<double>& first = inputs[a.input].values;
  const std::vector<double>& second = inputs[b.input].values;
  return std::ranges::equal(first, second, [&](double x, double y) { return holds(a, x) == holds(b, y); });
}

/// The conditions on other parameters that hold in the same worlds as the only condition of the rule; empty
/// if the rule has two.
/// @param singles best condition on each parameter
std::vector<Condition> same_as(const WorldRule& rule, std::vector<Condition> singles,
                               const std::vector<WorldInput>& inputs) {
  if (rule.conditions.size() != 1) return {};
  const Condition& one = rule.conditions.front();
  std::erase_if(singles, [&](const Condition& other) {
    return other.input == one.input || !names_alike(one, other, inputs);
  });
  return singles;
}

/// The threshold as text, with as few digits as possible so that every value stays on its side.
std::string number_text(double threshold, const std::vector<double>& values) {
  for (int digits = 2; digits < 17; ++digits) {
    const double rounded = text::round_to_digits(threshold, digits);
    const bool same = std::ranges::all_of(
        values, [&](double value) { return (value > threshold) == (value > rounded) && value != rounded; });
    if (same) return fmt::format("{:.{}g}", threshold, digits);
  }
  return fmt::format("{}", threshold);
}

}  // namespace

std::optional<WorldRule> find_rule(const std::vector<WorldInput>& inputs, const std::vector<double>& rates,
                                   const std::vector<bool>& bad, std::uint64_t seed) {
  const std::int64_t bad_worlds = std::count(bad.begin(), bad.end(), true);
  const std::int64_t good_worlds = std::ssize(bad) - bad_worlds;
  if (inputs.empty() || bad_worlds == 0 || good_worlds == 0) return std::nullopt;
  RankedWorlds worlds{
      .bins = {}, .inputs = {}, .rates = scaled_ranks(rates), .bad = {bad.begin(), bad.end()}};
  for (const WorldInput& input : inputs) {
    worlds.bins.push_back(bins_of(input.values));
    worlds.inputs.push_back(scaled_ranks(input.values));
  }
  Search search(worlds.bins, worlds.bad);
  const Permuted permuted(worlds, seed);
  for (const Candidate& found : {search.best(), search.best_of_one_condition()}) {
    if (found.conditions.empty()) continue;
    WorldRule rule{.conditions = found.conditions,
                   .all = found.all,
                   .bad = bad_worlds,
                   .bad_named = found.named.bad,
                   .good = good_worlds,
                   .good_named = found.named.good,
                   .p_value = permuted.p_value_of(found, worlds)};
    if (rule.p_value > significance_of_rules) continue;
    rule.same = same_as(rule, search.single_conditions(), inputs);
    return rule;
  }
  return std::nullopt;
}

bool names(const WorldRule& rule, const std::vector<WorldInput>& inputs, std::size_t world) {
  const auto in_world = [&](const Condition& condition) {
    return holds(condition, inputs[condition.input].values[world]);
  };
  return rule.all ? std::ranges::all_of(rule.conditions, in_world)
                  : std::ranges::any_of(rule.conditions, in_world);
}

std::string text_of(const Condition& condition, const std::vector<WorldInput>& inputs) {
  const WorldInput& input = inputs[condition.input];
  return fmt::format("{} {} {}{}", input.name, condition.above ? '>' : '<',
                     number_text(condition.threshold, input.values),
                     input.unit == "1" ? "" : " " + input.unit);
}

std::string text_of(const WorldRule& rule, const std::vector<WorldInput>& inputs) {
  std::vector<std::string> conditions;
  for (const Condition& condition : rule.conditions) conditions.push_back(text_of(condition, inputs));
  return fmt::format("{}", fmt::join(conditions, rule.all ? " and " : " or "));
}

std::vector<WorldInput> unknowns_of(const study::Study& study, std::int64_t point) {
  std::vector<WorldInput> unknowns;
  for (study::WorldValues& one : study::world_values(study, point))
    unknowns.push_back({std::move(one.name), std::move(one.unit), std::move(one.values)});
  return unknowns;
}

}  // namespace zerocount::worlds
