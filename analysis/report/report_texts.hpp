#pragma once

#include <string>

#include "analysis/report/reported_study.hpp"

/// Texts and tables of a report, as HTML.
namespace zerocount::report {

/// The conclusions in words: success of the best and the worst point with tolerance statements, settling
/// times, jerks, and the prediction of the criteria. For 100 % success it states the upper bound of the
/// failure probability.
std::string verdict_html(const ReportedStudy& reported);

/// The provenance: size, design, random parameters, program, manifest.
std::string run_html(const ReportedStudy& reported);

/// The table of the points, or of the levels of an open-loop study. At most 400 rows; a note states if there
/// are more.
std::string points_html(const ReportedStudy& reported);

}  // namespace zerocount::report
