#include "analysis/goal/lives.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::goal {
namespace {

/// One goal under one condition at one age.
struct ClaimAtAge {
  const study::Goal* goal;
  const measures::MoveCounts* counts;
};

std::vector<ClaimAtAge> claims_at_age(const Question& question,
                                      const std::vector<measures::MoveCounts>& counts, std::size_t age) {
  const std::size_t of_age = question.conditions.size() / question.ages.at.size();
  std::vector<ClaimAtAge> claims;
  for (const JudgedPart& part : question.parts) {
    for (std::size_t c = 0; c < of_age; ++c)
      claims.push_back({&*part.claim, &measures::under_condition(counts[part.number], age * of_age + c)});
  }
  return claims;
}

bool meets(const ClaimAtAge& claim, std::size_t rig) {
  const statistics::RigMoves& moves = claim.counts->rigs[rig];
  return statistics::rate(moves.met, moves.moves) >= claim.goal->moves;
}

bool meets_all(const std::vector<ClaimAtAge>& claims, std::size_t rig) {
  return std::ranges::all_of(claims, [rig](const ClaimAtAge& claim) { return meets(claim, rig); });
}

std::size_t rig_count(const std::vector<ClaimAtAge>& claims) {
  return claims.front().counts->rigs.size();
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

/// Bounds of the machines that meet one claim, whatever proportion of them it is about.
BoundedProportion machines_of(const ClaimAtAge& claim, std::size_t claims) {
  constexpr double usual = 0.9;
  study::Goal goal = *claim.goal;
  goal.machines = goal.machines.value_or(usual);
  goal.confidence = statistics::confidence_of_each(goal.confidence, claims);
  return judge_goal(goal, *claim.counts, 1, 1).machines;
}

}  // namespace

std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::MoveCounts>& counts) {
  std::vector<BoundedProportion> machines;
  for (std::size_t age = 0; age < question.ages.at.size(); ++age) {
    const std::vector<ClaimAtAge> claims = claims_at_age(question, counts, age);
    BoundedProportion all{proportion_meeting(claims, question.worlds), 1.0, 1.0};
    for (const ClaimAtAge& claim : claims) {
      const BoundedProportion one = machines_of(claim, claims.size());
      all.low -= 1.0 - one.low;
      all.high = std::min(all.high, one.high);
    }
    all.low = claims.size() == 1 ? machines_of(claims.front(), 1).low : std::max(all.low, 0.0);
    machines.push_back(all);
  }
  return machines;
}

std::vector<double> lives_of_rigs(const Question& question, const std::vector<measures::MoveCounts>& counts) {
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
