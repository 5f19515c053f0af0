#include "runners/tuning/worst_machines/worst_machines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/move_event.hpp"
#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/trials/trial_set.hpp"
#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {
namespace {

/// [stage] Number of trials that a machine has run at the end of each stage of a race between machines. The
/// result of the last stage decides.
constexpr std::array<std::int64_t, 3> stage_trials{4, 16, 64};
constexpr std::size_t survivors = 8;  // machines that a race keeps
constexpr std::size_t stages = stage_trials.size();
constexpr std::size_t race_part = 4;  // one of so many goes on to the next stage
constexpr std::int64_t raced_at_once = 64;

/// Limit at which late values of moves are capped, later than any that matters. With one goal, s: ten times
/// the time of the goal; without a goal, or if the goal counts from the end of a profile, the hold of a move.
/// With several goals: 10, as a multiple of the time that each goal allows.
double late_time(const study::Study& study, std::int64_t point) {
  if (study.goals.size() > 1) return 10.0;
  const auto* const goal = study::first_goal(study);
  if (goal != nullptr && !goal->within.after_profile) return goal->within.time * 10.0;
  return study::study_trial(study, point, 0).parameters.command.hold;
}

/// Sum of the values of a machine's moves, each capped at `late`; larger is worse.
double lateness(const ClaimResult& machine, double late) {
  double sum = 0.0;
  for (const double value : machine.values) sum += std::min(value, late);
  return sum;
}

/// Counts the failures of a machine: its judged moves that miss a goal, and the score of each move
/// (measures::MoveScore::event).
class MachineFailures {
 public:
  MachineFailures(const study::Study& study, std::int64_t point)
      : event_(measures::missed_criteria(study)), late_(late_time(study, point)) {}

  /// Adds the moves of these trials to `result`: the judged moves, the moves that meet the goals, and the
  /// score of each judged move. A score that does not exist counts as the largest double.
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

  /// Whether the machine with the result `a` meets a smaller proportion of moves than the one with `b`. Ties:
  /// whether the scores of `a` have the larger sum.
  bool is_worse(const ClaimResult& a, const ClaimResult& b) const {
    if (met_proportion(a) != met_proportion(b)) return met_proportion(a) < met_proportion(b);
    return lateness(a, late_) > lateness(b, late_);
  }

 private:
  measures::MoveEvent event_;
  double late_;  ///< Value of late_time(), at which scores are capped.
};

/// Merit of a machine in a claim, for ordering; a smaller one is worse. It is the proportion of moves that
/// meet the goal, then minus the largest value of the criterion.
std::pair<double, double> merit_of(const ClaimResult& result) {
  return {met_proportion(result), result.values.empty() ? 0.0 : -std::ranges::max(result.values)};
}

/// Index of the claim (goal in a setting) that the machine meets in the smallest proportion of moves. Ties go
/// to the claim with the largest criterion value.
std::size_t worst_claim(const MachineResult& machine) {
  return static_cast<std::size_t>(std::ranges::min_element(machine.claims, {}, merit_of) -
                                  machine.claims.begin());
}

const ClaimResult& worst_result(const MachineResult& machine) {
  return machine.claims[worst_claim(machine)];
}

/// Simulates the trials of a stage of the race for all points (machines), and appends their results.
void simulate(std::vector<BoxPoint>& points, std::size_t stage, const MachineBox& box,
              const MachineFailures& failures, const trials::Effort& effort) {
  const std::int64_t from = stage == 0 ? 0 : stage_trials[stage - 1];
  const auto trials = static_cast<std::size_t>(stage_trials[stage] - from);
  for (BoxPoint& point : points)
    point.results.push_back(stage == 0 ? ClaimResult{} : ClaimResult(point.results.back()));
  const std::size_t size = (raced_at_once + trials - 1) / trials;
  const auto points_of = [&](std::size_t block) {
    return std::span(points).subspan(block * size, std::min(size, points.size() - block * size));
  };
  const auto draw = [&](std::size_t block) {
    std::vector<trial::TrialParameters> drawn;
    for (const BoxPoint& point : points_of(block)) {
      for (std::int64_t i = from; i < stage_trials[stage]; ++i)
        drawn.push_back(box.trial_of(point, box.study().trials + i));
    }
    return drawn;
  };
  trials::run({static_cast<std::int64_t>(points.size() * trials), (points.size() + size - 1) / size, draw},
              effort, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
                for (BoxPoint& point : points_of(block)) {
                  failures.add_to(point.results.back(), outcomes.first(trials));
                  outcomes = outcomes.subspan(trials);
                }
              });
}

