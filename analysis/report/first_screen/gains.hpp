#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "experiments/study/study.hpp"

namespace zerocount::report {

/// Whether the value is chosen by the designer, not a property of the axis: gains and blocks of the
/// controller, and what tune may change.
bool is_chosen(const study::Study& study, std::size_t slot);

/// The values at a design point that are chosen, all of them: those that the manifest gives and the defaults
/// that act; with the range in which tune seeks them.
std::string gains_html(const study::Study& study, std::int64_t point);

/// The margins of the linear loops at a design point under each condition, as `check` prints them; empty
/// where no loop is linear.
std::string loops_html(const study::Study& study, std::int64_t point);

}  // namespace zerocount::report
