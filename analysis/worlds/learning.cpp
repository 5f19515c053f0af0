#include "analysis/worlds/learning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/worlds/permutations.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::worlds {
namespace {

/// The other worlds that remain possible if `world` is the truth.
std::vector<std::size_t> possible_worlds(const std::vector<double>& values, std::size_t world,
                                         double precision) {
  std::vector<std::size_t> others(values.size());
  std::iota(others.begin(), others.end(), std::size_t{0});
  std::erase(others, world);
  const auto distance = [&](std::size_t other) { return std::abs(values[other] - values[world]); };
  std::stable_sort(others.begin(), others.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
  const auto near = std::ranges::count_if(
      others, [&](std::size_t other) { return distance(other) <= precision * std::abs(values[world]); });
  others.resize(
      std::min(others.size(), std::max<std::size_t>(static_cast<std::size_t>(near), min_possible_worlds)));
  return others;
}

/// [world] the other worlds that remain possible.
using PossibleWorlds = std::vector<std::vector<std::size_t>>;

Learned learned_of(const PossibleWorlds& possible_of, const std::vector<bool>& bad) {
  Learned learned;
  for (std::size_t world = 0; world < bad.size(); ++world) {
    const std::vector<std::size_t>& possible = possible_of[world];
    const auto of_them = std::ranges::count_if(possible, [&](std::size_t other) { return bad[other]; });
    if (of_them != 0 && of_them != std::ssize(possible)) {
      ++learned.open;
    } else if ((of_them != 0) != bad[world]) {
      ++learned.misjudged;
    } else {
      ++(bad[world] ? learned.decided_bad : learned.decided_good);
    }
  }
  return learned;
}

std::int64_t net_of(const Learned& learned) {
  return learned.decided() - learned.misjudged;
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
  std::vector<PossibleWorlds> possible(inputs.size());
  std::vector<Learned> learned;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t world = 0; world < bad.size(); ++world)
      possible[i].push_back(possible_worlds(inputs[i].values, world, precision));
    learned.push_back(learned_of(possible[i], bad));
    learned.back().input = i;
  }
  const random::RandomKey key = designs::random_key(seed, "worlds/learning");
  std::vector<std::int64_t> as_good(inputs.size());
  for (std::uint32_t number = 0; number < permutations; ++number) {
    std::vector<bool> permuted;
    for (const std::size_t world : permutation_of(bad.size(), key, number)) permuted.push_back(bad[world]);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      as_good[i] += net_of(learned_of(possible[i], permuted)) >= net_of(learned[i]) ? 1 : 0;
  }
  for (Learned& one : learned) {
    const auto tests = static_cast<double>(inputs.size());  // Bonferroni
    one.p_value = std::min(1.0, tests * p_value_of_permutations(as_good[one.input]));
  }
  std::stable_sort(learned.begin(), learned.end(),
                   [](const Learned& a, const Learned& b) { return net_of(a) > net_of(b); });
  return learned;
}

std::string_view record_of(std::string_view parameter) {
  static constexpr std::array<RecordedParameter, 14> records{{{"friction.k1", loading},
                                                              {"friction.k2", loading},
                                                              {"friction.beta", loading},
                                                              {"plant.inertia", step},
                                                              {"plant.presliding_damping", step},
                                                              {"friction.alpha", creep},
                                                              {"friction.lambda", creep},
                                                              {"friction.n", creep},
                                                              {"plant.sliding_damping", sliding},
                                                              {"friction.breakaway", sliding},
                                                              {"friction.coulomb_ratio", sliding},
                                                              {"friction.stribeck_velocity", sliding},
                                                              {"friction.sigma0", other_laws},
                                                              {"friction.sigma1", other_laws}}};
  const auto found = std::ranges::find(records, parameter, &RecordedParameter::parameter);
  return found == records.end() ? std::string_view{} : found->record;
}

}  // namespace zerocount::worlds
