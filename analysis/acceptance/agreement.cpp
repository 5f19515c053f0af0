#include "analysis/acceptance/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "analysis/statistics/clusters/observed_test.hpp"
#include "core/random/number_source.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::acceptance {
namespace {

constexpr int draws = 9999;

/// How many of `wanted` random moves of the machine meet the requirement, without replacement.
std::int64_t thinned(const statistics::RigMoves& machine, std::int64_t wanted,
                     random::NumberSource& numbers) {
  std::int64_t left = machine.moves;
  std::int64_t met = machine.met;
  for (std::int64_t i = 0; i < wanted; ++i, --left)
    if (numbers.uniform() * static_cast<double>(left) < static_cast<double>(met)) --met;
  return machine.met - met;
}

std::size_t below(std::size_t count, random::NumberSource& numbers) {
  return std::min(count - 1, static_cast<std::size_t>(numbers.uniform() * static_cast<double>(count)));
}

/// 1/(N + R over N), the probability of one choice of N.
double chance_of_a_choice(std::size_t measured, std::size_t simulated) {
  double chance = 1.0;
  for (std::size_t i = 1; i <= measured; ++i)
    chance *= static_cast<double>(i) / static_cast<double>(simulated + i);
  return chance;
}

/// Moves that meet the requirement of as many of the machines as are measured, chosen at random from those
/// from `first` on: the measured ones come before the simulated ones.
std::int64_t drawn(std::span<const std::int64_t> met, std::int64_t moves,
                   std::span<const statistics::RigMoves> simulated, std::size_t first,
                   std::vector<std::size_t>& order, random::NumberSource& numbers) {
  const std::size_t measured = met.size();
  order.resize(measured + simulated.size() - first);
  std::iota(order.begin(), order.end(), first);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < measured; ++i) {
    std::swap(order[i], order[i + below(order.size() - i, numbers)]);
    const std::size_t machine = order[i];
    sum += machine < measured ? met[machine] : thinned(simulated[machine - measured], moves, numbers);
  }
  return sum;
}

bool have_as_many_moves(std::span<const statistics::RigMoves> machines) {
  return std::ranges::all_of(machines,
                             [&](const statistics::RigMoves& one) { return one.moves == machines[0].moves; });
}

double rank_test_of(std::int64_t met, std::int64_t moves, std::span<const statistics::RigMoves> simulated) {
  std::vector<std::int64_t> successes;
  for (const statistics::RigMoves& machine : simulated) successes.push_back(machine.met);
  return statistics::rig_rank_test({met, moves}, successes, simulated[0].moves).p;
}

}  // namespace

Agreement agreement_of(std::span<const std::int64_t> met, std::int64_t moves,
                       std::span<const statistics::RigMoves> simulated, std::uint64_t seed) {
  random::NumberSource numbers(designs::random_key(seed, "acceptance"));
  Agreement agreement{.moves = moves, .met = std::accumulate(met.begin(), met.end(), std::int64_t{0})};
  std::vector<std::size_t> order;
  int at_most = 0;
  int at_least = 0;
  std::vector<std::int64_t> predicted;
  for (int i = 0; i < draws; ++i) {
    const std::int64_t any = drawn(met, moves, simulated, 0, order, numbers);
    at_most += any <= agreement.met ? 1 : 0;
    at_least += any >= agreement.met ? 1 : 0;
    // As many simulated machines as are measured, or all where there are fewer.
    predicted.push_back(drawn(met.first(std::min(met.size(), simulated.size())), moves, simulated,
                              std::min(met.size(), simulated.size()), order, numbers));
  }
  const double low = (1.0 + at_most) / (draws + 1.0);
  const double high = (1.0 + at_least) / (draws + 1.0);
  agreement.p = std::min(1.0, 2.0 * std::min(low, high));
  agreement.is_lower = low < high;
  agreement.lowest_p =
      std::min(1.0, 2.0 * std::max(1.0 / (draws + 1.0), chance_of_a_choice(met.size(), simulated.size())));
  if (met.size() == 1 && have_as_many_moves(simulated)) agreement.p = rank_test_of(met[0], moves, simulated);
  std::ranges::sort(predicted);
  const auto of_moves =
      static_cast<double>(moves) * static_cast<double>(std::min(met.size(), simulated.size()));
  agreement.predicted = {static_cast<double>(predicted[draws / 40]) / of_moves,
                         static_cast<double>(predicted[draws - 1 - draws / 40]) / of_moves};
  return agreement;
}

}  // namespace zerocount::acceptance
