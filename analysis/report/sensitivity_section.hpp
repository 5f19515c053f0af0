#pragma once

#include <optional>

#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"

namespace zerocount::report {

/// The section's anchor in the page.
inline constexpr const char* sensitivity_section_name = "sensitivity";

/// Sensitivity to the random parameters at the point whose success rate is nearest to one half. Nothing if
/// the study has no random parameters or no index could be estimated.
std::optional<PageSection> sensitivity_section(const ReportedStudy& reported);

}  // namespace zerocount::report
