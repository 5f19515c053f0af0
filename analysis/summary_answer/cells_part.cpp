#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/summary/ages_of_point.hpp"
#include "analysis/summary/claims_of_point.hpp"
#include "analysis/summary/conditions_of_point.hpp"
#include "analysis/summary/worlds_of_point.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

bool has_several_claims(const summary::StudySummary& summary) {
  return summary.question.claim() && !summary.features.open_loop &&
         (has_several(summary.question) || !summary.conditions.empty());
}

std::optional<summary::WorldsReading> worlds_at(Point p) {
  if (!p.worlds) return std::nullopt;
  return summary::WorldsReading{*p.worlds, summary::world_inputs_of(p.summary, p.point), p.summary.question};
}

}  // namespace

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
    point.table(
        {.key = "claims", .meaning = "each goal under each condition at the point", .shown = Shown::in_json},
        summary::claim_description(), [](Point p) { return summary::claims_of_point(p.summary, p.point); });
  if (!summary.conditions.empty())  // with a goal the table of claims has them for people
    point.table({.key = "conditions",
                 .meaning = "the point under each condition",
                 .shown = question.claim() ? Shown::in_json : Shown::not_in_csv,
                 .own_table = "by condition",
                 .note = "bounds of one side each with " + confidence},
                summary::condition_description(question),
                [](Point p) { return summary::conditions_of_point(p.summary, p.point); });
  if (!question.ages.at.empty())
    point.table({.key = "ages",
                 .meaning = "the point at each age",
                 .shown = Shown::not_in_csv,
                 .own_table = "by age"},
                summary::age_description(question),
                [](Point p) { return summary::ages_of_point(p.summary, p.point); });
}

void add_claims(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_several_claims(summary)) return;
  answer.table({.heading = summary.points.size() > 1 ? "by claim, at the chosen point" : "by claim"},
               summary::claim_description(),
               [](const SummaryReading& s) { return summary::claims_of_point(s.summary, s.chosen.point); });
}

}  // namespace zerocount::summary_answer