/// Sorts the points (machines) by their results of a stage, the worst first.
void sort_by(std::vector<BoxPoint>& points, std::size_t stage, const MachineFailures& failures) {
  std::ranges::stable_sort(points, [&](const BoxPoint& a, const BoxPoint& b) {
    return failures.is_worse(a.results[stage], b.results[stage]);
  });
}

/// Runs the points (machines) against each other and keeps the worst, the worst first. After each stage, the
/// worst quarter of the points that have not run all trials goes on. Of this quarter, only points go on that
/// are worse at this stage than the mildest point kept so far, which they would replace.
/// @throws trial::Interrupted, trials::Spent
void race(std::vector<BoxPoint>& points, const MachineBox& box, const MachineFailures& failures,
          const trials::Effort& effort) {
  const auto newcomers = std::stable_partition(
      points.begin(), points.end(), [](const BoxPoint& point) { return point.results.size() == stages; });
  std::vector<BoxPoint> running(newcomers, points.end());
  points.erase(newcomers, points.end());
  for (std::size_t stage = 0; stage < stages; ++stage) {
    simulate(running, stage, box, failures, effort);
    sort_by(running, stage, failures);
    const std::size_t on = std::max((running.size() + race_part - 1) / race_part, survivors / 2);
    if (stage + 1 == stages) break;
    if (running.size() > on) running.resize(on);
    if (points.size() < survivors) continue;
    std::erase_if(running, [&](const BoxPoint& point) {
      return !failures.is_worse(point.results[stage], points.back().results[stage]);
    });
  }
  std::ranges::move(running, std::back_inserter(points));
  sort_by(points, stages - 1, failures);
  if (points.size() > survivors) points.resize(survivors);
}

constexpr std::int64_t trials_of_verdict = 256;
constexpr std::int64_t judged_at_once = 64;
constexpr std::size_t starting_machines = 4;  // the worst of the study, from which the search begins
constexpr std::size_t max_corners = 64;
constexpr std::size_t filling_points = 128;
constexpr int generations = 8;
constexpr std::size_t children = 32;

/// Names and values of the quantities that differ between machines, for a machine of the study.
NamedValues inputs_of_machine(const study::Study& study, std::int64_t point, const WorstMachine& machine) {
  NamedValues named;
  const auto add = [&named](const std::vector<study::InputColumn>& columns, const std::vector<double>& inputs,
                            study::DrawLevel up_to) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (columns[i].level <= up_to) named.emplace_back(columns[i].name, inputs[i]);
  };
  const auto has_columns = [&study](const study::GroupingTraits& of) {
    return !study.columns.shared[of.grouping].empty();
  };
  const bool of_machine = study.machines > 0 && std::ranges::any_of(study::groupings, has_columns);
  if (!of_machine || !study.settings.empty()) {  // what settings override is an input of trials
    add(study.columns.inputs, study::study_trial(study, point, machine.trial).inputs,
        of_machine ? study::DrawLevel::machine : study::DrawLevel::contact);
    return named;
  }
  for (const study::GroupingTraits& of : study::groupings)
    if (has_columns(of))
      add(study.columns.shared[of.grouping],
          study::group_inputs(study, of.grouping, study::group_of(study, of.grouping, machine.machine)),
          study::DrawLevel::contact);
  return named;
}

/// Parameters of trials of the manifest that describes the machine: `count` trials, beginning with number
/// `first`, each `step` numbers apart.
/// @throws Failure if no manifest describes the machine
std::vector<trial::TrialParameters> trials_of_manifest(const JudgedMachine& machine, const MachineBox& box,
                                                       std::int64_t first, std::int64_t step,
                                                       std::int64_t count) {
  const study::Study alone = manifest::parse_study(machine.manifest, box.study().name, {},
                                                   sections::external_inputs_of(box.study()));
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t i = 0; i < count; ++i)
    trials.push_back(study::study_trial(alone, 0, first + i * step).parameters);
  return trials;
}

/// Name of the goal that is met in the smallest proportion of these moves; nothing if there is only one goal.
std::optional<std::string> worst_goal(const study::Study& study,
                                      std::span<const trial::TrialOutcome> outcomes) {
  if (study.goals.size() < 2) return std::nullopt;
  const MachineResult all = result_of(study, outcomes);
  const auto worst = std::ranges::min_element(all.claims, {}, met_proportion);
  return names_of(study, {static_cast<std::size_t>(worst - all.claims.begin()), 0}).goal;
}

