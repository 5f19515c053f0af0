#include <fmt/format.h>

#include "analysis/summary/ages_of_point.hpp"
#include "analysis/summary/claims_of_point.hpp"
#include "analysis/summary/conditions_of_point.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary_answer {
namespace {

using Point = const PointReading&;

bool has_conditions(const summary::StudySummary& summary) {
  return !summary.conditions.empty() && !summary.features.open_loop;
}

/// A condition of a point, for people.
struct PointCondition {
  std::optional<std::string> point;  ///< its label; none in a study of one point
  summary::ConditionOfPoint condition;
};

std::vector<PointCondition> conditions_of_points(const SummaryReading& s) {
  std::vector<PointCondition> rows;
  for (Point p : s.points) {
    for (const summary::ConditionOfPoint& one : summary::conditions_of_point(p.summary, p.point))
      rows.push_back({s.points.size() > 1 ? std::optional(p.label()) : std::nullopt, one});
  }
  return rows;
}

bool has_several_claims(const summary::StudySummary& summary) {
  return summary.question.claim() && (has_several(summary.question) || has_conditions(summary));
}

bool has_ages(const summary::StudySummary& summary) {
  return !summary.question.ages.at.empty() && !summary.features.open_loop;
}

/// An age of a point, for people.
struct PointAge {
  std::optional<std::string> point;  ///< its label; none in a study of one point
  summary::AgeOfPoint age;
};

std::vector<PointAge> ages_of_points(const SummaryReading& s) {
  std::vector<PointAge> rows;
  for (Point p : s.points) {
    for (const summary::AgeOfPoint& one : summary::ages_of_point(p.summary, p.point))
      rows.push_back({s.points.size() > 1 ? std::optional(p.label()) : std::nullopt, one});
  }
  return rows;
}

std::string note_on_ages(const SummaryReading& s) {
  std::string text;
  for (Point p : s.points) {
    const std::string sentence =
        summary::ages_sentence(s.summary.question, summary::ages_of_point(p.summary, p.point));
    if (!sentence.empty())
      text += s.points.size() > 1 ? fmt::format("{}: {}\n", p.label(), sentence) : sentence + '\n';
  }
  if (!text.empty()) text.pop_back();
  return text;
}

std::string note_on_conditions(const SummaryReading& s) {
  std::string text;
  for (Point p : s.points) {
    if (s.summary.question.claim() && p.point != s.chosen.point) continue;  // the point's row names the worst
    const std::string sentence =
        summary::conditions_sentence(s.summary, summary::conditions_of_point(s.summary, p.point));
    if (!sentence.empty())
      text += s.points.size() > 1 ? fmt::format("{}: {}\n", p.label(), sentence) : sentence + '\n';
  }
  if (text.empty()) return text;
  return text + fmt::format("bounds of one side each with {} confidence",
                            text::percent(goal::confidence_of(s.summary.question, s.summary.confidence)));
}

}  // namespace

void add_conditions(PointDescription& point, const summary::StudySummary& summary) {
  if (!has_conditions(summary)) return;
  point.table({.key = "conditions", .meaning = "the point under each condition", .shown = Shown::in_json},
              summary::condition_description(summary.question),
              [](Point p) { return summary::conditions_of_point(p.summary, p.point); });
}

void add_conditions(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_conditions(summary)) return;
  if (!summary.question.claim())  // with one the table of claims has them
    answer.table({.heading = "by condition", .shown = Shown::to_people},
                 document::Description<PointCondition>()
                     .value({.heading = "point"}, &PointCondition::point)
                     .include(summary::condition_description(summary.question), &PointCondition::condition),
                 conditions_of_points);
  answer.sentence(note_on_conditions);
}

void add_ages(PointDescription& point, const summary::StudySummary& summary) {
  if (!has_ages(summary)) return;
  point.table({.key = "ages", .meaning = "the point at each age", .shown = Shown::in_json},
              summary::age_description(summary.question),
              [](Point p) { return summary::ages_of_point(p.summary, p.point); });
}

void add_ages(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_ages(summary)) return;
  answer.table({.heading = "by age", .shown = Shown::to_people},
               document::Description<PointAge>()
                   .value({.heading = "point"}, &PointAge::point)
                   .include(summary::age_description(summary.question), &PointAge::age),
               ages_of_points);
  answer.sentence(note_on_ages);
}

void add_claims(PointDescription& point, const summary::StudySummary& summary) {
  if (!has_several_claims(summary)) return;
  point.table(
      {.key = "claims", .meaning = "each goal under each condition at the point", .shown = Shown::in_json},
      summary::claim_description(), [](Point p) { return summary::claims_of_point(p.summary, p.point); });
}

void add_claims(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_several_claims(summary)) return;
  answer.table({.heading = summary.points.size() > 1 ? "by claim, at the chosen point" : "by claim",
                .shown = Shown::to_people},
               summary::claim_description(),
               [](const SummaryReading& s) { return summary::claims_of_point(s.summary, s.chosen.point); });
}

}  // namespace zerocount::summary_answer
