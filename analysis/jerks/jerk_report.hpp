#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/jerks/jerk_statistics.hpp"

/// Output of the verb `jerks`.
namespace zerocount::jerks {

/// The reported data of a study.
struct JerkReport {
  std::string name;  ///< of the study
  double confidence{statistics::summary_confidence};
  std::vector<PointJerks> points;
};

/// The jerks of `points` (all points if empty) of a complete results file, under each condition.
/// `creep_trials` trials of each point are simulated again and compared with the closed form of creep.
/// @throws Failure as jerk_statistics.
JerkReport jerk_report(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials);

/// Whether any move arrived. Without an arrival there are no measurements.
bool any_arrival(const JerkReport& report);

/// The answer of `jerks`: for each point its numbers in words, the table of rates and the intervals.
document::AnswerDescription<JerkReport> jerk_answer();

}  // namespace zerocount::jerks
