#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"

namespace zerocount::summary {

/// What the trials and machines of a design point show at one age.
struct AgeOfPoint {
  double age{0.0};                         ///< in the unit of Question::ages
  std::int64_t trials{0};                  ///< at the age
  std::int64_t success{0};                 ///< of them, trials all of whose moves ended at zero error
  std::optional<std::int64_t> goal_met{};  ///< trials all of whose moves meet the goal
  goal::BoundedProportion rate{};          ///< of moves, of the worst goal and condition; without
                                           ///< a goal of trials that succeed, under the worst
  std::optional<goal::BoundedProportion> machines{};  ///< that meet the goal; none without a goal
  std::optional<goal::BoundedProportion> living{};    ///< rigs that meet it at every age up to this one
  std::optional<double> settling_time_p95{};          ///< s, of the slowest goal; none: not within the hold
  std::optional<goal::Status> status{};  ///< of the worst goal and condition; none without a goal
};

/// The ages of a point, [age]; empty without ages, and of a point without judged trials. Bounds are
/// one-sided, each with the confidence of the goal (of the summary without a goal).
/// @param points that the point was chosen from
std::vector<AgeOfPoint> ages_of_point(const StudySummary& summary, std::int64_t point,
                                      std::size_t points = 1);

document::Description<AgeOfPoint> age_description(const goal::Question& question);

/// The last age up to and including which the goal is met, in the unit of ages; none if not at the first.
std::optional<double> met_until(const std::vector<AgeOfPoint>& ages);
/// The first age at which the goal is missed; none where that is not shown.
std::optional<double> missed_from(const std::vector<AgeOfPoint>& ages);

/// "the goal is met up to 100000 cycles, and missed from 1000000 cycles on"; without a goal, or ages, empty.
std::string ages_sentence(const goal::Question& question, const std::vector<AgeOfPoint>& ages);

}  // namespace zerocount::summary
