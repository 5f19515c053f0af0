#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/history/series.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"

/// The report on a results file, and its single figures.
namespace zerocount::report {

/// The parts of a page that come from a tuning.
struct TuningPart {
  FirstScreenParts first_screen{};
  std::vector<PageSection> sections{};  ///< Sections that follow the first screen.
};

/// Options of a report.
struct ReportOptions {
  std::optional<TuningPart> tuning{};
  std::optional<comparison::StudyComparison> comparison{};  ///< Comparison with a baseline.
  std::optional<history::History> history{};                ///< Earlier runs of this study.
  std::optional<std::int64_t> point{};  ///< Design point that the page describes; default: the best.
  /// Whether to include the figures of jerks. Their trend test takes most of the time of a report.
  bool jerks{true};
  /// Compares a repeated trial with its record; returns the differences, one line each.
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
