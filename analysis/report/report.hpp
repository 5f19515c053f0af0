#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/history/series.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"

/// The report on a results file as a page, and its single figures.
namespace zerocount::report {

/// Parts of a page that come from tuning the controller.
struct TuningPart {
  FirstScreenParts first_screen{};
  std::vector<PageSection> sections{};  ///< Sections on the tuning; they follow the first screen.
};

/// Options of a report.
struct ReportOptions {
  std::optional<TuningPart> tuning{};
  /// Comparison of the study with a baseline study; nothing: none is shown.
  std::optional<comparison::StudyComparison> comparison{};
  /// Results of earlier runs of this study; nothing: none are shown.
  std::optional<history::History> history{};
  /// Index of the design point that the page describes; nothing: the best point.
  std::optional<std::int64_t> point{};
  /// Whether to include the figures of jerks. Their trend test takes most of the time of a report.
  bool jerks{true};
  /// Compares a trial that was simulated again with its record in the file; returns the differences, one line
  /// each. May be empty.
  std::function<std::vector<std::string>(const ReplayedTrial&)> check{};
};

/// A report and its warnings.
struct StudyReport {
  ReportPage page;
  std::vector<std::string> warnings;  ///< Warnings, which the page also shows.
};

/// The report of a complete results file. Reads the file several times and simulates some of its trials
/// again.
/// @throws Failure as AllTrialsFile; bad_input if `point` is not a design point.
StudyReport study_report(const reading::AllTrialsFile& file, const ReportOptions& options = {});

}  // namespace zerocount::report
