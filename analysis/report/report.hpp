#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/thinned_trace.hpp"
#include "results/reading/study_file.hpp"

/// The report on a results file, and its figures one by one.
namespace zerocount {

/// What a report is to have beyond the file.
struct ReportOptions {
  std::optional<StudyComparison> comparison{};  ///< with a baseline
  std::optional<std::int64_t> focus{};  ///< design point whose trials are shown; the best one otherwise
  /// Looks at every trial that was run again, and says what of it is not as it was recorded, a line each.
  std::function<std::vector<std::string>(const ReplayedTrial&)> check{};
};

/// A report, and what there is to say beside it.
struct StudyReport {
  ReportPage page;
  std::vector<std::string> warnings;  ///< that stand in the page too
};

/// The whole report of a complete results file. The file is read several times from beginning to end, and
/// some of its trials are run again.
/// @throws Failure as StudyFile; bad_input for a focus that there is not.
StudyReport study_report(const StudyFile& file, const ReportOptions& options = {});

/// All figures of a report by name.
std::vector<std::string> figure_names(const ReportPage& page);

/// @throws Failure (bad_input) where the report has no such figure; the message lists those it has.
const Figure& find_figure(const ReportPage& page, const std::string& name);

/// What node is given to draw a figure as SVG: a program without any other file.
std::string drawing_program(const Figure& figure);

}  // namespace zerocount
