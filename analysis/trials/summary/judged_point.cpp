#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {
namespace {

const measures::PointSummary& statistics_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)];
}

/// The goal that belongs to the worst claim of the verdict.
const study::Goal& worst_goal(const StudySummary& summary, const goal::Verdict& verdict) {
  return *summary.question.parts[verdict.goal].goal;
}

/// Names of the goals that are missed: "'large' and 'small'". Empty if fewer than two are missed.
std::string missed_goals(const goal::Question& question, const goal::Verdict& verdict) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < question.parts.size(); ++i) {
    if (worst_of_goal(verdict, i).status == goal::Status::missed)
      names.push_back(fmt::format("'{}'", question.parts[i].goal->name));
  }
  if (names.size() < 2) return "";
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::size_t points_of(const ChosenPoint& chosen) {
  return static_cast<std::size_t>(chosen.chosen_from);
}

}  // namespace

JudgedPoint judge_point(const StudySummary& summary, const ChosenPoint& chosen) {
  JudgedPoint judged{chosen, {}, {}};
  const std::size_t points = points_of(chosen);
  const measures::PointSummary& statistics = statistics_of(summary, chosen.point);
  judged.verdict = verdict_on(summary.question, statistics, points);
  if (judged.verdict.status == goal::Status::undecided)
    judged.needs = needs_of(summary.question, statistics, points);
  return judged;
}

std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged) {
  const goal::Question& question = summary.question;
  const std::string name = name_of_chosen(summary, judged.chosen);
  const std::string under = under_text(question, judged.verdict.setting);
  const study::Goal& goal = worst_goal(summary, judged.verdict);
  const std::string worst =
      (has_several(question) ? fmt::format(" '{}'", goal.name) : "") + goal::of_mass(goal);
  switch (judged.verdict.status) {
    case goal::Status::met:
      if (has_several(question))
        return fmt::format("{}: all {} goals are met,{} by the least{}", name, question.parts.size(), worst,
                           under);
      return fmt::format("{}: the goal{} is met{}", name, worst,
                         under.empty() ? "" : ", by the least" + under);
    case goal::Status::missed:
      if (const std::string all = missed_goals(question, judged.verdict); !all.empty())
        return fmt::format("{}: the goals {} are missed,{} by the most{}", name, all, worst, under);
      return fmt::format("{}: the goal{} is missed{}", name, worst, under);
    case goal::Status::undecided:
      break;
  }
  return fmt::format("{}: it is undecided whether the goal{} is met{}", name, worst, under);
}

std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged) {
  const ChosenPoint& chosen = judged.chosen;
  std::string text = goal::goals_text(summary.question, statistics_of(summary, chosen.point), judged.verdict);
  if (chosen.chosen_from > 1) text += "  the bounds allow for the choice of the point by these trials\n";
  if (const auto worlds = worlds_of_point(summary, chosen.point, points_of(chosen)))
    text += fmt::format(
        "  {}\n", bad_worlds_sentence(*worlds, world_inputs_of(summary, chosen.point), summary.question));
  if (judged.needs)
    text += fmt::format("  {}\n", goal::needs_sentence(worst_goal(summary, judged.verdict), *judged.needs,
                                                       summary.features.machines));
  return text + competition_text(summary, chosen);
}

std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged) {
  return fmt::format("goal: {}\n{}\n{}", goal::claim_sentence(summary.question),
                     judgement_headline(summary, judged), judgement_details(summary, judged));
}

std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim) {
  if (layout::has_sums(study.retention)) return {};
  const reading::AllTrialsFile all(path);
  const reading::AllTrialsFile file = all.in_setting(static_cast<std::int64_t>(claim.setting));
  const measures::MoveCriterion goal = measures::move_criteria_of(study)[claim.goal];
  const std::int64_t trials = file.header().trials;
  SaturatedMoves counts;
  measures::visit_trials(file, {claim.point * trials, trials}, [&](std::int64_t, const auto& moves) {
    for (const trial::MoveOutcome& move : moves) {
      if (!measures::asks(goal, move)) continue;
      const bool met = measures::meets(goal, move);
      ++(met ? counts.met : counts.missed);
      if (move.saturated) ++(met ? counts.met_saturated : counts.missed_saturated);
    }
  });
  return counts;
}

std::string saturation_sentence(const SaturatedMoves& moves) {
  constexpr double most = 0.5;
  constexpr double more = 0.1;  // of the moves: both kinds saturate alike where long moves accelerate
  if (moves.missed == 0 || moves.of_missed() < most) return "";
  if (moves.met > 0 && moves.of_missed() - moves.of_met() < more) return "";
  const std::string others =
      moves.met > 0 ? fmt::format(" (of the {} others {})", moves.met, moves.met_saturated) : "";
  return fmt::format(
      "  of the {} moves that miss the goal {} saturate{}: the converter clips the torque that the "
      "controller "
      "wants, and its range may be the cause\n",
      moves.missed, moves.missed_saturated, others);
}

}  // namespace zerocount::summary
