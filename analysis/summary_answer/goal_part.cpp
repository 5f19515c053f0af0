#include <algorithm>

#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/statistics/sample_size.hpp"
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
      "in goal: {}{}; one-sided {} bounds of each point alone, in %", goal::claim_sentence(summary.question),
      summary.question.worlds > 0 ? ", in the worst world; bounds of the worst of all worlds" : "",
      text::percent(summary.question.claim()->confidence));
}

}  // namespace

document::Description<goal::Verdict> verdict_description(const goal::Question& question, bool on_rigs) {
  document::Description<goal::Verdict> description;
  const bool has_machines = std::ranges::any_of(
      question.parts, [](const goal::JudgedPart& part) { return part.claim->machines.has_value(); });
  if (has_names(question))
    description.value({.key = "name",
                       .meaning = "name of the goal: of several the worst, which all of this is of",
                       .optional = true},
                      [question](Verdict v) { return question.parts[v.goal].claim->name; });
  if (!question.conditions.empty())
    description.value(
        {.key = "condition", .meaning = "the worst condition, which all of this is under", .optional = true},
        [question](Verdict v) { return question.conditions[v.condition]; });
  description
      .value({.key = "status", .meaning = "verdict on the goal", .words = goal::status_words()},
             [](Verdict v) { return goal::text_of(v.status); })
      .value({.key = "rate",
              .meaning = "proportion of moves that meet the goal, with one-sided bounds; with worlds of the "
                         "worst world",
              .unit = "1"},
             [](Verdict v) { return goal::bounded(v.moves); });
  if (has_machines) {
    const auto of_machines = [question](goal::BoundedProportion goal::Verdict::*proportion) {
      return [question, proportion](Verdict v) -> std::optional<document::Bounded> {
        if (!question.parts[v.goal].claim->machines) return std::nullopt;
        return goal::bounded(v.*proportion);
      };
    };
    description
        .value({.key = "machines",
                .meaning = "proportion of machines that meet the goal, with one-sided bounds; with "
                           "worlds of the worst world; left out where the goal is not on machines",
                .unit = "1",
                .optional = true},
               of_machines(&goal::Verdict::machines))
        .value({.key = "without_miss",
                .meaning = "proportion of machines without a miss in as many moves as these have, with "
                           "one-sided bounds; left out where the goal is not on machines",
                .unit = "1",
                .optional = true},
               of_machines(&goal::Verdict::without_miss))
        .value({.key = "trials_of_one_machine",
                .meaning = "trials without a miss that show of one machine that it meets the goal; left out "
                           "where the goal is not on machines",
                .optional = true},
               [question](Verdict v) -> std::optional<std::int64_t> {
                 const study::Goal& claim = *question.parts[v.goal].claim;
                 if (!claim.machines) return std::nullopt;
                 return statistics::trials_for_claim(claim.moves, claim.confidence, 0);
               });
  }
  if (on_rigs)
    description.value({.key = "rigs_without_miss", .meaning = "rigs all of whose moves meet the goal"},
                      &goal::Verdict::rigs_without_miss);
  return description;
}

document::Description<goal::Verdict> goals_description(const goal::Question& question, bool on_rigs) {
  document::Description<goal::Verdict> goals;
  for (const goal::JudgedPart& part : question.parts) {
    const std::size_t number = part.number;
    goals.object({.key = part.claim->name, .meaning = goal::goal_sentence(*part.claim)},
                 verdict_description(only(question, number), on_rigs),
                 [number](Verdict v) { return v.goals.empty() ? v : v.goals.at(number); });
  }
  return goals;
}

void add_goal(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.question.claim()) return;
  const goal::Question& question = summary.question;
  const bool several = has_names(question);
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
              verdict_description(question, summary.features.rigs), &PointReading::verdict)
      .value({.heading = "goal", .meaning = goal_legend(summary), .shown = Shown::to_people},
             [](const PointReading& p) { return p.verdict ? goal::text_of(p.verdict->status) : "–"; });
  if (several) {
    point
        .value({.heading = "worst goal",
                .meaning = "the goal that the next columns are of",
                .shown = Shown::to_people},
               [question](const PointReading& p) {
                 return p.verdict ? question.parts[p.verdict->goal].claim->name : "–";
               })
        .object({.key = "goals",
                 .meaning = "each of the goals, by name",
                 .shown = Shown::in_data,
                 .free_keys = true},
                goals_description(question, summary.features.rigs), &PointReading::verdict);
  }
  if (!question.conditions.empty())
    point.value({.heading = "worst condition",
                 .meaning = "the condition that the next columns are of",
                 .shown = Shown::to_people},
                [question](const PointReading& p) {
                  return p.verdict ? question.conditions[p.verdict->condition] : "–";
                });
  if (several || !question.conditions.empty()) {
    point.value(
        {.key = "machines_together",
         .meaning = "proportion of rigs that meet all goals on machines, as observed; nothing where only one "
                    "claim is on machines",
         .unit = "1",
         .shown = Shown::in_data},
        [question](const PointReading& p) -> std::optional<double> {
          const auto all = goal::rigs_meeting_all(question, p.statistics());
          if (!all) return std::nullopt;
          return statistics::rate(all->rigs, all->of);
        });
  }
  const bool has_machines = std::ranges::any_of(
      question.parts, [](const goal::JudgedPart& part) { return part.claim->machines.has_value(); });
  if (has_machines) point.value(column("machines"), at_point(&goal::Verdict::machines));
  point.value(column("moves"), at_point(&goal::Verdict::moves));
}

}  // namespace zerocount::summary_answer
