#include "runners/tuning/effects/robustness.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/parallel/parallel.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::tuning {
namespace {

constexpr int other_seeds = 10;
constexpr double wider = 2.0;

Effect wider_spread(const study::Study& study, std::int64_t point) {
  study::PointEdit at(study, point);
  const study::Widened widened = at.widen(wider);
  Effect effect{.name = "twice the spread", .edit = [](study::PointEdit& of) { of.widen(wider); }};
  if (widened.changed.empty()) {
    effect.refusal = "nothing is drawn of the axis that can lie farther from its centre";
  } else if (!widened.kept.empty()) {
    effect.note =
        fmt::format("as in the study, because it would leave its range: {}", fmt::join(widened.kept, ", "));
  }
  return effect;
}

/// @param factor of a delay. @param instead samples, where there is none
Effect other_delay(const study::Study& study, std::int64_t point, double factor, double instead) {
  study::PointEdit at(study, point);
  const double delay = at.limits("controller.delay").high;
  const auto changed = [factor, instead](double samples) {
    return samples > 0.0 ? factor * samples : instead;
  };
  at.set("controller.delay", changed(delay));
  return {
      .name = delay > 0.0 ? fmt::format("{} the delay", factor < 1.0 ? "half" : "twice")
                          : fmt::format("{:g} samples of delay", instead),
      .refusal = rules::refusal_of(at),
      .change = [changed](trial::TrialParameters& p) { p.controller.delay = changed(p.controller.delay); }};
}

Variation variation_of(const EffectRuns& runs, const ChangedPoint& point) {
  Variation variation{limit_of(runs, point)};
  variation.holds = variation.limit.rate && reaches(runs.aim(), variation.limit.estimate);
  return variation;
}

Variation with_other_seeds(const EffectRuns& runs, const trials::Replicates& units,
                           const std::function<study::Study(std::uint64_t)>& with_seed,
                           const trials::Effort& effort) {
  std::array<study::Study, other_seeds> others;
  parallel::for_each_index(
      others.size(),
      [&](std::size_t i) {
        others[i] = with_seed(trials::fresh_seed(runs.study().seed, fmt::format("other seed {}", i)));
      },
      "study");
  Variation lowest;
  int held = 0;
  double highest = 0.0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const EffectRuns seeded(others[i], units, effort);
    Variation one = variation_of(seeded, seeded.base());
    held += one.holds ? 1 : 0;
    highest = std::max(highest, *one.limit.rate);
    if (i == 0 || is_lower(one.limit, lowest.limit)) lowest = std::move(one);
  }
  lowest.limit.effect = fmt::format("{} other seeds", other_seeds);
  lowest.limit.note =
      fmt::format("holds with {} of {}; the highest rate is {:.4g} %", held, other_seeds, 100.0 * highest);
  lowest.holds = held == other_seeds;
  return lowest;
}

}  // namespace

std::vector<Effect> other_premises(const study::Study& study, std::int64_t point) {
  return {wider_spread(study, point), other_delay(study, point, 0.5, 0.5),
          other_delay(study, point, 2.0, 2.0)};
}

std::vector<Variation> variations_of(const EffectRuns& runs, const trials::Replicates& units,
                                     const std::function<study::Study(std::uint64_t)>& with_seed,
                                     const trials::Effort& effort) {
  std::vector<Variation> found{with_other_seeds(runs, units, with_seed, effort)};
  std::vector<ChangedPoint> points;
  for (const ConditionEffects& one : runs.effects(other_premises))
    points.push_back(runs.changed(std::array{&one}));
  runs.run(points, runs.units());
  for (const ChangedPoint& one : points) found.push_back(variation_of(runs, one));
  return found;
}

}  // namespace zerocount::tuning
