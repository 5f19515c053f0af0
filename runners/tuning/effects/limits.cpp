#include "runners/tuning/effects/limits.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "runners/tuning/effects/idealisations.hpp"

namespace zerocount::tuning {
namespace {

void name_claims(const EffectRuns& runs, Limit& limit) {
  const study::Study& study = runs.study();
  const ClaimPlace worst = place_of_claim(study, limit.estimate.worst);
  limit.goal = goal_name(study, worst);
  limit.condition = condition_name(study, worst);
  limit.rates.emplace();
  for (std::size_t claim = 0; claim < limit.estimate.rates.size(); ++claim) {
    const ClaimPlace place = place_of_claim(study, claim);
    const std::optional<std::string> goal = goal_name(study, place);
    const std::optional<std::string> condition = condition_name(study, place);
    limit.rates->emplace_back(
        fmt::format("{}{}{}", goal.value_or(""), goal && condition ? ", " : "", condition.value_or("")),
        limit.estimate.rates[claim]);
  }
}

/// By how much the first units meet the worst claim (Estimate::margin); the lowest number where the point
/// cannot be simulated.
double margin_on(const EffectRuns& runs, const ChangedPoint& point, std::int64_t count) {
  if (!point.refusal.empty()) return -std::numeric_limits<double>::infinity();
  return estimate_of(runs.aim(), point.run, count).margin;
}

std::vector<ChangedPoint> pairs_of(const EffectRuns& runs, const std::vector<ConditionEffects>& causes) {
  std::vector<ChangedPoint> pairs;
  for (auto a = causes.begin(); a != causes.end(); ++a) {
    for (auto b = a + 1; b != causes.end(); ++b) pairs.push_back(runs.changed(std::array{&*a, &*b}));
  }
  return pairs;
}

/// The better half of the pairs on their first units, and of it those that are at least as good there as each
/// cause alone.
void keep_promising(const EffectRuns& runs, std::span<const ChangedPoint> alone, std::int64_t count,
                    std::vector<ChangedPoint>& pairs) {
  std::vector<double> margins;
  margins.reserve(pairs.size());
  for (const ChangedPoint& one : pairs) margins.push_back(margin_on(runs, one, count));
  const auto last_kept = margins.begin() + (std::ssize(margins) - 1) / 2;
  std::ranges::nth_element(margins, last_kept, std::ranges::greater());
  double least = *last_kept;
  for (const ChangedPoint& one : alone) least = std::max(least, margin_on(runs, one, count));
  std::erase_if(pairs, [&](const ChangedPoint& one) { return margin_on(runs, one, count) < least; });
}

/// The best of the pairs that are still promising on all units.
std::optional<Limit> best_pair(const EffectRuns& runs, std::span<const ChangedPoint> alone,
                               std::vector<ChangedPoint> pairs) {
  constexpr std::int64_t min_first = 64;
  std::int64_t count = std::max(min_first, runs.units() / 8);
  for (; count < runs.units() && !pairs.empty(); count *= 2) {
    count = trials::in_equal_worlds(runs.study(), count);
    runs.run(pairs, count);
    keep_promising(runs, alone, count, pairs);
  }
  runs.run(pairs, runs.units());
  std::optional<Limit> best;
  for (const ChangedPoint& one : pairs) {
    const Limit limit = limit_of(runs, one);
    if (!best || is_lower(*best, limit)) best = limit;
  }
  return best;
}

}  // namespace

bool is_lower(const Limit& a, const Limit& b) {
  if (!a.rate || !b.rate) return b.rate.has_value() && !a.rate;
  return a.estimate.margin < b.estimate.margin;
}

bool misses_nothing(const Limit& limit) {
  return limit.rate && std::ranges::all_of(limit.estimate.rates, [](double rate) { return rate == 1.0; });
}

Limit limit_of(const EffectRuns& runs, const ChangedPoint& point) {
  if (!point.refusal.empty()) return {point.name, std::nullopt, point.refusal};
  Limit limit{point.name, std::nullopt, point.note, estimate_of(runs.aim(), point.run, runs.units())};
  limit.rate = limit.estimate.rate;
  const Claim& claim = runs.aim().claims[limit.estimate.worst];
  limit.asked = claim.machines.value_or(claim.moves);
  if (has_named_claims(runs.study())) name_claims(runs, limit);
  return limit;
}

Estimate estimate_on(const study::Study& study, const trials::Replicates& units, std::int64_t count,
                     const Change* change, const trials::Effort& effort) {
  const Candidate candidate{{}, {}, results_of(study, units, count, change, effort)};
  return estimate_of(aim_of(study), candidate, units.count);
}

std::vector<Limit> limits_of(const EffectRuns& runs) {
  const std::vector<ConditionEffects> causes = runs.effects(idealisations_of);
  std::vector<Limit> limits{limit_of(runs, runs.base())};
  std::vector<ChangedPoint> alone;
  alone.reserve(causes.size());
  for (const ConditionEffects& one : causes) alone.push_back(runs.changed(std::array{&one}));
  if (misses_nothing(limits.front())) {
    for (const ChangedPoint& one : alone)
      limits.push_back({one.name, std::nullopt, one.refusal.empty() ? "nothing is missed" : one.refusal});
    return limits;
  }
  runs.run(alone, runs.units());
  for (const ChangedPoint& one : alone) limits.push_back(limit_of(runs, one));
  const Limit best_alone = *std::ranges::max_element(limits, is_lower);
  if (misses_nothing(best_alone)) return limits;
  const std::optional<Limit> together = best_pair(runs, alone, pairs_of(runs, causes));
  if (together && is_lower(best_alone, *together)) limits.push_back(*together);
  return limits;
}

}  // namespace zerocount::tuning
