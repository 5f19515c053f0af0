#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary_answer/parts.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using Point = const DescribedPoint&;
using Verdict = const goal::ClaimVerdict&;

std::optional<summary::WorldsAtPoint> worlds_at(Point p) {
  if (!p.worlds) return std::nullopt;
  return summary::WorldsAtPoint{*p.worlds, summary::world_inputs_of(p.summary, p.point), p.summary.question};
}

}  // namespace

document::Description<goal::ClaimVerdict> verdict_description(const goal::Question& question,
                                                              bool on_machines) {
  document::Description<goal::ClaimVerdict> description;
  const std::string where = question.worlds > 0 ? " (worst world)" : "";
  const bool has_machines = std::ranges::any_of(
      question.parts, [](const goal::JudgedCriterion& part) { return part.goal->machines.has_value(); });
  if (has_names(question))
    description.value(
        {.key = "name",
         .heading = has_several(question) ? "worst goal" : "",
         .meaning = "name of the goal (of several goals the worst), to which these values apply",
         .optional = true},
        [question](Verdict v) { return question.parts[v.goal].goal->name; });
  if (!question.settings.empty())
    description.value({.key = "condition",
                       .heading = "worst condition",
                       .meaning = "the worst condition, to which these values apply",
                       .optional = true},
                      [question](Verdict v) { return study::label_of(question.settings, v.setting); });
  description
      .value({.key = "status",
              .heading = "goal",
              .meaning = "verdict on the goal",
              .words = goal::status_words()},
             [](Verdict v) { return goal::text_of(v.status); })
      .value(
          {.key = "rate",
           .heading = "moves in goal" + where,
           .meaning =
               "proportion of moves that meet the goal, with one-sided bounds; with worlds of the worst world",
           .unit = "1",
           .notation = document::Notation::percent},
          [](Verdict v) { return goal::bounded(v.moves); });
  if (has_machines) {
    const auto of_machines = [question](goal::BoundedProportion goal::ClaimVerdict::*proportion) {
      return [question, proportion](Verdict v) -> std::optional<document::Bounded> {
        if (!question.parts[v.goal].goal->machines) return std::nullopt;
        return goal::bounded(v.*proportion);
      };
    };
    description
        .value(
            {.key = "machines",
             .heading = "machines in goal" + where,
             .meaning =
                 "proportion of machines that meet the goal, with one-sided bounds; with worlds of the worst world; "
                 "left out where the goal is not on machines",
             .unit = "1",
             .notation = document::Notation::percent,
             .optional = true},
            of_machines(&goal::ClaimVerdict::machines))
        .value(
            {.key = "without_miss",
             .meaning =
                 "proportion of machines without a miss in as many moves as these have, with one-sided bounds; "
                 "left out where the goal is not on machines",
             .unit = "1",
             .optional = true},
            of_machines(&goal::ClaimVerdict::without_miss))
        .value(
            {.key = "trials_of_one_machine",
             .meaning =
                 "trials without a miss that show of one machine that it meets the goal; left out where the goal is not on machines",
             .optional = true},
            [question](Verdict v) -> std::optional<std::int64_t> {
              const study::Goal& claim = *question.parts[v.goal].goal;
              if (!claim.machines) return std::nullopt;
              return statistics::trials_for_claim(claim.moves, claim.confidence, 0);
            });
  }
  if (std::ranges::any_of(question.parts, [](const auto& part) { return part.goal->beside_load; }))
    description.object({.key = "other_mass",
                        .meaning = "the same values of the load, which the goal of the motor does not limit",
                        .shown = Visibility::in_data,
                        .optional = true},
                       goal::load_description(), &goal::ClaimVerdict::of_load);
  if (on_machines)
    description.value(document::in_data("machines_without_miss", "machines all of whose moves meet the goal"),
                      &goal::ClaimVerdict::machines_without_miss);
  return description;
}

