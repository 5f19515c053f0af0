#pragma once

#include "analysis/report/report.hpp"

namespace zerocount::commands {

/// The report of a results file, with a warning for each trial that is simulated again and differs from its
/// record. Prints the warnings.
/// @throws Failure as report::study_report
report::StudyReport verified_report(const reading::AllTrialsFile& file, report::ReportOptions options = {});

}  // namespace zerocount::commands
