#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/moments.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/text/report_field.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount {

/// One torque level of an open-loop study, over the trials of a point: all values as the level ends. Trials
/// whose motion was lost, in this level or before, are counted and have no part in the rest.
struct LevelStatistics {
  double confidence{summary_confidence};  ///< of the bounds that are reported of it
  Moments torque;                         ///< N m
  Moments position;                       ///< θ, rad
  Moments creep;                          ///< xp, rad
  std::int64_t broke_away{0};             ///< trials in which the hook slid during the level
  std::int64_t reversal_depth{0};         ///< largest
  std::int64_t nonfinite{0};              ///< trials whose motion was lost

  void add(const MoveOutcome& move);
};

using LevelField = ReportField<LevelStatistics>;

/// What is reported of a level, in the order of the report.
std::span<const LevelField> level_fields();

}  // namespace zerocount