document::Description<goal::Verdict> goals_description(const goal::Question& question, bool on_machines) {
  document::Description<goal::Verdict> goals;
  for (const goal::JudgedCriterion& part : question.parts) {
    const std::size_t number = part.number;
    goals.object({.key = part.goal->name, .meaning = goal::goal_sentence(*part.goal)},
                 verdict_description(only(question, number), on_machines), [number](const goal::Verdict& v) {
                   goal::ClaimVerdict worst = worst_of_goal(v, number);
                   worst.goal = 0;  // of this goal alone
                   return worst;
                 });
  }
  return goals;
}

void add_goal(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.question.goal()) return;
  const goal::Question& question = summary.question;
  point.object(
      {.key = "goal", .meaning = "whether the point meets the goal, with bounds of this point alone"},
      verdict_description(question, summary.features.machines), &DescribedPoint::verdict);
  const bool several = has_names(question);
  if (several)
    point.object({.key = "goals",
                  .meaning = "each of the goals, by name",
                  .shown = Visibility::in_data,
                  .free_keys = true},
                 goals_description(question, summary.features.machines), &DescribedPoint::verdict);
  if (!several && question.settings.empty()) return;
  point.value(
      document::in_data(
          "machines_together",
          "proportion of machines that meet all goals on machines, as observed; nothing where only one claim is on machines",
          "1"),
      [question](const DescribedPoint& p) -> std::optional<double> {
        const auto all = goal::machines_meeting_all(question, p.statistics());
        if (!all) return std::nullopt;
        return statistics::rate(all->machines, all->of);
      });
}

bool has_several_claims(const summary::StudySummary& summary) {
  return summary.question.goal() && !summary.features.open_loop &&
         (has_several(summary.question) || !summary.question.settings.empty());
}

void add_cells(PointDescription& point, const summary::StudySummary& summary) {
  const goal::Question& question = summary.question;
  if (summary.features.open_loop) return;
  const std::string confidence =
      text::percent(goal::confidence_of(question, summary.confidence)) + " confidence";
  if (question.worlds > 0)
    point.object({.key = "worlds",
                  .meaning = "the worlds at the point",
                  .own_table = fmt::format("by world: the lowest, median and highest rate of {} worlds",
                                           question.worlds),
                  .note = "bounds of one side each, of the lowest rate of all worlds, with " + confidence},
                 summary::worlds_description(question), worlds_at);
  if (has_several_claims(summary))
    point.table(in_json("claims", "each goal under each condition at the point"),
                summary::cell_description({}, summary::CellsBy::claim),
                [](Point p) { return summary::claims_of_point(p.summary, p.point); });
  if (!summary.question.settings.empty())  // with a goal the table of claims has them for people
    point.table({.key = "conditions",
                 .meaning = "the point under each condition",
                 .shown = question.goal() ? Visibility::in_json : Visibility::not_in_csv,
                 .own_table = "by condition",
                 .note = "bounds of one side each with " + confidence},
                summary::cell_description(question, summary::CellsBy::setting),
                [](Point p) { return summary::settings_of_point(p.summary, p.point); });
  if (!question.settings.ages.at.empty())
    point.table({.key = "ages",
                 .meaning = "the point at each age",
                 .shown = Visibility::not_in_csv,
                 .own_table = "by age"},
                summary::cell_description(question, summary::CellsBy::age),
                [](Point p) { return summary::ages_of_point(p.summary, p.point); });
}

void add_claims(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_several_claims(summary)) return;
  answer.table({.heading = summary.points.size() > 1 ? "by claim, at the chosen point" : "by claim"},
               summary::cell_description({}, summary::CellsBy::claim),
               [](const SummaryResults& s) { return summary::claims_of_point(s.summary, s.chosen.point); });
  answer.sentence([](const SummaryResults& s) {
    return fmt::format("bounds of one side each with {} confidence",
                       text::percent(s.summary.question.goal()->confidence));
  });
}

}  // namespace zerocount::summary_answer
