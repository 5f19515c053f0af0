#pragma once

#include <string>

#include "analysis/report/reported_study.hpp"

/// What a report says in words and tables, as HTML.
namespace zerocount {

/// The verdict: how often the best and the worst point succeed and what that proves, how fast, with how many
/// jerks, and what the criteria said. 100 % is told as the failure probability that it leaves.
std::string verdict_html(const ReportedStudy& reported);

/// What was run: size, design, random parameters, who made the file, the manifest.
std::string run_html(const ReportedStudy& reported);

/// The table of the points; in an open-loop study of its levels. At most 400 rows, with a note where there
/// would be more.
std::string points_html(const ReportedStudy& reported);

}  // namespace zerocount
