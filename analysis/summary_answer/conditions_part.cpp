#include <fmt/format.h>

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

std::string note_on_conditions(const SummaryReading& s) {
  std::string text;
  for (Point p : s.points) {
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
  answer
      .table({.heading = "by condition", .shown = Shown::to_people},
             document::Description<PointCondition>()
                 .value({.heading = "point"}, &PointCondition::point)
                 .include(summary::condition_description(summary.question), &PointCondition::condition),
             conditions_of_points)
      .sentence(note_on_conditions);
}

}  // namespace zerocount::summary_answer
