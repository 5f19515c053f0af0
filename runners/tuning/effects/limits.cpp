#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiments/study/setting_study.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
namespace {

void name_claims(const EffectRuns& runs, Limit& limit) {
  const study::Study& study = runs.study();
  limit.worst = names_of(study, place_of_claim(study, limit.estimate.worst));
  limit.rates.emplace();
  for (std::size_t claim = 0; claim < limit.estimate.rates.size(); ++claim) {
    const auto [goal, setting] = names_of(study, place_of_claim(study, claim));
    limit.rates->emplace_back(
        fmt::format("{}{}{}", goal.value_or(""), goal && setting ? ", " : "", setting.value_or("")),
        limit.estimate.rates[claim]);
  }
}

/// RateEstimate::margin (worst success rate compared with the wanted one, larger is better) of a changed
/// point on its first `count` machines; −infinity if the point cannot be simulated.
double margin_on(const EffectRuns& runs, const ChangedPoint& point, std::int64_t count) {
  if (!point.refusal.empty()) return -std::numeric_limits<double>::infinity();
  return estimate_of(runs.aim(), point.machines, count).margin;
}

std::vector<ChangedPoint> pairs_of(const EffectRuns& runs, std::span<const ChangedPoint> alone) {
  std::vector<ChangedPoint> pairs;
  for (auto a = alone.begin(); a != alone.end(); ++a) {
    for (auto b = a + 1; b != alone.end(); ++b) pairs.push_back(runs.together(*a, *b));
  }
  return pairs;
}

/// Keeps the better half of the pairs of causes, judged on their first `count` machines. Of this half, keeps
/// only the pairs that are at least as good on these machines as each single cause.
/// @param alone [cause] points with a single cause switched off
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

std::int64_t first_machines_of_pairs(std::int64_t machines) {
  constexpr std::int64_t fewest = 64;
  constexpr std::int64_t most = 1024;
  return std::min(machines, std::clamp(machines / 8, fewest, most));
}

/// The pair of causes with the largest RateEstimate::margin on all machines. Pairs that fall behind on fewer
/// machines are dropped before (keep_promising()). Null if none is left.
/// @param alone [cause] points with a single cause switched off
const ChangedPoint* best_pair(const EffectRuns& runs, std::span<const ChangedPoint> alone,
                              std::vector<ChangedPoint>& pairs) {
  for (std::int64_t count = first_machines_of_pairs(runs.machines());
       count < runs.machines() && !pairs.empty(); count *= 2) {
    count = trials::in_equal_worlds(runs.study(), count);
    runs.run(pairs, count);
    keep_promising(runs, alone, count, pairs);
  }
  runs.run(pairs, runs.machines());
  const auto best = std::ranges::max_element(
      pairs, {}, [&](const ChangedPoint& one) { return margin_on(runs, one, runs.machines()); });
  return best == pairs.end() || !best->refusal.empty() ? nullptr : &*best;
}

/// Counts the machines that gain and lose from one point to another, in the claim (goal in a setting) that is
/// worst without changes.
/// @param alternatives number of causes, or of pairs of causes, that are tried
PairedGain gain_between(const EffectRuns& runs, const ChangedPoint& before, const ChangedPoint& after,
                        std::int64_t alternatives) {
  const std::size_t worst = runs.estimate(runs.base()).worst;
  return paired_gain(runs.aim().claims[worst], worst, before.machines, after.machines, alternatives);
}

/// Result with a cause, or a pair of causes, switched off: rate, avoided failures and gain compared with the
/// unchanged point `base`.
Limit cause_of(const EffectRuns& runs, const ChangedPoint& without, const Limit& base,
               std::int64_t alternatives) {
  Limit limit = limit_of(runs, without);
  if (!limit.rate) return limit;
  limit.gain = gain_between(runs, runs.base(), without, alternatives);
  limit.gain->shown = limit.gain->shown && is_lower(base, limit);
  return limit;
}

/// Simulates each single cause on all machines, in up to 100 steps so that `tell` can show the progress.
void run_alone(const EffectRuns& runs, std::vector<ChangedPoint>& alone, const TellStage& tell) {
  constexpr std::int64_t trials_of_part = 2000;
  constexpr std::int64_t most_parts = 100;
  const std::int64_t trials = runs.machines() * runs.trials_each() * std::ssize(runs.settings()) *
                              std::max<std::int64_t>(std::ssize(alone), 1);
  const std::int64_t parts = std::clamp<std::int64_t>(trials / trials_of_part, 1, most_parts);
  for (std::int64_t part = 1; part <= parts; ++part) {
    if (tell)
      tell(fmt::format("{} causes of failures, each switched off: {} %", alone.size(),
                       100 * (part - 1) / parts));
    runs.run(alone, runs.machines() * part / parts);
  }
}

/// Adds to `limits` the best pair of causes, if its gain over each single cause is significant.
void add_best_pair(const EffectRuns& runs, std::span<const ChangedPoint> alone, const TellStage& tell,
                   std::vector<Limit>& limits) {
  const auto best = std::ranges::max_element(limits, is_lower);
  if (misses_nothing(*best)) return;
  if (tell) tell("pairs of causes");
  std::vector<ChangedPoint> pairs = pairs_of(runs, alone);
  const std::int64_t alternatives = std::ssize(pairs);
  const ChangedPoint* const together = best_pair(runs, alone, pairs);
  if (together == nullptr) return;
  Limit limit = cause_of(runs, *together, limits.front(), alternatives);
  if (!is_lower(*best, limit)) return;
  if (const Limit* const main = main_cause(limits)) {
    const auto single = std::ranges::find(alone, main->effect, &ChangedPoint::name);
    limit.gain->shown = limit.gain->shown && gain_between(runs, *single, *together, alternatives).shown;
  }
  limits.push_back(std::move(limit));
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
  Limit limit{point.name, std::nullopt, point.note, runs.estimate(point)};
  limit.rate = limit.estimate.rate;
  limit.asked = study::demanded_proportion(runs.aim().claims[limit.estimate.worst]);
  const RateEstimate base = runs.estimate(runs.base());
  if (&point != &runs.base() && base.rate < 1.0 && limit.estimate.worst == base.worst &&
      limit.estimate.machines == base.machines)
    limit.avoided = (limit.estimate.rate - base.rate) / (1.0 - base.rate);
  limit.holds = reaches(runs.aim(), limit.estimate);
  if (has_named_claims(runs.study())) name_claims(runs, limit);
  return limit;
}

RateEstimate estimate_on(const study::Study& study, const trials::Replicates& machines, std::int64_t count,
                         const Change* change, const trials::Effort& effort) {
  return estimate_of(aim_of(study), results_of(study, machines, count, change, effort), count);
}

std::vector<Limit> find_causes(const EffectRuns& runs, const TellStage& tell) {
  std::vector<Limit> limits{limit_of(runs, runs.base())};
  std::vector<ChangedPoint> alone = runs.points(idealisations_of);
  if (misses_nothing(limits.front())) {
    for (const ChangedPoint& one : alone)
      limits.push_back({one.name, std::nullopt, one.refusal.empty() ? "nothing is missed" : one.refusal});
    return limits;
  }
  run_alone(runs, alone, tell);
  for (const ChangedPoint& one : alone)
    limits.push_back(cause_of(runs, one, limits.front(), std::ssize(alone)));
  if (!trials::within(runs.effort(), [&] { add_best_pair(runs, alone, tell, limits); }))
    limits.push_back({"pairs of causes", std::nullopt, "the budget ended"});
  return limits;
}

double runs_of_causes(const study::Study& study, std::int64_t point, std::int64_t machines) {
  const auto causes = static_cast<double>(idealisations_of(in_setting(study, 0), point).size());
  // Half of the pairs remain whenever their machines double.
  const double part = static_cast<double>(first_machines_of_pairs(machines)) /
                      static_cast<double>(std::max<std::int64_t>(machines, 1));
  const double each_pair = part * (1.0 - 0.5 * std::log2(part));
  return 1.0 + causes + 0.5 * causes * (causes - 1.0) * each_pair;
}

const Limit* main_cause(const std::vector<Limit>& limits) {
  const Limit* best = nullptr;
  for (const Limit& one : limits) {
    if (one.is_shown_cause() && (best == nullptr || is_lower(*best, one))) best = &one;
  }
  return best;
}

}  // namespace zerocount::tuning
