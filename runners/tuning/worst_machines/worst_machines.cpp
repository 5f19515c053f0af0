#include "runners/tuning/worst_machines/worst_machines.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random/number_source.hpp"
#include "experiments/designs/random_key.hpp"
#include "experiments/study/condition_study.hpp"
#include "runners/tuning/race/search_space.hpp"
#include "runners/tuning/worst_machines/machine_race.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t trials_of_verdict = 256;
constexpr std::size_t worst_rigs = 4;
constexpr std::size_t max_corners = 64;
constexpr std::size_t filling_points = 128;
constexpr int generations = 8;
constexpr std::size_t children = 32;

/// The search under one condition.
class MachineSearch {
 public:
  /// @param study under the condition alone, and its units @param condition its name; empty: there is none
  MachineSearch(const study::Study& study, const trials::Replicates& units, std::string condition,
                const std::optional<std::filesystem::path>& folder, const trials::Effort& effort)
      : box_(study, units.point),
        units_(units),
        manifest_{std::move(condition), folder, trials_of_verdict},
        numbers_{designs::random_key(study.seed, "worst machine"), 0},
        failures_(study, units.point),
        effort_(effort) {}

  /// @param likely_met proportion of the moves that the worst likely machine of other conditions meets, or 1:
  /// one of this condition is sought only if a machine of the box meets less, since no likely one is worse
  WorstMachines run(double likely_met) {
    const std::vector<UnitResult> results = results_of(box_.study(), units_, units_.count, nullptr, effort_);
    const std::vector<std::int64_t> order = worst_units(results);
    std::vector<BoxPoint> named{worst_in(MachineRegion::box, order), box_.machine_of(order.front())};
    std::vector<JudgedMachine> judgements{judge(named[0]), judge(named[1])};
    if (!box_.is_likely(named[0]) && std::min(judgements[0].met, judgements[1].met) < likely_met) {
      named.push_back(worst_in(MachineRegion::likely, order));
      judgements.push_back(judge(named[2]));
    }
    const auto worst_that = [&](const auto& is_meant) {
      std::size_t worst = named.size();
      for (std::size_t i = 0; i < named.size(); ++i) {
        if (is_meant(named[i]) && (worst == named.size() || judgements[i].met < judgements[worst].met))
          worst = i;
      }
      return worst;
    };
    constexpr std::size_t of_study = 1;
    const std::size_t in_box = worst_that([](const BoxPoint&) { return true; });
    std::size_t likely = worst_that([&](const BoxPoint& point) { return box_.is_likely(point); });
    if (likely == named.size()) likely = in_box;  // not sought: no likely machine is worse
    return {worst_machine(box_.study(), units_.point, results),
            judgements[of_study],
            judgements[in_box],
            in_box == of_study || is_same(named[in_box], named[of_study]),
            judgements[likely],
            likely == in_box,
            box_.has_profile_per_rig()};
  }

 private:
  /// The units of the study, the worst first.
  std::vector<std::int64_t> worst_units(std::span<const UnitResult> results) const {
    std::vector<std::int64_t> order(results.size());
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::ranges::stable_sort(order, [&](std::int64_t a, std::int64_t b) {
      return failures_.is_worse(worst_result(results[static_cast<std::size_t>(a)]),
                                worst_result(results[static_cast<std::size_t>(b)]));
    });
    return order;
  }

  static const ClaimResult& worst_result(const UnitResult& unit) { return unit.claims[worst_claim(unit)]; }

  BoxPoint worst_in(MachineRegion region, const std::vector<std::int64_t>& order) {
    std::vector<BoxPoint> population = first_points(region, order);
    race(population, box_, failures_, effort_);
    double step = 0.25;
    for (int generation = 0; generation < generations; ++generation) {
      for (std::size_t i = 0, parents = population.size(); i < children; ++i)
        population.push_back(box_.inside(child_of(population[i % parents], step), region));
      race(population, box_, failures_, effort_);
      step *= 0.7;
    }
    return population.front();
  }

