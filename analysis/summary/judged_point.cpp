#include "analysis/summary/judged_point.hpp"

#include <fmt/format.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/summary/worlds_of_point.hpp"

namespace zerocount::summary {
namespace {

const measures::MoveCounts& counts_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)].goal.value();
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
  const measures::MoveCounts& counts = counts_of(summary, chosen.point);
  judged.verdict = verdict_on(summary.question, counts, points);
  if (judged.verdict.status == goal::Status::undecided)
    judged.needs = goal::needs_of(*summary.question.claim(), counts, points);
  return judged;
}

std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged) {
  return fmt::format("{}: {}", name_of_chosen(summary, judged.chosen), verdict_words(judged.verdict.status));
}

std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged) {
  const ChosenPoint& chosen = judged.chosen;
  const study::Goal& goal = *summary.question.claim();
  std::string text = goal::readings_text(goal, counts_of(summary, chosen.point), judged.verdict);
  if (chosen.chosen_from > 1) text += "  the bounds allow for the choice of the point by these trials\n";
  if (const auto worlds = worlds_of_point(summary, chosen.point, points_of(chosen)))
    text += fmt::format(
        "  {}\n", bad_worlds_sentence(*worlds, world_inputs_of(summary, chosen.point), summary.question));
  if (judged.needs)
    text += fmt::format("  {}\n", goal::needs_sentence(goal, *judged.needs, summary.features.rigs));
  return text + competition_text(summary, chosen);
}

std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged) {
  return fmt::format("goal: {}\n{}\n{}", goal::goal_sentence(*summary.question.claim()),
                     judgement_headline(summary, judged), judgement_details(summary, judged));
}

}  // namespace zerocount::summary
