#pragma once

#include <cstdint>
#include <string>

#include "experiments/study/study.hpp"

namespace zerocount::report {

/// Assumptions of the trials of a design point by their source: measured, from a table of samples, given in
/// the manifest, defaults; then the effects of a real axis that are stated to be absent, and those that are
/// assumed to be.
std::string assumptions_html(const study::Study& study, std::int64_t point);

}  // namespace zerocount::report
