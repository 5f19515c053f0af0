#include "analysis/goal/lives.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/statistics/clusters/rig_proportion.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::goal {
namespace {

/// One goal under one condition at one age.
struct ClaimAtAge {
  const study::Goal* goal;
  measures::CellCounts counts;
  std::vector<statistics::RigMoves> rigs;  ///< of the counts
};

std::vector<ClaimAtAge> claims_at_age(const Question& question,
                                      const std::vector<measures::CellCounts>& counts, std::size_t age) {
  const std::size_t of_age = question.conditions.size() / question.ages.at.size();
  std::vector<ClaimAtAge> claims;
  for (const JudgedPart& part : question.parts) {
    for (std::size_t c = 0; c < of_age; ++c) {
      const measures::CellCounts one = counts[part.number].under(age * of_age + c);
      claims.push_back({&*part.claim, one, one.sum().rigs});
    }
  }
  return claims;
}

bool meets(const ClaimAtAge& claim, std::size_t rig) {
  const statistics::RigMoves& moves = claim.rigs[rig];
  return statistics::rate(moves.met, moves.moves) >= claim.goal->moves;
}

bool meets_all(const std::vector<ClaimAtAge>& claims, std::size_t rig) {
  return std::ranges::all_of(claims, [rig](const ClaimAtAge& claim) { return meets(claim, rig); });
}

std::size_t rig_count(const std::vector<ClaimAtAge>& claims) {
  return claims.front().rigs.size();
}

/// The proportion of the rigs that meet all claims; with worlds the least of them.
double proportion_meeting(const std::vector<ClaimAtAge>& claims, std::int64_t worlds) {
  const auto groups = static_cast<std::size_t>(std::max<std::int64_t>(worlds, 1));
  double least = 1.0;
  for (std::size_t world = 0; world < groups; ++world) {
    std::int64_t meeting = 0;
    std::int64_t rigs = 0;
    for (std::size_t rig = world; rig < rig_count(claims); rig += groups, ++rigs)
      meeting += meets_all(claims, rig) ? 1 : 0;
    least = std::min(least, statistics::rate(meeting, rigs));
  }
  return least;
}

/// The upper bound of the machines that meet one of so many claims.
double most_of(const ClaimAtAge& claim, std::size_t claims) {
  constexpr double usual = 0.9;
  study::Goal goal = *claim.goal;
  goal.machines = goal.machines.value_or(usual);
  goal.confidence = statistics::confidence_of_each(goal.confidence, claims);
  return judge_goal(goal, claim.counts, 1).machines.high;
}

/// The moves of a rig in which it meets one goal, under the condition where these are the fewest; as if the
/// moves that it made under some conditions only met the goal, and were left out.
statistics::RigMoves least_moves(const std::vector<ClaimAtAge>& claims, std::size_t rig) {
  statistics::RigMoves least = claims.front().rigs[rig];
  for (const ClaimAtAge& claim : claims) {
    const statistics::RigMoves& one = claim.rigs[rig];
    const std::int64_t missed = std::max(least.moves - least.met, one.moves - one.met);
    least.trials = std::min(least.trials, one.trials);
    least.moves = std::min(least.moves, one.moves);
    least.met = least.moves - missed;
  }
  return least;
}

/// The lower bound of the machines that meet one goal under every condition, at this confidence; with worlds
/// the least of them.
double least_of(const std::vector<ClaimAtAge>& claims, std::int64_t worlds, double confidence) {
  constexpr double usual = 0.9;
  const study::Goal& goal = *claims.front().goal;
  const statistics::RigClaim claim{.proportion = goal.moves,
                                   .wanted = goal.machines.value_or(usual),
                                   .confidence = confidence,
                                   .of_least = claims.size() > 1};
  const auto groups = static_cast<std::size_t>(std::max<std::int64_t>(worlds, 1));
  double least = 1.0;
  for (std::size_t world = 0; world < groups; ++world) {
    std::vector<statistics::RigMoves> rigs;
    for (std::size_t rig = world; rig < rig_count(claims); rig += groups)
      rigs.push_back(least_moves(claims, rig));
    least = std::min(least, statistics::rig_proportion(rigs, claim).low);
  }
  return least;
}

/// Groups claims, which are in the order of their goals, by goal.
std::vector<std::vector<ClaimAtAge>> by_goals(const std::vector<ClaimAtAge>& claims) {
  std::vector<std::vector<ClaimAtAge>> goals;
  for (const ClaimAtAge& claim : claims) {
    if (goals.empty() || goals.back().front().goal != claim.goal) goals.emplace_back();
    goals.back().push_back(claim);
  }
  return goals;
}

}  // namespace

std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts) {
  std::vector<BoundedProportion> machines;
  for (std::size_t age = 0; age < question.ages.at.size(); ++age) {
    const std::vector<ClaimAtAge> claims = claims_at_age(question, counts, age);
    const std::vector<std::vector<ClaimAtAge>> goals = by_goals(claims);
    BoundedProportion all{proportion_meeting(claims, question.worlds), 1.0, 1.0};
    double lost = 0.0;
    for (const std::vector<ClaimAtAge>& goal : goals) {
      const double confidence = statistics::confidence_of_each(goal.front().goal->confidence, goals.size());
      lost += 1.0 - least_of(goal, question.worlds, confidence);
    }
    all.low = std::max(1.0 - lost, 0.0);
    for (const ClaimAtAge& claim : claims) all.high = std::min(all.high, most_of(claim, claims.size()));
    machines.push_back(all);
  }
  return machines;
}

std::vector<double> lives_of_rigs(const Question& question, const std::vector<measures::CellCounts>& counts) {
  std::vector<double> lives;
  std::vector<bool> alive;
  for (std::size_t age = 0; age < question.ages.at.size(); ++age) {
    const std::vector<ClaimAtAge> claims = claims_at_age(question, counts, age);
    if (age == 0) {
      lives.assign(rig_count(claims), statistics::unknown);
      alive.assign(rig_count(claims), true);
    }
    for (std::size_t rig = 0; rig < lives.size(); ++rig) {
      alive[rig] = alive[rig] && meets_all(claims, rig);
      if (alive[rig]) lives[rig] = question.ages.at[age];
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
