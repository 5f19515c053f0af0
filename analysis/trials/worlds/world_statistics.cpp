#include "analysis/trials/worlds/world_statistics.hpp"

#include <algorithm>
#include <utility>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"

namespace zerocount::worlds {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// Sets the worst, the median and the best of the worlds' rates.
void sort_out(RatesOfWorlds& rates) {
  std::vector<double> values;
  for (const goal::BoundedProportion& world : rates.worlds) values.push_back(world.value);
  rates.worst = static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
  rates.best = static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
  rates.median = median_of(std::move(values));
}

/// The rate of each world (draw of what all machines share) by which the goal is judged: of machines or of
/// moves that meet it.
RatesOfWorlds judged_rates(const goal::Question& question, const goal::Verdict& verdict) {
  RatesOfWorlds rates;
  for (const goal::WorldVerdict& world : verdict.worlds) rates.worlds.push_back(judged_rate(question, world));
  rates.lowest = judged_rate(question, verdict);
  sort_out(rates);
  rates.worst = goal::worst_worlds_first(*question.goal(), verdict).front();
  return rates;
}

/// [world] Worst status of the world over all goals in all settings.
std::vector<goal::Status> worst_statuses(const goal::Verdict& verdict) {
  std::vector<goal::Status> worst(verdict.worlds.size(), goal::Status::met);
  for (const goal::ClaimVerdict& claim : verdict.claims) {
    for (std::size_t world = 0; world < worst.size(); ++world)
      worst[world] = std::min(worst[world], claim.worlds[world].status,
                              [](auto a, auto b) { return goal::rank_of(a) < goal::rank_of(b); });
  }
  return worst;
}

/// [world] Whether the observed rate of the world is below what some goal requires, in any setting.
std::vector<bool> short_of_claims(const goal::Question& question, const goal::Verdict& verdict) {
  std::vector<bool> bad(verdict.worlds.size(), false);
  for (const goal::ClaimVerdict& claim : verdict.claims) {
    const study::Goal& goal = *question.parts[claim.goal].goal;
    const double wanted = study::demanded_proportion(goal);
    for (std::size_t world = 0; world < bad.size(); ++world) {
      const goal::WorldVerdict& one = claim.worlds[world];
      if ((goal.machines ? one.machines.value : one.moves.value) < wanted) bad[world] = true;
    }
  }
  return bad;
}

/// [world] Whether the world is shown to have a lower success rate than the median world.
/// @param confidence confidence for all worlds together (Bonferroni)
std::vector<bool> below_median(const PointWorlds& point, const std::vector<measures::MoveCounts>& succeeded,
                               double confidence) {
  std::vector<bool> bad;
  const double each = statistics::confidence_of_each(confidence, succeeded.size());
  for (const measures::MoveCounts& world : succeeded)
    bad.push_back(statistics::clustered_at_most(measures::clusters_of(world), each) < point.success.median);
  return bad;
}

}  // namespace

RatesOfWorlds rates_of_worlds(const std::vector<measures::MoveCounts>& worlds, double confidence) {
  RatesOfWorlds rates;
  const double each = statistics::confidence_of_each(confidence, worlds.size());
  for (const measures::MoveCounts& world : worlds) {
    const statistics::ClusterSums sums = measures::clusters_of(world);
    const double value = statistics::rate(world.met, world.moves);
    const double low = statistics::clustered_at_least(sums, each);
    const double high = statistics::clustered_at_most(sums, each);
    const goal::BoundedProportion one{value, low, high};
    rates.lowest = rates.worlds.empty() ? one : goal::lowest(rates.lowest, one);
    rates.worlds.push_back({value, statistics::clustered_at_least(sums, confidence),
                            statistics::clustered_at_most(sums, confidence)});
  }
  sort_out(rates);
  return rates;
}

PointWorlds point_worlds(const measures::PointSummary& point, const goal::Question& all,
                         std::span<const WorldInput> inputs, std::uint64_t seed, double confidence,
                         std::size_t points) {
  PointWorlds result;
  const std::vector<measures::MoveCounts> succeeded = point.trials_of_groups.value().succeeded.by_world();
  result.success = rates_of_worlds(succeeded, confidence);
  if (all.goal()) result.goal = verdict_on(all, point, points);
  const goal::Question question = result.goal ? only(all, result.goal->goal) : all;
  result.asked = result.goal ? judged_rates(question, *result.goal) : result.success;
  if (result.goal) {
    result.statuses = worst_statuses(*result.goal);
    result.bad = short_of_claims(all, *result.goal);
  } else {
    result.bad = below_median(result, succeeded, confidence);
  }
  std::vector<double> rates;
  for (const goal::BoundedProportion& world : result.asked.worlds) rates.push_back(world.value);
  result.rule = find_rule({inputs.begin(), inputs.end()}, rates, result.bad, seed);
  return result;
}

}  // namespace zerocount::worlds
