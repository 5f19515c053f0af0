#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <type_traits>
#include <utility>

#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/goal/question.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::goal {
namespace {

/// One goal in one setting at one age, with the counts of the moves on each machine.
struct ClaimAtAge {
  /// The goal, always demanding a proportion of machines: a goal on moves is given a usual one.
  study::Goal goal;
  measures::CellCounts counts;
  /// [machine] Numbers of judged moves and of moves that meet the goal, from `counts`.
  std::vector<statistics::MachineMoves> machines;

  bool is_met_by(std::size_t machine) const {
    return statistics::rate(machines[machine].met, machines[machine].moves) >= goal.moves;
  }
};
using ClaimsAtAge = std::vector<std::vector<ClaimAtAge>>;  ///< [goal][setting] The claims at one age.

ClaimsAtAge claims_at_age(const Question& question, const std::vector<measures::CellCounts>& counts,
                          std::size_t age) {
  constexpr double usual_machines = 0.9;
  const std::vector<std::int64_t> settings =
      study::settings_at_age(question.settings.counts(), static_cast<std::int64_t>(age));
  ClaimsAtAge claims;
  for (const JudgedCriterion& part : question.parts) {
    study::Goal goal = *part.goal;
    goal.machines = goal.machines.value_or(usual_machines);
    std::vector<ClaimAtAge>& of_goal = claims.emplace_back();
    for (const std::int64_t setting : settings) {
      measures::CellCounts one = counts[part.number].in_setting(static_cast<std::size_t>(setting));
      std::vector<statistics::MachineMoves> machines = one.sum().machines;
      of_goal.push_back({goal, std::move(one), std::move(machines)});
    }
  }
  return claims;
}

bool meets_all(const ClaimsAtAge& claims, std::size_t machine) {
  return std::ranges::all_of(std::views::join(claims),
                             [machine](const ClaimAtAge& claim) { return claim.is_met_by(machine); });
}

std::size_t machine_count(const ClaimsAtAge& claims) {
  return claims.front().front().machines.size();
}

/// The minimum over the worlds of `of(values)`, at most 1. `values` holds value(machine) of the machines in
/// the world; without worlds all machines form one group.
/// @param worlds number of worlds; 0: none
template <class Value, class Of>
double least_of_worlds(std::size_t machines, std::int64_t worlds, const Value& value, const Of& of) {
  const auto groups = static_cast<std::size_t>(std::max<std::int64_t>(worlds, 1));
  double least = 1.0;
  for (std::size_t world = 0; world < groups; ++world) {
    std::vector<std::invoke_result_t<Value, std::size_t>> values;
    for (std::size_t machine = world; machine < machines; machine += groups) values.push_back(value(machine));
    least = std::min(least, of(values));
  }
  return least;
}

/// Observed proportion of machines that meet all claims, in the worst world.
/// @param worlds number of worlds; 0: none
double proportion_meeting(const ClaimsAtAge& claims, std::int64_t worlds) {
  return least_of_worlds(
      machine_count(claims), worlds, [&](std::size_t machine) { return meets_all(claims, machine); },
      [](const std::vector<bool>& meeting) {
        return statistics::rate(std::ranges::count(meeting, true), std::ssize(meeting));
      });
}

/// Upper bound of the proportion of machines that meet this claim (one goal in one setting).
/// @param claims number of claims that share the error probability (Bonferroni)
double most_of(const ClaimAtAge& claim, std::size_t claims) {
  study::Goal goal = claim.goal;
  goal.confidence = statistics::confidence_of_each(goal.confidence, claims);
  return judge_goal(goal, claim.counts, 1).machines.high;
}

/// Numbers of moves of a machine in the setting in which the fewest of its moves meet the goal. If the
/// machine made more moves in some settings than in others, the surplus moves count as met and are left out.
/// @param settings the claims on one goal in each setting
statistics::MachineMoves least_moves(const std::vector<ClaimAtAge>& settings, std::size_t machine) {
  statistics::MachineMoves least = settings.front().machines[machine];
  for (const ClaimAtAge& claim : settings) {
    const statistics::MachineMoves& one = claim.machines[machine];
    const std::int64_t missed = std::max(least.moves - least.met, one.moves - one.met);
    least.trials = std::min(least.trials, one.trials);
    least.moves = std::min(least.moves, one.moves);
    least.met = least.moves - missed;
  }
  return least;
}

/// Lower bound of the proportion of machines that meet one goal in every setting, in the worst world.
/// @param settings the claims on this goal in each setting
/// @param goals number of goals that share the error probability (Bonferroni)
double least_of(const std::vector<ClaimAtAge>& settings, std::int64_t worlds, std::size_t goals) {
  const study::Goal& goal = settings.front().goal;
  const statistics::MachineClaim claim{.proportion = goal.moves,
                                       .wanted = *goal.machines,
                                       .confidence = statistics::confidence_of_each(goal.confidence, goals),
                                       .of_least = settings.size() > 1};
  return least_of_worlds(
      settings.front().machines.size(), worlds,
      [&](std::size_t machine) { return least_moves(settings, machine); },
      [&](const std::vector<statistics::MachineMoves>& machines) {
        return statistics::machine_proportion(machines, claim).low;
      });
}

}  // namespace

std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts) {
  std::vector<BoundedProportion> machines;
  for (std::size_t age = 0; age < question.settings.ages.at.size(); ++age) {
    const ClaimsAtAge claims = claims_at_age(question, counts, age);
    BoundedProportion all{proportion_meeting(claims, question.worlds), 1.0, 1.0};
    double lost = 0.0;
    for (const std::vector<ClaimAtAge>& settings : claims)
      lost += 1.0 - least_of(settings, question.worlds, claims.size());
    all.low = std::max(1.0 - lost, 0.0);
    for (const ClaimAtAge& claim : std::views::join(claims))
      all.high = std::min(all.high, most_of(claim, claims.size() * claims.front().size()));
    machines.push_back(all);
  }
  return machines;
}

std::vector<double> lives_of_machines(const Question& question,
                                      const std::vector<measures::CellCounts>& counts) {
  std::vector<double> lives;
  for (std::size_t age = 0; age < question.settings.ages.at.size(); ++age) {
    const ClaimsAtAge claims = claims_at_age(question, counts, age);
    lives.resize(machine_count(claims), statistics::unknown);
    for (std::size_t machine = 0; machine < lives.size(); ++machine) {
      const bool lived = age == 0 || lives[machine] == question.settings.ages.at[age - 1];
      if (lived && meets_all(claims, machine)) lives[machine] = question.settings.ages.at[age];
    }
  }
  return lives;
}

std::vector<Survival> survival_of(const std::vector<double>& lives, const std::vector<double>& ages,
                                  double confidence) {
  std::vector<Survival> curve;
  const std::int64_t all = std::ssize(lives);
  for (const double age : ages) {
    const std::int64_t living = std::ranges::count_if(lives, [age](double life) { return life >= age; });
    curve.push_back({living,
                     {statistics::rate(living, all), statistics::proportion_at_least(living, all, confidence),
                      statistics::proportion_at_most(living, all, confidence)}});
  }
  return curve;
}

}  // namespace zerocount::goal
