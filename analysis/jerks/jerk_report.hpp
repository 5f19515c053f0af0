#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/jerks/jerk_statistics.hpp"

/// Output of the verb `jerks`.
namespace zerocount::jerks {

/// The reported data of a study.
struct JerkReport {
  std::string name;  ///< of the study
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  double confidence{statistics::summary_confidence};
  std::vector<PointJerks> points;
};

/// The jerks of `points` (all points if empty) of a complete results file. `creep_trials` trials of each
/// point are simulated again and compared with the closed form of creep.
/// @throws Failure as jerk_statistics.
JerkReport jerk_report(const reading::StudyFile& file, const study::Study& study,
                       std::vector<std::int64_t> points, double confidence, std::int64_t creep_trials);

/// Whether any move arrived. Without an arrival there are no measurements.
bool any_arrival(const JerkReport& report);

/// {"name", "confidence", "points": [{"point", "label", …}]} with the names of JerkStatistics; NaN is null.
nlohmann::ordered_json jerk_json(const JerkReport& report);

/// jerk_json as text, indented, ending with a line break.
std::string jerk_json_text(const JerkReport& report);

/// The report as text: for each point a paragraph and the table of rates. UTF-8.
std::string jerk_text(const JerkReport& report);

}  // namespace zerocount::jerks
