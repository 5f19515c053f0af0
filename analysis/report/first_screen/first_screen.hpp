#pragma once

#include <string>
#include <vector>

#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/summary/cells_of_point.hpp"

namespace zerocount::report {

/// Parts that the results file does not contain. A part that is not given is made from the file.
struct FirstScreenParts {
  std::string warnings{};  ///< HTML, above all
  std::string headline{};
  std::vector<summary::CellOfPoint> claims{};  ///< by goal and condition
  std::string margins{};                       ///< HTML, in place of the loops of `check`
};

/// The first screen of a page: the verdict, the axis as a diagram, the requirements with their verdicts, the
/// gains with the margins of the loops, and the assumptions.
PageSection first_screen(const ReportedStudy& reported, const FirstScreenParts& parts);

/// The axis and the assumptions of a study without results.
std::string axis_html(const study::Study& study, std::int64_t point);

}  // namespace zerocount::report