/// Judges a machine by the trials of the manifest that describes it. If there is no such manifest, by fresh
/// trials of the box.
/// @param manifest settings for the manifest, such as its number of trials
/// @throws trial::Interrupted, trials::Spent
JudgedMachine judged(const BoxPoint& point, const MachineBox& box, const MachineFailures& failures,
                     const MachineManifest& manifest, const trials::Effort& effort) {
  const study::Study& study = box.study();
  JudgedMachine machine;
  machine.machine = point.machine;
  machine.quantiles = point.quantiles;
  machine.inputs = values_at(study, box.point(), point.quantiles);
  const std::int64_t step = machines_of_manifest(box, point);
  std::vector<trial::TrialParameters> trials;
  std::int64_t first = 0;
  try {
    machine.manifest = manifest_of(box, point, machine.inputs, manifest);
    first = box.has_profile_per_machine() ? point.machine : 0;
    trials = trials_of_manifest(machine, box, first, step, manifest.trials);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input && failure.code() != ExitCode::bad_data) throw;
    machine.manifest.clear();
    machine.no_manifest = failure.what();
    for (std::int64_t i = 0; i < manifest.trials; ++i)
      trials.push_back(box.trial_of(point, study.trials + stage_trials.back() + i));
  }
  const std::vector<trial::TrialOutcome> outcomes = trials::results_of(
      manifest.trials, judged_at_once, [&](std::int64_t i) { return trials[static_cast<std::size_t>(i)]; },
      effort, [](const trial::TrialOutcome& outcome) { return outcome; });
  ClaimResult result;
  failures.add_to(result, outcomes);
  machine.moves = result.moves;
  machine.met = met_proportion(result);
  machine.goal = worst_goal(study, outcomes);
  const auto last = std::ranges::max_element(result.values) - result.values.begin();
  const std::int64_t asked = result.moves / manifest.trials;
  machine.trial = first + last / asked * step;
  return machine;
}

/// The search for the worst machines in one setting (condition at an age).
class MachineSearch {
 public:
  /// @param study study restricted to the setting
  /// @param machines machines of the study
  /// @param condition name of the condition under which the machine runs; empty: there is none
  /// @param folder folder to which paths in the study's manifest are relative; nothing: not a file
  MachineSearch(const study::Study& study, const trials::Replicates& machines, std::string condition,
                const std::optional<std::filesystem::path>& folder, const trials::Effort& effort)
      : box_(study, machines.point),
        machines_(machines),
        manifest_{std::move(condition), folder, trials_of_verdict},
        numbers_{designs::random_key(study.seed, "worst machine"), 0},
        failures_(study, machines.point),
        effort_(effort) {}

  /// Finds the worst machines in the setting (condition at an age).
  /// @param likely_met proportion of moves that meet the goals for the worst likely machine of other
  /// settings; 1 without one. A likely machine is sought only if some machine of the box meets less, because
  /// no likely machine can be worse than the box.
  WorstMachines run(double likely_met) {
    const std::vector<MachineResult> results =
        results_of(box_.study(), machines_, machines_.count, nullptr, effort_);
    const std::vector<std::int64_t> order = ranked_machines(results);
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
    const std::size_t in_box = worst_that([](const BoxPoint&) { return true; });
    std::size_t likely = worst_that([&](const BoxPoint& point) { return box_.is_likely(point); });
    if (likely == named.size()) likely = in_box;  // not sought: no likely machine is worse
    return {worst_machine(box_.study(), machines_.point, results), judgements[1], judgements[in_box],
            judgements[likely], box_.has_profile_per_machine()};
  }

 private:
  /// Indices of the study's machines, the one that meets the smallest proportion of moves first.
  std::vector<std::int64_t> ranked_machines(std::span<const MachineResult> results) const {
    std::vector<std::int64_t> order(results.size());
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::ranges::stable_sort(order, [&](std::int64_t a, std::int64_t b) {
      return failures_.is_worse(worst_result(results[static_cast<std::size_t>(a)]),
                                worst_result(results[static_cast<std::size_t>(b)]));
    });
    return order;
  }

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
    const std::size_t best = std::min(order.size(), starting_machines);
    const std::size_t size = box_.inputs().size();
    std::vector<BoxPoint> points;
    const auto add = [&](const std::vector<double>& place) {
      BoxPoint point{box_.study().machines > 0 ? order[points.size() % best] : 0, {}};
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
    BoxPoint child{parent.machine, parent.quantiles};
    for (double& one : child.quantiles) {
      if (numbers_.uniform() < 0.5)
        one = quantile_at(std::clamp(place_at(one) + step * numbers_.normal(), 0.0, 1.0));
    }
    return child;
  }

  JudgedMachine judge(const BoxPoint& point) const {
    return judged(point, box_, failures_, manifest_, effort_);
  }

