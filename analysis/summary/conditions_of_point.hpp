#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"

namespace zerocount::summary {

/// What the trials of a design point show under one condition.
struct ConditionOfPoint {
  std::string name;
  std::int64_t trials{0};
  std::int64_t success{0};                 ///< trials all of whose moves ended at zero error
  std::optional<std::int64_t> goal_met{};  ///< trials all of whose moves meet the goal; none without one
  std::optional<std::string> goal{};       ///< name of the worst goal, of several
  goal::BoundedProportion rate;            ///< of machines, moves or trials, as judged_head() says
  std::optional<goal::Status> status{};    ///< of the goal under this condition; none without a goal
};

/// The conditions of a point, [condition]; empty without conditions, and of a point without judged trials.
/// Bounds are one-sided, each with the confidence of the goal (of the summary without a goal). With worlds
/// the rate is that of the worst world. A goal is missed under a condition where this is shown with the error
/// probability divided by their number, so that one missed condition shows the goal to be missed.
/// @param points that the point was chosen from
std::vector<ConditionOfPoint> conditions_of_point(const StudySummary& summary, std::int64_t point,
                                                  std::size_t points = 1);

/// The condition with the lowest lower bound. @param conditions not empty
std::size_t worst_condition(const std::vector<ConditionOfPoint>& conditions);

document::Description<ConditionOfPoint> condition_description(const goal::Question& question);

/// "on average over the worlds and conditions: ", for what is of all trials; empty where they are all alike.
std::string averaged_over(const StudySummary& summary);

}  // namespace zerocount::summary