  std::vector<BoxPoint> first_points(MachineRegion region, const std::vector<std::int64_t>& order) {
    const std::size_t best = std::min(order.size(), worst_rigs);
    const std::size_t size = box_.inputs().size();
    std::vector<BoxPoint> points;
    const auto add = [&](const std::vector<double>& place) {
      BoxPoint point{box_.study().rigs > 0 ? order[points.size() % best] : 0, {}};
      for (const double one : place) point.quantiles.push_back(quantile_at(one));
      points.push_back(box_.inside(std::move(point), region));
    };
    const bool all_corners = size < 16 && (std::size_t{1} << size) <= max_corners;
    const std::size_t corners = all_corners ? std::size_t{1} << size : max_corners;
    for (std::size_t corner = 0; corner < corners; ++corner) {
      std::vector<double> place;
      for (std::size_t i = 0; i < size; ++i)
        place.push_back((all_corners ? ((corner >> i) & 1U) == 1U : numbers_.uniform() < 0.5) ? 1.0 : 0.0);
      add(place);
    }
    const SpreadPlaces filling(std::vector<double>(size, 0.5));
    for (std::size_t i = 0; i < filling_points; ++i) add(filling.at(static_cast<std::int64_t>(i)));
    for (std::size_t i = 0; i < std::min(order.size(), survivors); ++i)
      points.push_back(box_.inside(box_.machine_of(order[i]), region));
    return points;
  }

  BoxPoint child_of(const BoxPoint& parent, double step) {
    BoxPoint child{parent.rig, parent.quantiles};
    for (double& one : child.quantiles) {
      if (numbers_.uniform() < 0.5)
        one = quantile_at(std::clamp(place_at(one) + step * numbers_.normal(), 0.0, 1.0));
    }
    return child;
  }

  static bool is_same(const BoxPoint& a, const BoxPoint& b) {
    return a.rig == b.rig && a.quantiles == b.quantiles;
  }

  JudgedMachine judge(const BoxPoint& point) const {
    return judged(point, box_, failures_, manifest_, effort_);
  }

  MachineBox box_;
  trials::Replicates units_;
  MachineManifest manifest_;
  random::NumberSource numbers_;
  MachineFailures failures_;
  trials::Effort effort_;
};

}  // namespace

std::int64_t trials_of_worst_machines(const study::Study& study, const trials::Replicates& units) {
  // A race takes 4 trials of each machine, 12 more of a quarter, and 48 more of a quarter of these.
  constexpr auto of_newcomer =
      stage_trials[0] + (stage_trials[1] - stage_trials[0]) / 4 + (stage_trials[2] - stage_trials[1]) / 16;
  constexpr auto first = static_cast<std::int64_t>(worst_rigs + max_corners + filling_points);
  constexpr auto later = static_cast<std::int64_t>(generations * children);
  return units.trials() +
         study::condition_count(study) * (of_newcomer * (first + later) + 3 * trials_of_verdict);
}

WorstMachines worst_machines(const study::Study& study, const trials::Replicates& units,
                             const std::optional<std::filesystem::path>& folder,
                             const trials::Effort& effort) {
  std::vector<WorstMachines> under;  // [condition]
  double likely_met = 1.0;
  trials::Replicates alone = units;
  alone.trials_each /= study::condition_count(study);
  for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition) {
    const std::string name =
        study.condition_names.empty()
            ? ""
            : study.condition_names[static_cast<std::size_t>(condition % study::conditions_of_age(study))];
    WorstMachines& found = under.emplace_back(
        MachineSearch(under_condition(study, condition), alone, name, folder, effort).run(likely_met));
    likely_met = std::min(likely_met, found.likely.met);
    found.of_study.claim.condition = static_cast<std::size_t>(condition);
    found.of_study.trial = study::turns_of(study).trial_of(found.of_study.trial, condition);
    for (JudgedMachine* one : {&found.again, &found.in_box, &found.likely}) {
      one->condition = condition;
      one->condition_name = condition_name(study, found.of_study.claim);
    }
    name_claim(study, found.of_study);
  }
  const auto worst_by = [&](const auto& met) { return *std::ranges::min_element(under, {}, met); };
  const WorstMachines of_study = worst_by([](const WorstMachines& one) { return one.of_study.met; });
  const WorstMachines in_box = worst_by([](const WorstMachines& one) { return one.in_box.met; });
  const WorstMachines likely = worst_by([](const WorstMachines& one) { return one.likely.met; });
  return {
      .of_study = of_study.of_study,
      .again = of_study.again,
      .in_box = in_box.in_box,
      .in_box_is_of_study = in_box.in_box.condition == of_study.in_box.condition && in_box.in_box_is_of_study,
      .likely = likely.likely,
      .likely_is_in_box = likely.likely.condition == in_box.in_box.condition && likely.likely_is_in_box,
      .with_profiles = in_box.with_profiles};
}

}  // namespace zerocount::tuning
