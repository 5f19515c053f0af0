#include "runners/tuning/worst_machines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/move_event.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/random/number_source.hpp"
#include "experiments/designs/random_key.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/point_manifest.hpp"
#include "experiments/study/condition_study.hpp"
#include "experiments/study/machine_inputs.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "runners/trials/trial_set.hpp"
#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {
namespace {

constexpr double tail = 0.0005;  // beyond each end of the box
/// Trials of a machine at each stage of a race, from its first one on: the last stage decides.
constexpr std::array<std::int64_t, 3> stage_trials{4, 16, 64};
constexpr std::size_t stages = stage_trials.size();
constexpr std::size_t race_part = 4;  // one of so many goes on to the next stage
constexpr std::int64_t trials_at_once = 64;
constexpr std::int64_t trials_of_verdict = 256;
constexpr std::size_t worst_rigs = 4;
constexpr std::size_t max_corners = 64;
constexpr std::size_t filling_points = 128;
constexpr int generations = 8;
constexpr std::size_t survivors = 8;
constexpr std::size_t children = 32;

/// A machine: a rig, and [machine input] the quantile that it has.
struct BoxPoint {
  std::int64_t rig{0};
  std::vector<double> quantiles;
  std::vector<ClaimResult> results{};  ///< [stage] of its first trials, all goals together
};

/// A time beyond any that matters, s: ten times that of the goal, or the hold of a move. Of several goals as
/// a proportion of what each allows.
double late_time(const study::Study& study, std::int64_t point) {
  if (study.goals.size() > 1) return 10.0;
  if (study::first_goal(study)) return study::first_goal(study)->within * 10.0;
  return study::study_trial(study, point, 0).parameters.command.hold;
}

/// Mean of the criterion's values, where one that is never reached counts as `late`.
double lateness(const ClaimResult& unit, double late) {
  double sum = 0.0;
  for (const double value : unit.values) sum += std::min(value, late);
  return sum;
}

double quantile_at(double place) {
  return tail + (1.0 - 2.0 * tail) * place;
}
double place_at(double quantile) {
  return std::clamp((quantile - tail) / (1.0 - 2.0 * tail), 0.0, 1.0);
}

/// The machines among which the worst is sought.
enum class MachineRegion { box, likely };

bool are_correlated(const std::vector<study::MachineInput>& inputs, const study::StudyPlan& plan) {
  return std::ranges::any_of(inputs, [&](const study::MachineInput& input) {
    return plan.copula &&
           std::ranges::find(plan.copula->slots, input.slots.front()) != plan.copula->slots.end();
  });
}

/// The study with independent draws, as many as are wanted. Its profiles stay.
study::Study searched_study(const study::Study& study, const std::vector<study::MachineInput>& inputs) {
  study::Study searched = study;
  if (are_correlated(inputs, *study.plan)) {
    auto plan = std::make_shared<study::StudyPlan>(*study.plan);
    plan->copula.reset();
    searched.plan = std::move(plan);
    searched.correlations.clear();
  }
  searched.design = study::Design::monte_carlo;
  return searched;
}

double latest(const ClaimResult& result) {
  return result.values.empty() ? 0.0 : *std::ranges::max_element(result.values);
}

/// The claim that the unit meets in the fewest moves, the latest of equal ones.
std::size_t worst_claim(const UnitResult& unit) {
  const auto worst = std::ranges::min_element(unit.claims, [](const ClaimResult& a, const ClaimResult& b) {
    return met_proportion(a) != met_proportion(b) ? met_proportion(a) < met_proportion(b)
                                                  : latest(a) > latest(b);
  });
  return static_cast<std::size_t>(worst - unit.claims.begin());
}

void name_claim(const study::Study& study, WorstMachine& machine) {
  if (has_named_claims(study)) machine.goal = goal_name(study, machine.claim);
  machine.condition = condition_name(study, machine.claim);
}

std::string not_one_number(std::string_view name) {
  return fmt::format(
      "{} changes with age, and is drawn per study or contact: the manifest of a machine cannot hold its "
      "aged value",
      name);
}

/// The search under one condition.
class MachineSearch {
 public:
  /// @param study under the condition alone, and its units @param condition its name; empty: there is none
  MachineSearch(const study::Study& study, const trials::Replicates& units, std::string condition,
                const std::optional<std::filesystem::path>& folder, const trials::Effort& effort)
      : given_(study),
        units_(units),
        condition_(std::move(condition)),
        folder_(folder),
        inputs_(study::machine_inputs(study, units.point)),
        study_(searched_study(study, inputs_)),
        numbers_{designs::random_key(study.seed, "worst machine"), 0},
        event_(measures::missed_question(study_)),
        late_(late_time(study, units.point)),
        effort_(effort) {
    if (inputs_.empty())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: it draws nothing that differs between machines; expected distributions, "
                                "such as friction.k1: {{lognormal: {{median: 110, cv: 0.1}}}}",
                                study.name));
    for (const auto& [slot, value] : profiles()) {
      has_profile_ = true;
      has_profile_per_rig_ |= value->level == study::DrawLevel::rig;
    }
  }

  /// @param likely_met proportion of the moves that the worst likely machine of other conditions meets, or 1:
  /// one of this condition is sought only if a machine of the box meets less, since no likely one is worse
  WorstMachines run(double likely_met) {
    const std::vector<UnitResult> results = results_of(given_, units_, units_.count, nullptr, effort_);
    const std::vector<std::int64_t> order = worst_units(results);
    std::vector<BoxPoint> named{worst_in(MachineRegion::box, order), machine_of(order.front())};
    std::vector<JudgedMachine> judgements{judged(named[0]), judged(named[1])};
    if (!is_likely(named[0]) && std::min(judgements[0].met, judgements[1].met) < likely_met) {
      named.push_back(worst_in(MachineRegion::likely, order));
      judgements.push_back(judged(named[2]));
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
    std::size_t likely = worst_that([&](const BoxPoint& point) { return is_likely(point); });
    if (likely == named.size()) likely = in_box;  // not sought: no likely machine is worse
    return {worst_machine(given_, units_.point, results),
            judgements[of_study],
            judgements[in_box],
            in_box == of_study || is_same(named[in_box], named[of_study]),
            judgements[likely],
            likely == in_box,
            has_profile_per_rig_};
  }

 private:
  /// The units of the study, the worst first.
  std::vector<std::int64_t> worst_units(std::span<const UnitResult> results) const {
    std::vector<std::int64_t> order(results.size());
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::ranges::stable_sort(order, [&](std::int64_t a, std::int64_t b) {
      return is_worse(worst_result(results[static_cast<std::size_t>(a)]),
                      worst_result(results[static_cast<std::size_t>(b)]), late_);
    });
    return order;
  }

  static const ClaimResult& worst_result(const UnitResult& unit) { return unit.claims[worst_claim(unit)]; }

  static bool is_worse(const ClaimResult& a, const ClaimResult& b, double late) {
    if (met_proportion(a) != met_proportion(b)) return met_proportion(a) < met_proportion(b);
    return lateness(a, late) > lateness(b, late);
  }

  /// The machine of a rig of the study or, without rigs, of a trial.
  BoxPoint machine_of(std::int64_t unit) const {
    return {given_.rigs > 0 ? unit : 0, study::drawn_quantiles(given_, units_.point, unit, inputs_)};
  }

  BoxPoint worst_in(MachineRegion region, const std::vector<std::int64_t>& order) {
    std::vector<BoxPoint> population = first_points(region, order);
    race(population);
    double step = 0.25;
    for (int generation = 0; generation < generations; ++generation) {
      for (std::size_t i = 0, parents = population.size(); i < children; ++i)
        population.push_back(inside(child_of(population[i % parents], step), region));
      race(population);
      step *= 0.7;
    }
    return population.front();
  }

  std::vector<BoxPoint> first_points(MachineRegion region, const std::vector<std::int64_t>& order) {
    const std::size_t best = std::min(order.size(), worst_rigs);
    const std::size_t size = inputs_.size();
    std::vector<BoxPoint> points;
    const auto add = [&](const std::vector<double>& place) {
      BoxPoint point{given_.rigs > 0 ? order[points.size() % best] : 0, {}};
      for (const double one : place) point.quantiles.push_back(quantile_at(one));
      points.push_back(inside(std::move(point), region));
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
      points.push_back(inside(machine_of(order[i]), region));
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

  bool is_row(std::size_t input) const { return inputs_[input].slots.size() > 1; }  // of joint samples

  /// Of the likely machines Σ z² as a part of its limit; of the others 0.
  double excess_of(const BoxPoint& point, MachineRegion region) const {
    double square = 0.0;
    int scores = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (region == MachineRegion::box || is_row(i)) continue;
      const double z = numerics::normal_quantile(point.quantiles[i]);
      square += z * z;
      ++scores;
    }
    return scores == 0 ? 0.0 : square / statistics::chi_squared_quantile(scores, 1.0 - 2.0 * tail);
  }

  void approach_median(BoxPoint& point, double divisor) const {
    for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
      if (is_row(i)) continue;
      double& one = point.quantiles[i];
      one = numerics::normal_probability(numerics::normal_quantile(one) / divisor);
    }
  }

  bool is_a_machine(const BoxPoint& point) const {
    return study::is_machine(study_, units_.point, point.rig, draws_of(point, given_.trials));
  }

  /// The nearest machine of the region on the way to the median.
  BoxPoint inside(BoxPoint point, MachineRegion region) const {
    for (double& one : point.quantiles) one = std::clamp(one, tail, 1.0 - tail);
    if (const double excess = excess_of(point, region); excess > 1.0)
      approach_median(point, std::sqrt(excess));
    // Measured values at the ends of their ranges may be those of no machine.
    constexpr int max_steps = 100;
    for (int step = 0; step < max_steps && !is_a_machine(point); ++step) approach_median(point, 1.1);
    return point;
  }

  bool is_likely(const BoxPoint& point) const {
    constexpr double rounding = 1e-9;
    for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
      const double one = point.quantiles[i];
      if (!is_row(i) && (one < tail - rounding || one > 1.0 - tail + rounding)) return false;
    }
    return excess_of(point, MachineRegion::likely) <= 1.0 + rounding;
  }

  static bool is_same(const BoxPoint& a, const BoxPoint& b) {
    return a.rig == b.rig && a.quantiles == b.quantiles;
  }

  study::GivenDraws draws_of(const BoxPoint& point, std::int64_t number) const {
    study::GivenDraws given;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      for (const std::uint32_t slot : inputs_[i].slots) given.uniforms[slot] = point.quantiles[i];
    }
    given.number = number;
    given.rotor = point.rig;
    return given;
  }

  /// A trial of the machine with the random numbers `number`.
  trial::TrialParameters trial_of(const BoxPoint& point, std::int64_t number) const {
    return study::study_trial(study_, units_.point, point.rig, draws_of(point, number)).parameters;
  }

  /// Keeps the worst of the points, the worst first. After each stage a part of those that have not run all
  /// trials goes on, by the trials that all of them have run: of it those that do worse there than the
  /// mildest point that is kept so far, which they would replace.
  void race(std::vector<BoxPoint>& points) const {
    const auto newcomers = std::stable_partition(
        points.begin(), points.end(), [](const BoxPoint& point) { return point.results.size() == stages; });
    std::vector<BoxPoint> running(newcomers, points.end());
    points.erase(newcomers, points.end());
    for (std::size_t stage = 0; stage < stages; ++stage) {
      simulate(running, stage);
      sort_by(running, stage);
      const std::size_t on = std::max((running.size() + race_part - 1) / race_part, survivors / 2);
      if (stage + 1 == stages) break;
      if (running.size() > on) running.resize(on);
      if (points.size() < survivors) continue;
      std::erase_if(running, [&](const BoxPoint& point) {
        return !is_worse(point.results[stage], points.back().results[stage], late_);
      });
    }
    std::ranges::move(running, std::back_inserter(points));
    sort_by(points, stages - 1);
    if (points.size() > survivors) points.resize(survivors);
  }

  /// Runs the trials of a stage.
  void simulate(std::vector<BoxPoint>& points, std::size_t stage) const {
    const std::int64_t from = stage == 0 ? 0 : stage_trials[stage - 1];
    const auto trials = static_cast<std::size_t>(stage_trials[stage] - from);
    for (BoxPoint& point : points)
      point.results.push_back(stage == 0 ? ClaimResult{} : ClaimResult(point.results.back()));
    const std::size_t size = (trials_at_once + trials - 1) / trials;
    const auto points_of = [&](std::size_t block) {
      return std::span(points).subspan(block * size, std::min(size, points.size() - block * size));
    };
    const auto draw = [&](std::size_t block) {
      std::vector<trial::TrialParameters> drawn;
      for (const BoxPoint& point : points_of(block)) {
        for (std::int64_t i = from; i < stage_trials[stage]; ++i)
          drawn.push_back(trial_of(point, given_.trials + i));
      }
      return drawn;
    };
    trials::run({static_cast<std::int64_t>(points.size() * trials), (points.size() + size - 1) / size, draw},
                effort_, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
                  for (BoxPoint& point : points_of(block)) {
                    add_to(point.results.back(), outcomes.first(trials));
                    outcomes = outcomes.subspan(trials);
                  }
                });
  }

  /// Adds the moves that meet the goals which ask them, and the score of each; the largest double where it
  /// was never reached.
  void add_to(ClaimResult& result, std::span<const trial::TrialOutcome> outcomes) const {
    for (const trial::TrialOutcome& outcome : outcomes) {
      for (const trial::MoveOutcome& move : outcome.moves) {
        if (!measures::is_asked(event_, move)) continue;
        const double score = measures::score_of(measures::MoveScore::event, event_, move);
        ++result.moves;
        result.met += measures::happens(event_, move) ? 0 : 1;
        result.values.push_back(std::isnan(score) ? std::numeric_limits<double>::max() : score);
      }
    }
  }

  /// What a trial shows of all goals together, then of each.
  std::vector<ClaimResult> counts_of(const trial::TrialOutcome& outcome) const {
    std::vector<ClaimResult> counts(1);
    add_to(counts.front(), {&outcome, 1});
    for (const measures::CountedGoal& goal : measures::asked_of_moves(given_)) {
      ClaimResult& count = counts.emplace_back();
      for (const trial::MoveOutcome& move : outcome.moves) {
        if (!measures::asks(goal, move)) continue;
        ++count.moves;
        count.met += measures::meets(goal, move) ? 1 : 0;
      }
    }
    return counts;
  }

  static std::vector<ClaimResult> sum_of(const std::vector<std::vector<ClaimResult>>& trials) {
    std::vector<ClaimResult> sums(trials.front().size());
    for (const std::vector<ClaimResult>& trial : trials) {
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i].moves += trial[i].moves;
        sums[i].met += trial[i].met;
        sums[i].values.insert(sums[i].values.end(), trial[i].values.begin(), trial[i].values.end());
      }
    }
    return sums;
  }

  /// The worst first.
  void sort_by(std::vector<BoxPoint>& points, std::size_t stage) const {
    std::ranges::stable_sort(points, [&](const BoxPoint& a, const BoxPoint& b) {
      return is_worse(a.results[stage], b.results[stage], late_);
    });
  }

  /// The values that are profiles, by their slots.
  std::vector<std::pair<std::size_t, const study::Value*>> profiles() const {
    std::vector<std::pair<std::size_t, const study::Value*>> found;
    const auto values = study::values_at(*given_.plan, static_cast<std::size_t>(units_.point));
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
      if (values[slot]->kind == study::Value::Kind::profile) found.emplace_back(slot, values[slot]);
    }
    return found;
  }

  /// The rigs of the machine's manifest: more than one only where a profile belongs to a rig.
  std::int64_t rigs_of(const BoxPoint& point) const {
    return has_profile_per_rig_ ? std::max<std::int64_t>(point.rig + 1, 2) : 1;
  }

  /// By which the machine with these values multiplies a value at its age.
  double age_factor(const study::Value& value,
                    const std::vector<std::pair<std::string, double>>& values) const {
    if (!value.aging) return 1.0;
    const study::StudyPlan& plan = *given_.plan;
    const auto point = static_cast<std::size_t>(units_.point);
    const study::Aging& aging = plan.agings[*value.aging];
    const auto drawn =
        std::ranges::find(values, plan.table.rows[aging.rate].name, &std::pair<std::string, double>::first);
    return study::factor_at_age(
        aging, drawn != values.end() ? drawn->second : study::limits_of_slot(plan, aging.rate, point).typical,
        study::age_at(plan, point));
  }

  /// Puts the values as they act at the age of the machine in place of those at age 0: its manifest has no
  /// ages.
  /// @throws Failure (bad_input) for a value that is drawn anew for each contact, or once for all machines
  void let_act_at_age(manifest_text::PointChanges& changes) const {
    const study::StudyPlan& plan = *given_.plan;
    if (plan.ages.empty()) return;
    const std::vector<std::pair<std::string, double>> drawn = changes.values;
    std::erase_if(changes.values, [](const auto& one) { return one.first.ends_with(study::suffix_of_rate); });
    changes.removed.emplace_back("ages");
    for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
      const study::Value& value = *study::value_at_point(plan, slot, static_cast<std::size_t>(units_.point));
      if (!value.aging) continue;
      const std::string name(plan.table.rows[slot].name);
      const double factor = age_factor(value, drawn);
      const auto known = std::ranges::find(changes.values, name, &std::pair<std::string, double>::first);
      if (known != changes.values.end()) {
        known->second *= factor;
      } else if (value.kind == study::Value::Kind::number) {
        changes.values.emplace_back(name, factor * value.number);
      } else if (value.kind == study::Value::Kind::profile) {
        changes.removed.push_back(name + ".aging");
        if (const study::Rotors& rotors = *plan.profiles[value.index]; !rotors.drawn_mean())
          changes.values.emplace_back(name + ".profile.mean", factor * rotors.mean(0));
      } else {
        throw Failure(ExitCode::bad_input, not_one_number(name));
      }
    }
  }

  std::string manifest_of(const BoxPoint& point,
                          const std::vector<std::pair<std::string, double>>& values) const {
    manifest_text::PointChanges changes{
        .condition = condition_, .values = values, .folder = folder_.value_or("")};
    changes.removed = {"design", "worlds", "retain"};
    let_act_at_age(changes);
    if (are_correlated(inputs_, *given_.plan)) changes.removed.emplace_back("correlation");
    for (const auto& [slot, value] : profiles()) {
      const study::Rotors& rotors = *given_.plan->profiles[value->index];
      if (rotors.drawn_mean())
        changes.values.emplace_back(
            fmt::format("{}.profile.mean", given_.plan->table.rows[slot].name),
            age_factor(*value, values) * rotors.mean(value->level == study::DrawLevel::rig ? point.rig : 0));
    }
    for (const study::MachineInput& input : inputs_) {
      const std::vector<std::uint32_t>& rows = given_.plan->sampled_slots;
      if (std::ranges::find(rows, input.slots.front()) != rows.end()) changes.removed.emplace_back("samples");
    }
    changes.keys.emplace_back("trials", fmt::format("{}", trials_of_verdict * rigs_of(point)));
    if (has_profile_per_rig_) {
      changes.keys.emplace_back("rigs", fmt::format("{}", rigs_of(point)));
    } else {
      changes.removed.emplace_back("rigs");
      for (const study::Goal& goal : given_.goals)
        changes.removed.push_back(goal.name.empty() ? "goal.machines" : "goals." + goal.name + ".machines");
    }
    // A profile is drawn with the seed.
    if (!has_profile_) changes.keys.emplace_back("seed", fmt::format("{}", given_.seed + 1));
    return manifest_text::manifest_of_point(given_, units_.point, changes);
  }

  JudgedMachine judged(const BoxPoint& point) const {
    JudgedMachine machine;
    machine.rig = point.rig;
    machine.quantiles = point.quantiles;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      for (const auto& one : study::values_at_quantile(given_, units_.point, inputs_[i], point.quantiles[i]))
        machine.inputs.push_back(one);
    }
    std::vector<trial::TrialParameters> trials;
    std::int64_t first = 0;
    try {
      machine.manifest = manifest_of(point, machine.inputs);
      const study::Study alone =
          manifest::parse_study(machine.manifest, given_.name, {}, sections::companions_of(given_));
      first = has_profile_per_rig_ ? point.rig : 0;
      for (std::int64_t i = 0; i < trials_of_verdict; ++i)
        trials.push_back(study::study_trial(alone, 0, first + i * rigs_of(point)).parameters);
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_input && failure.code() != ExitCode::bad_data) throw;
      machine.manifest.clear();
      machine.no_manifest = failure.what();
      trials.clear();
      for (std::int64_t i = 0; i < trials_of_verdict; ++i)
        trials.push_back(trial_of(point, given_.trials + stage_trials.back() + i));
    }
    const std::vector<std::vector<ClaimResult>> results = trials::results_of(
        trials_of_verdict, trials_at_once,
        [&](std::int64_t i) { return trials[static_cast<std::size_t>(i)]; }, effort_,
        [&](const trial::TrialOutcome& outcome) { return counts_of(outcome); });
    const std::vector<ClaimResult> sums = sum_of(results);
    const ClaimResult& result = sums.front();
    machine.moves = result.moves;
    machine.met = met_proportion(result);
    if (sums.size() > 2) {
      const auto worst = std::ranges::min_element(sums.begin() + 1, sums.end(), {}, met_proportion);
      machine.goal = goal_name(given_, {static_cast<std::size_t>(worst - sums.begin() - 1), 0});
    }
    const auto latest = std::ranges::max_element(result.values) - result.values.begin();
    const std::int64_t asked = result.moves / trials_of_verdict;
    machine.trial = first + latest / asked * rigs_of(point);
    return machine;
  }

  study::Study given_;
  trials::Replicates units_;
  std::string condition_;
  std::optional<std::filesystem::path> folder_;
  std::vector<study::MachineInput> inputs_;
  study::Study study_;
  random::NumberSource numbers_;
  measures::MoveEvent event_;
  double late_;  ///< a time that counts for one that is never reached, s
  trials::Effort effort_;
  bool has_profile_{false};
  bool has_profile_per_rig_{false};
};

}  // namespace

WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results) {
  const auto worst = std::ranges::min_element(results, [](const UnitResult& a, const UnitResult& b) {
    const ClaimResult& of_a = a.claims[worst_claim(a)];
    const ClaimResult& of_b = b.claims[worst_claim(b)];
    return met_proportion(of_a) != met_proportion(of_b) ? met_proportion(of_a) < met_proportion(of_b)
                                                        : latest(of_a) > latest(of_b);
  });
  const std::size_t claim = worst_claim(*worst);
  const ClaimResult& result = worst->claims[claim];
  WorstMachine machine{worst - results.begin(), 0, met_proportion(result), {}, place_of_claim(study, claim)};
  const std::int64_t asked =
      measures::asked_moves(measures::asked_of_moves(study)[machine.claim.goal], study.moves);
  const std::int64_t trial_under_condition =
      (std::ranges::max_element(result.values) - result.values.begin()) / asked;
  machine.trial = trials::trial_of_replicate(study, {.count = std::ssize(results)}, machine.rig,
                                             trial_under_condition * study::condition_count(study) +
                                                 static_cast<std::int64_t>(machine.claim.condition));
  const bool of_rig =
      study.rigs > 0 && (!study.columns.rigs.empty() || (study.worlds > 0 && !study.columns.worlds.empty()));
  const bool has_conditions = !study.conditions.empty();  // what they override is an input of trials
  const std::vector<study::InputColumn>& columns =
      of_rig && !has_conditions ? study.columns.rigs : study.columns.inputs;
  const std::vector<double> inputs = of_rig && !has_conditions
                                         ? study::rig_inputs(study, machine.rig)
                                         : study::study_trial(study, point, machine.trial).inputs;
  const auto is_of_machine = [&](const study::InputColumn& column) {
    return !of_rig || !has_conditions || column.level < study::DrawLevel::trial;
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (is_of_machine(columns[i])) machine.inputs.emplace_back(columns[i].name, inputs[i]);
  }
  if (of_rig && !has_conditions && study.worlds > 0) {
    const std::vector<double> of_world = study::world_inputs(study, study::world_of(study, machine.rig));
    for (std::size_t i = 0; i < of_world.size(); ++i)
      machine.inputs.emplace_back(study.columns.worlds[i].name, of_world[i]);
  }
  name_claim(study, machine);
  return machine;
}

std::string refusal_of_manifests(const study::Study& study, std::int64_t point) {
  const study::StudyPlan& plan = *study.plan;
  for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition) {
    for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
      const study::Value& value =
          *study::value_at_point(plan, slot, study::plan_point(plan, point, condition));
      const bool is_shared =
          value.level == study::DrawLevel::contact || value.level == study::DrawLevel::study;
      if (value.aging && value.kind == study::Value::Kind::distribution && is_shared)
        return not_one_number(plan.table.rows[slot].name);
    }
  }
  return "";
}

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
