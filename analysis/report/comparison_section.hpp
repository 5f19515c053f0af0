#pragma once

#include "analysis/comparison/comparison.hpp"
#include "analysis/report/page.hpp"

namespace zerocount {

/// What became of the study since a baseline: the verdict, what differs in the manifests, and every measure
/// at every point, the failed ones first.
PageSection comparison_section(const StudyComparison& comparison);

}  // namespace zerocount
