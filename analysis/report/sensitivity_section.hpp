#pragma once

#include <optional>

#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"

namespace zerocount {

/// The section's place in the page.
inline constexpr const char* sensitivity_section_name = "sensitivity";

/// Which random parameters matter, at the point whose success tells most: nearest to one half. Nothing where
/// the study draws no parameters or none could be judged.
std::optional<PageSection> sensitivity_section(const ReportedStudy& reported);

}  // namespace zerocount
