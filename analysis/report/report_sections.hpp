#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/pairs/history/series.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"

/// The texts and tables of a report, as HTML, and its sections with both text and figures.
namespace zerocount::report {

/// The conclusions of a study in words.
struct Conclusions {
  std::string headline;
  std::vector<std::string> lines;
};

/// The conclusions of a study. With a goal: whether it is met at the chosen design point, and facts that the
/// table of requirements does not show. Otherwise: the success rate at the chosen point with tolerance
/// statements, and the text of zero_counts_html() without its rate. If all trials succeed, they state the
/// upper bound of the failure probability.
Conclusions conclusions_of(const ReportedStudy& reported);

/// HTML on zero counts (moves that end at zero error) at the chosen design point of a study with a goal,
/// which asks something else: the rate of such success, and the prediction of the stability criteria.
std::string zero_counts_html(const ReportedStudy& reported);

/// HTML on the origin of the results: size, design, random parameters, program, manifest.
std::string run_html(const ReportedStudy& reported);

/// HTML of the tables of the command `summary`: the design points by goal or success, the zero counts, and
/// further tables of the study; for an open-loop study the torque levels. At most 400 rows; a note states if
/// there are more.
std::string points_html(const ReportedStudy& reported);

/// Section on earlier runs: series of results over time as figures, changed series first, and the changes in
/// words. At most `max_figures` figures; a note states if there are more.
PageSection history_section(const history::History& history, std::size_t max_figures);

/// HTML anchor of sensitivity_section() in the page.
inline constexpr const char* sensitivity_section_name = "sensitivity";

/// Section on the sensitivity to the random parameters, at the design point whose success rate is nearest to
/// one half. Nothing if the study has no random parameters or no index could be estimated.
std::optional<PageSection> sensitivity_section(const ReportedStudy& reported);

}  // namespace zerocount::report
