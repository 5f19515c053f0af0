#pragma once

#include "analysis/comparison/comparison.hpp"
#include "analysis/report/page.hpp"

namespace zerocount::report {

/// Comparison with a baseline: the verdict, the differences of the manifests, and every measure at every
/// point, failed ones first.
PageSection comparison_section(const comparison::StudyComparison& comparison);

}  // namespace zerocount::report
