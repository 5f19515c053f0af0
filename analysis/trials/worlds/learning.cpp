#include "analysis/trials/worlds/learning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "analysis/trials/worlds/derived_quantities.hpp"
#include "analysis/trials/worlds/world_rule.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::worlds {
namespace {

/// The worlds (possible values of what nobody knows) that a measurement of one parameter leaves possible if a
/// certain world is the true one: a range of neighbours in the order of the parameter's values.
struct Possible {
  std::size_t first;
  std::size_t end;  ///< End of the range, exclusive. The range includes the true world itself.
};

/// The worlds (possible values of what nobody knows) sorted by one parameter and, for each, those that a
/// measurement of this parameter leaves possible if it is the true one.
struct Neighbours {
  std::vector<std::size_t> order;  ///< [place in the order] Index of the world at this place.
  std::vector<Possible> possible;  ///< [place in the order] Range of the places whose worlds remain possible.

  Neighbours(const std::vector<double>& values, double precision) : order(values.size()) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t world) { return values[world]; });
    for (std::size_t place = 0; place < order.size(); ++place)
      possible.push_back(around(values, place, precision));
  }

 private:
  Possible around(const std::vector<double>& values, std::size_t place, double precision) const {
    const auto value = [&](std::size_t at) { return values[order[at]]; };
    const double here = value(place);
    const double near = precision * std::abs(here);
    const auto of_place = [&](std::size_t world) { return values[world]; };
    Possible found{
        static_cast<std::size_t>(std::ranges::lower_bound(order, here - near, {}, of_place) - order.begin()),
        static_cast<std::size_t>(std::ranges::upper_bound(order, here + near, {}, of_place) - order.begin())};
    const std::size_t wanted = std::min(order.size(), min_possible_worlds + 1);
    while (found.end - found.first < wanted) {
      const bool downwards = found.end == order.size() ||
                             (found.first > 0 && here - value(found.first - 1) <= value(found.end) - here);
      downwards ? --found.first : ++found.end;
    }
    return found;
  }
};

Learned learned_of(const Neighbours& neighbours, const std::vector<bool>& bad) {
  std::vector<std::size_t> bad_before(1, 0);
  for (const std::size_t world : neighbours.order)
    bad_before.push_back(bad_before.back() + (bad[world] ? 1 : 0));
  Learned learned;
  for (std::size_t place = 0; place < bad.size(); ++place) {
    const auto [first, end] = neighbours.possible[place];
    const bool is_bad = bad[neighbours.order[place]];
    const std::size_t others = end - first - 1;
    const std::size_t bad_others = bad_before[end] - bad_before[first] - (is_bad ? 1 : 0);
    if (bad_others != 0 && bad_others != others) {
      ++learned.open;
    } else if ((bad_others != 0) != is_bad) {
      ++(is_bad ? learned.missed_bad : learned.rejected_good);
    } else {
      ++(is_bad ? learned.decided_bad : learned.decided_good);
    }
  }
  return learned;
}

std::int64_t net_of(const Learned& learned) {
  return learned.decided() - learned.misjudged();
}

/// Proportion of the values that are at least as large as `value`, which is one of them.
/// @param sorted values in ascending order
double proportion_from(const std::vector<std::int64_t>& sorted, std::int64_t value) {
  return static_cast<double>(sorted.end() - std::ranges::lower_bound(sorted, value)) /
         static_cast<double>(sorted.size());
}

/// p-value of each input (unknown parameter), see Learned::p_value.
/// @param nets [input][data set] number of decided minus misjudged worlds; data set 0 is the observed one,
/// the others are permutations
std::vector<double> p_values_of(const std::vector<std::vector<std::int64_t>>& nets) {
  std::vector<double> of_observed;
  std::vector<double> smallest(1 + permutations, 1.0);
  for (const std::vector<std::int64_t>& of_input : nets) {
    std::vector<std::int64_t> sorted = of_input;
    std::ranges::sort(sorted);
    of_observed.push_back(proportion_from(sorted, of_input.front()));
    for (std::size_t set = 0; set < of_input.size(); ++set)
      smallest[set] = std::min(smallest[set], proportion_from(sorted, of_input[set]));
  }
  for (double& p : of_observed)
    p = static_cast<double>(std::ranges::count_if(smallest, [&](double one) { return one <= p; })) /
        static_cast<double>(smallest.size());
  return of_observed;
}

struct RecordedParameter {
  std::string_view parameter;
  std::string_view record;
};

constexpr std::string_view loading = "slow loading and unloading before it slides (identify)";
constexpr std::string_view step = "a step of the torque, then a hold (identify)";
constexpr std::string_view creep = "constant torques at two levels, each held until it creeps (identify)";
constexpr std::string_view sliding = "strokes that slide (identify --sliding)";
constexpr std::string_view other_laws = "loading before it slides (identify --model)";

}  // namespace

std::vector<Learned> what_to_learn(const std::vector<WorldInput>& inputs, const std::vector<bool>& bad,
                                   double precision, std::uint64_t seed) {
  std::vector<Neighbours> neighbours;
  std::vector<Learned> learned;
  std::vector<std::vector<std::int64_t>> nets(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    neighbours.emplace_back(inputs[i].values, precision);
    learned.push_back(learned_of(neighbours[i], bad));
    learned.back().input = i;
    nets[i].push_back(net_of(learned.back()));
  }
  const random::RandomKey key = designs::random_key(seed, "worlds/learning");
  for (std::uint32_t number = 0; number < permutations; ++number) {
    std::vector<bool> permuted;
    for (const std::size_t world : permutation_of(bad.size(), key, number)) permuted.push_back(bad[world]);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      nets[i].push_back(net_of(learned_of(neighbours[i], permuted)));
  }
  const std::vector<double> p_values = p_values_of(nets);
  for (Learned& one : learned) one.p_value = p_values[one.input];
  std::ranges::stable_sort(learned, std::greater<>(), net_of);
  return learned;
}

std::string_view record_of(std::string_view parameter) {
  static constexpr std::array<RecordedParameter, 24> records{
      {{parameter::friction::k1, loading},
       {parameter::friction::k2, loading},
       {parameter::friction::beta, loading},
       {parameter::plant::inertia, step},
       {parameter::plant::presliding_damping, step},
       {parameter::friction::alpha, creep},
       {parameter::friction::lambda, creep},
       {parameter::friction::n, creep},
       {parameter::friction::measured::initial_stiffness, loading},
       {parameter::friction::measured::secant_stiffness, loading},
       {parameter::friction::measured::secant_travel, loading},
       {parameter::friction::measured::final_stiffness, loading},
       {parameter::friction::measured::breakaway, sliding},
       {parameter::friction::measured::breakaway_travel, sliding},
       {parameter::friction::measured::creep::torque, creep},
       {parameter::friction::measured::creep::extension, creep},
       {parameter::friction::measured::creep::rate, creep},
       {parameter::friction::measured::creep::exponent, creep},
       {parameter::plant::sliding_damping, sliding},
       {parameter::friction::breakaway, sliding},
       {parameter::friction::coulomb_ratio, sliding},
       {parameter::friction::stribeck_velocity, sliding},
       {parameter::friction::sigma0, other_laws},
       {parameter::friction::sigma1, other_laws}}};
  const auto derived = std::ranges::find(derived_quantities(), parameter, &DerivedQuantity::name);
  if (derived != derived_quantities().end()) parameter = derived->parameter;
  const auto found = std::ranges::find(records, parameter, &RecordedParameter::parameter);
  return found == records.end() ? std::string_view{} : found->record;
}

}  // namespace zerocount::worlds
