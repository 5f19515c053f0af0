#include "analysis/worlds/world_statistics.hpp"

#include <algorithm>
#include <utility>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::worlds {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

bool is_bad(const study::Goal& goal, const goal::WorldVerdict& world) {
  return goal.machines ? world.machines.value < *goal.machines : world.moves.value < goal.moves;
}

}  // namespace

RatesOfWorlds rates_of_worlds(const measures::MoveCounts& counts, double confidence) {
  RatesOfWorlds rates;
  std::vector<double> values;
  const double each = statistics::confidence_of_each(confidence, static_cast<std::size_t>(counts.worlds));
  for (const measures::MoveCounts& world : measures::in_worlds(counts)) {
    const statistics::ClusterSums sums = measures::clusters_of(world);
    const double value = statistics::rate(world.met, world.moves);
    const double low = statistics::clustered_at_least(sums, each);
    const double high = statistics::clustered_at_most(sums, each);
    const goal::BoundedProportion one{value, low, high};
    rates.lowest = values.empty() ? one : goal::lowest(rates.lowest, one);
    values.push_back(value);
    rates.worlds.push_back({value, statistics::clustered_at_least(sums, confidence),
                            statistics::clustered_at_most(sums, confidence)});
  }
  rates.worst = static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
  rates.best = static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
  rates.median = median_of(std::move(values));
  return rates;
}

PointWorlds point_worlds(const measures::PointSummary& point, const std::optional<study::Goal>& goal,
                         std::span<const WorldInput> inputs, std::uint64_t seed, double confidence,
                         std::size_t points) {
  PointWorlds result;
  const measures::MoveCounts& succeeded = point.worlds.value().succeeded;
  result.success = rates_of_worlds(succeeded, confidence);
  if (goal && point.goal) result.goal = goal::judge_goal(*goal, *point.goal, points);
  const double each = statistics::confidence_of_each(confidence, static_cast<std::size_t>(succeeded.worlds));
  const std::vector<measures::MoveCounts> counts = measures::in_worlds(succeeded);
  for (std::size_t world = 0; world < counts.size(); ++world) {
    result.bad.push_back(result.goal ? is_bad(*goal, result.goal->worlds[world])
                                     : statistics::clustered_at_most(measures::clusters_of(counts[world]),
                                                                     each) < result.success.median);
  }
  std::vector<double> rates;
  for (std::size_t world = 0; world < counts.size(); ++world) {
    const goal::BoundedProportion& rate = !result.goal     ? result.success.worlds[world]
                                          : goal->machines ? result.goal->worlds[world].machines
                                                           : result.goal->worlds[world].moves;
    rates.push_back(rate.value);
  }
  result.rule = find_rule({inputs.begin(), inputs.end()}, rates, result.bad, seed);
  return result;
}

}  // namespace zerocount::worlds
