#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Bounded;
using document::Shown;
using Verdict = const goal::Verdict&;

/// The proportion with its bounds at a point, as people are shown it.
auto at_point(goal::BoundedProportion goal::Verdict::*proportion) {
  return [proportion](const PointReading& p) -> std::optional<Bounded> {
    if (!p.verdict) return std::nullopt;
    return goal::bounded((*p.verdict).*proportion);
  };
}

std::string goal_legend(const summary::StudySummary& summary) {
  return fmt::format(
      "in goal: {}{}; one-sided {} bounds of each point alone, in %",
      goal::goal_sentence(*summary.question.claim()),
      summary.question.worlds > 0 ? ", in the worst world; bounds of the worst of all worlds" : "",
      text::percent(summary.question.claim()->confidence));
}

}  // namespace

document::Description<goal::Verdict> verdict_description(const study::Goal& goal, bool on_rigs) {
  document::Description<goal::Verdict> description;
  description
      .value({.key = "status", .meaning = "verdict on the goal", .words = goal::status_words()},
             [](Verdict v) { return goal::text_of(v.status); })
      .value({.key = "rate",
              .meaning = "proportion of moves that meet the goal, with one-sided bounds; with worlds of the "
                         "worst world",
              .unit = "1"},
             [](Verdict v) { return goal::bounded(v.moves); });
  if (goal.machines)
    description.value({.key = "machines",
                       .meaning = "proportion of machines that meet the goal, with one-sided bounds; with "
                                  "worlds of the worst world",
                       .unit = "1"},
                      [](Verdict v) { return goal::bounded(v.machines); });
  if (on_rigs)
    description.value({.key = "rigs_without_miss", .meaning = "rigs all of whose moves meet the goal"},
                      &goal::Verdict::rigs_without_miss);
  return description;
}

void add_goal(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.question.claim()) return;
  const std::string where = summary.question.worlds > 0 ? " (worst world)" : "";
  const auto column = [&](const std::string& of) {
    return document::Item{.heading = of + " in goal" + where,
                          .unit = "1",
                          .notation = document::Notation::percent,
                          .shown = Shown::to_people};
  };
  point
      .object({.key = "goal",
               .meaning = "whether the point meets the goal, with bounds of this point alone",
               .shown = Shown::in_data},
              verdict_description(*summary.question.claim(), summary.features.rigs), &PointReading::verdict)
      .value({.heading = "goal", .meaning = goal_legend(summary), .shown = Shown::to_people},
             [](const PointReading& p) { return p.verdict ? goal::text_of(p.verdict->status) : "–"; });
  if (summary.question.claim()->machines) point.value(column("machines"), at_point(&goal::Verdict::machines));
  point.value(column("moves"), at_point(&goal::Verdict::moves));
}

}  // namespace zerocount::summary_answer
