#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "analysis/jerks/jerk_statistics.hpp"

/// How the verb `jerks` tells of the jerks of a study.
namespace zerocount {

/// Everything that is told of a study.
struct JerkReport {
  std::string name;  ///< of the study
  AxisKind axis{AxisKind::rotary};
  double confidence{summary_confidence};
  std::vector<PointJerks> points;
};

/// The jerks of these points of a complete results file (of all, where none is named), with `creep_trials`
/// trials of each run again to be compared with creep.
/// @throws Failure as jerk_statistics.
JerkReport jerk_report(const StudyFile& file, const Study& study, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials);

/// Whether any move of the report arrived: without one nothing was measured.
bool any_arrival(const JerkReport& report);

/// {"name", "confidence", "points": [{"point", "label", …}]} with the names of JerkStatistics; NaN is null.
nlohmann::ordered_json jerk_json(const JerkReport& report);

/// jerk_json as text, indented, ending with a line break.
std::string jerk_json_text(const JerkReport& report);

/// For people: for each point a paragraph and the table of rates. UTF-8.
std::string jerk_text(const JerkReport& report);

}  // namespace zerocount
