#include "analysis/summary/judged_point.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/summary/worlds_of_point.hpp"

namespace zerocount::summary {
namespace {

const measures::PointSummary& statistics_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)];
}

/// The goal that the verdict is of.
const study::Goal& worst_goal(const StudySummary& summary, const goal::Verdict& verdict) {
  return *summary.question.parts[verdict.goal].claim;
}

/// "'large' and 'small'"; empty where fewer than two goals are missed.
std::string missed_goals(const goal::Question& question, const goal::Verdict& verdict) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < question.parts.size(); ++i) {
    if (worst_of_goal(verdict, i).status == goal::Status::missed)
      names.push_back(fmt::format("'{}'", question.parts[i].claim->name));
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

std::string_view verdict_words(goal::Status status) {
  switch (status) {
    case goal::Status::met:
      return "the goal is met";
    case goal::Status::missed:
      return "the goal is missed";
    case goal::Status::undecided:
      break;
  }
  return "it is undecided whether the goal is met";
}

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
  const std::string under = under_text(question, judged.verdict.condition);
  const std::string worst =
      has_several(question) ? fmt::format(" '{}'", worst_goal(summary, judged.verdict).name) : "";
  switch (judged.verdict.status) {
    case goal::Status::met:
      if (has_several(question))
        return fmt::format("{}: all {} goals are met,{} by the least{}", name, question.parts.size(), worst,
                           under);
      return fmt::format("{}: the goal is met{}", name, under.empty() ? "" : ", by the least" + under);
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
                                                       summary.features.rigs));
  return text + competition_text(summary, chosen);
}

std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged) {
  return fmt::format("goal: {}\n{}\n{}", goal::claim_sentence(summary.question),
                     judgement_headline(summary, judged), judgement_details(summary, judged));
}

}  // namespace zerocount::summary
