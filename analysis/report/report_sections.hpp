#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/history/series.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"

/// The texts and tables of a report, as HTML, and its sections with both text and figures.
namespace zerocount::report {

/// The conclusions in words.
struct Conclusions {
  std::string headline;
  std::vector<std::string> lines;
};

/// The conclusions of a study. With a goal: whether it is met at the chosen point, and facts that the table
/// of requirements does not show. Otherwise: the success at the chosen point with tolerance statements, and
/// zero_counts_html() without its rate. For 100 % success they state the upper bound of the failure
/// probability.
Conclusions conclusions_of(const ReportedStudy& reported);

/// Zero counts at the chosen point of a study with a goal, as a separate question: the rate of success, and
/// the prediction of the criteria.
std::string zero_counts_html(const ReportedStudy& reported);

/// The provenance: size, design, random parameters, program, manifest.
std::string run_html(const ReportedStudy& reported);

/// The tables of `summary`: the points by the question of the study, the zero counts, and further tables of
/// the study; for an open-loop study the levels. At most 400 rows; a note states if there are more.
std::string points_html(const ReportedStudy& reported);

/// The series of a history as figures, changed series first, and the changes in words. At most `max_figures`
/// figures; a note states if there are more.
PageSection history_section(const history::History& history, std::size_t max_figures);

/// The anchor of sensitivity_section() in the page.
inline constexpr const char* sensitivity_section_name = "sensitivity";

/// Sensitivity to the random parameters at the point whose success rate is nearest to one half. Nothing if
/// the study has no random parameters or no index could be estimated.
std::optional<PageSection> sensitivity_section(const ReportedStudy& reported);

}  // namespace zerocount::report
