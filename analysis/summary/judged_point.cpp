#include "analysis/summary/judged_point.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/summary/best_point.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

const measures::GoalCounts& counts_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)].goal.value();
}

/// "the goal is met", "the goal is missed", "undecided".
std::string verdict_words(goal::Status status) {
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

/// "point 3 (kp=400), the best of 8 points".
std::string name_of_point(const StudySummary& summary, const JudgedPoint& judged) {
  const std::string label = text::printable(summary.labels[static_cast<std::size_t>(judged.point)]);
  const std::string name = summary.points.size() == 1 ? fmt::format("'{}'", label)
                                                      : fmt::format("point {} ({})", judged.point, label);
  return judged.chosen_from > 1 ? fmt::format("{}, the best of {} points", name, judged.chosen_from) : name;
}

}  // namespace

JudgedPoint judge_point(const StudySummary& summary, std::optional<std::int64_t> point) {
  JudgedPoint judged;
  judged.point = point ? *point : best_point(summary.points, summary.goal);
  if (!point) {
    judged.chosen_from = std::ranges::count_if(
        summary.points, [](const measures::PointSummary& one) { return one.trials > 0; });
  }
  const auto points = static_cast<std::size_t>(judged.chosen_from);
  const measures::GoalCounts& counts = counts_of(summary, judged.point);
  judged.verdict = goal::judge_goal(*summary.goal, counts, points);
  if (judged.verdict.status == goal::Status::undecided)
    judged.needs = goal::needs_of(*summary.goal, counts, points);
  return judged;
}

std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged) {
  std::string text =
      fmt::format("goal: {}\n{}: {}\n{}", goal::goal_sentence(*summary.goal), name_of_point(summary, judged),
                  verdict_words(judged.verdict.status),
                  goal::readings_text(*summary.goal, counts_of(summary, judged.point), judged.verdict));
  if (judged.chosen_from > 1) text += "  the bounds allow for the choice of the point by these trials\n";
  if (judged.needs)
    text += fmt::format("  {}\n", goal::needs_sentence(*summary.goal, *judged.needs, summary.features.rigs));
  return text;
}

}  // namespace zerocount::summary