  MachineBox box_;
  trials::Replicates machines_;
  MachineManifest manifest_;
  random::NumberSource numbers_;
  MachineFailures failures_;
  trials::Effort effort_;
};

}  // namespace

NamedValues values_at(const study::Study& study, std::int64_t point, std::span<const double> quantiles) {
  const std::vector<study::MachineInput> inputs = study::machine_inputs(study, point);
  NamedValues values;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (auto& one : study::values_at_quantile(study, point, inputs[i], quantiles[i]))
      values.push_back(std::move(one));
  }
  return values;
}

WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const MachineResult> results) {
  const auto merit = [](const MachineResult& machine) { return merit_of(worst_result(machine)); };
  const auto number =
      static_cast<std::size_t>(std::ranges::min_element(results, {}, merit) - results.begin());
  const std::size_t claim = worst_claim(results[number]);
  const ClaimResult& result = results[number].claims[claim];
  WorstMachine machine{
      static_cast<std::int64_t>(number), 0, met_proportion(result), {}, place_of_claim(study, claim)};
  const std::int64_t asked =
      measures::asked_moves(measures::move_criteria_of(study)[machine.claim.goal], study.moves);
  const std::int64_t trial_in_setting =
      (std::ranges::max_element(result.values) - result.values.begin()) / asked;
  machine.trial = trials::trial_of_replicate(
      study, {.count = std::ssize(results)}, machine.machine,
      trial_in_setting * study.settings.total() + static_cast<std::int64_t>(machine.claim.setting));
  machine.inputs = inputs_of_machine(study, point, machine);
  machine.names = names_of(study, machine.claim);
  return machine;
}

std::int64_t trials_of_worst_machines(const study::Study& study, const trials::Replicates& machines) {
  // A race takes 4 trials of each machine, 12 more of a quarter, and 48 more of a quarter of these.
  constexpr auto of_newcomer =
      stage_trials[0] + (stage_trials[1] - stage_trials[0]) / 4 + (stage_trials[2] - stage_trials[1]) / 16;
  constexpr auto first = static_cast<std::int64_t>(starting_machines + max_corners + filling_points);
  constexpr auto later = static_cast<std::int64_t>(generations * children);
  return machines.trials() + study.settings.total() * (of_newcomer * (first + later) + 3 * trials_of_verdict);
}

WorstMachines worst_machines(const study::Study& study, const trials::Replicates& machines,
                             const std::optional<std::filesystem::path>& folder,
                             const trials::Effort& effort) {
  std::vector<WorstMachines> in_each;  // [setting]
  double likely_met = 1.0;
  trials::Replicates alone = machines;
  alone.trials_each /= study.settings.total();
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    MachineSearch search(in_setting(study, setting), alone, study::condition_of(study.settings, setting),
                         folder, effort);
    WorstMachines& found = in_each.emplace_back(search.run(likely_met));
    likely_met = std::min(likely_met, found.likely.met);
    found.of_study.claim.setting = static_cast<std::size_t>(setting);
    found.of_study.trial = study::trial_indices(study).trial_of(found.of_study.trial, setting);
    found.of_study.names = names_of(study, found.of_study.claim);
    for (JudgedMachine* one : {&found.again, &found.in_box, &found.likely}) {
      one->setting = setting;
      one->setting_name = found.of_study.names.setting;
    }
  }
  const auto worst_by = [&](const auto& met) { return *std::ranges::min_element(in_each, {}, met); };
  const auto is_same = [](const JudgedMachine& a, const JudgedMachine& b) {
    return a.setting == b.setting && a.machine == b.machine && a.quantiles == b.quantiles;
  };
  WorstMachines found = worst_by([](const WorstMachines& one) { return one.of_study.met; });
  const WorstMachines in_box = worst_by([](const WorstMachines& one) { return one.in_box.met; });
  found.in_box = in_box.in_box;
  found.with_profiles = in_box.with_profiles;
  found.likely = worst_by([](const WorstMachines& one) { return one.likely.met; }).likely;
  found.in_box.is_previous = is_same(found.in_box, found.again);
  found.likely.is_previous = is_same(found.likely, found.in_box);
  const study::Study under_worst = in_setting(study, found.in_box.setting);
  const auto all_at = [&](double place) {
    NamedValues values;
    for (const study::MachineInput& one : study::machine_inputs(under_worst, machines.point)) {
      if (one.slots.size() > 1) continue;  // the rows of joint samples have no order
      for (const auto& value :
           study::values_at_quantile(under_worst, machines.point, one, quantile_at(place)))
        values.push_back(value);
    }
    return values;
  };
  found.edges = {all_at(0.0), all_at(0.5), all_at(1.0)};
  return found;
}

}  // namespace zerocount::tuning
