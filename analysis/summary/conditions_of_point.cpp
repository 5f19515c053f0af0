#include "analysis/summary/conditions_of_point.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::summary {
namespace {

/// The proportion of trials that succeed; with worlds in the worst of them.
goal::BoundedProportion success_of(const measures::MoveCounts& counts, double confidence) {
  std::vector<measures::MoveCounts> worlds = measures::in_worlds(counts);
  if (worlds.empty()) worlds.push_back(counts);
  const double each = statistics::confidence_of_each(confidence, worlds.size());
  goal::BoundedProportion lowest;
  for (std::size_t world = 0; world < worlds.size(); ++world) {
    const statistics::ClusterSums sums = measures::clusters_of(worlds[world]);
    const goal::BoundedProportion one{statistics::rate(worlds[world].met, worlds[world].moves),
                                      statistics::clustered_at_least(sums, each),
                                      statistics::clustered_at_most(sums, each)};
    lowest = world == 0 ? one : goal::lowest(lowest, one);
  }
  return lowest;
}

/// The verdict under a condition: of several goals that of the worst.
void judge(const goal::Question& question, const goal::Verdict& of_point, std::size_t number,
           ConditionOfPoint& condition) {
  std::vector<goal::ClaimVerdict> claims = goal::claims_of(of_point);
  std::erase_if(claims, [number](const goal::ClaimVerdict& one) { return one.condition != number; });
  const goal::ClaimVerdict worst =
      std::ranges::min(claims, [](const auto& a, const auto& b) { return is_worse(*a.verdict, *b.verdict); });
  const goal::Verdict& verdict = *worst.verdict;
  const study::Goal& goal = *question.parts[worst.goal].claim;
  condition.rate = goal.machines ? verdict.machines : verdict.moves;
  condition.status = verdict.status;
  if (has_several(question)) condition.goal = goal.name;
}

}  // namespace

std::vector<ConditionOfPoint> conditions_of_point(const StudySummary& summary, std::int64_t point,
                                                  std::size_t points) {
  std::vector<ConditionOfPoint> found;
  const measures::PointSummary& statistics = summary.points[static_cast<std::size_t>(point)];
  if (!statistics.conditions) return found;
  const std::optional<goal::Verdict> verdict =
      summary.question.claim() ? std::optional(verdict_on(summary.question, statistics, points))
                               : std::nullopt;
  const auto& succeeded = measures::in_conditions(statistics.conditions->succeeded);
  const auto& meeting = measures::in_conditions(statistics.conditions->meeting);
  for (std::size_t c = 0; c < succeeded.size(); ++c) {
    ConditionOfPoint one;
    one.name = summary.conditions[c];
    one.trials = succeeded[c].moves;
    one.success = succeeded[c].met;
    if (verdict) {
      one.goal_met = meeting[c].met;
      judge(summary.question, *verdict, c, one);
    } else {
      one.rate = success_of(succeeded[c], summary.confidence);
    }
    found.push_back(std::move(one));
  }
  return found;
}

std::size_t worst_condition(const std::vector<ConditionOfPoint>& conditions) {
  const auto key = [](const ConditionOfPoint& one) {
    return std::isnan(one.rate.value) ? 2.0 : one.rate.value;  // without trials: the last
  };
  const auto worst = std::ranges::min_element(conditions, {}, key);
  return static_cast<std::size_t>(worst - conditions.begin());
}

document::Description<ConditionOfPoint> condition_description(const goal::Question& question) {
  using Of = const ConditionOfPoint&;
  document::Description<ConditionOfPoint> description;
  description.value({"condition", "condition", "what every machine bears"}, &ConditionOfPoint::name)
      .value({"trials", "trials", "trials under the condition"}, &ConditionOfPoint::trials)
      .value({"success", "succeeded", "trials all of whose moves ended at zero error"},
             &ConditionOfPoint::success);
  if (question.claim())
    description.value({.key = "goal_met",
                       .heading = "in goal",
                       .meaning = "trials all of whose moves meet the goal",
                       .optional = true},
                      &ConditionOfPoint::goal_met);
  if (has_several(question))
    description.value({.key = "goal",
                       .heading = "worst goal",
                       .meaning = "name of the goal that the next numbers are of",
                       .optional = true},
                      &ConditionOfPoint::goal);
  description.value({.key = "rate",
                     .heading = "rate [bounds]",
                     .meaning = "proportion that the question is about, with one-sided bounds",
                     .unit = "1",
                     .notation = document::Notation::percent},
                    [](Of c) { return goal::bounded(c.rate); });
  if (question.claim())
    description.value(
        {.key = "status",
         .heading = "verdict",
         .meaning = "verdict on the goal under the condition",
         .words = goal::status_words(),
         .optional = true},
        [](Of c) { return c.status ? std::optional(std::string(goal::text_of(*c.status))) : std::nullopt; });
  return description;
}

std::string averaged_over(const StudySummary& summary) {
  const bool worlds = summary.question.worlds > 0;
  const bool conditions = !summary.conditions.empty();
  if (!worlds && !conditions) return "";
  std::vector<std::string_view> over;
  if (worlds) over.emplace_back("worlds");
  if (conditions && !summary.question.ages.at.empty()) over.emplace_back("ages");
  if (summary.conditions.size() > summary.question.ages.at.size()) over.emplace_back("conditions");
  return fmt::format("on average over the {}: ", fmt::join(over, " and "));
}

}  // namespace zerocount::summary
