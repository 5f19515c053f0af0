#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"

namespace zerocount::summary {

/// One claim on a design point: one goal under one condition.
struct ClaimOfPoint {
  std::optional<std::string> goal{};                  ///< its name; none of a study with one goal
  std::optional<std::string> condition{};             ///< none without conditions
  std::int64_t moves{0};                              ///< that are asked
  std::int64_t met{0};                                ///< of them
  goal::BoundedProportion rate;                       ///< of moves; with worlds of the worst of them
  std::optional<goal::BoundedProportion> machines{};  ///< none where the goal is not on machines
  std::optional<double> settling_time_p95{};          ///< s; none where it is not within the hold
  double within{0.0};                                 ///< s, of the goal
  goal::Status status{goal::Status::undecided};
};

/// The claims on a point, by goal and condition; empty without a goal. The bounds are those of verdict_on().
/// @param points that the point was chosen from
std::vector<ClaimOfPoint> claims_of_point(const StudySummary& summary, std::int64_t point,
                                          std::size_t points = 1);

document::Description<ClaimOfPoint> claim_description();

}  // namespace zerocount::summary
