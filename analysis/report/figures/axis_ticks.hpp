#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "analysis/report/figures/figure.hpp"

namespace zerocount::report {

/// The specification of a figure with the tick labels of all axes of numbers. The data stay in their units:
///
///   for each axis: its range is the extent of its fields in the data, or the domain of its scale
///     linear: the title gets the SI prefix of the largest number, "time (ms)"; proportions get "%"
///     logarithmic, over less than about six decades: likewise, by the middle of the range
///     logarithmic, over more: each label has its own prefix, "10 nm"
///     label the ticks that four figures state exactly; of a decade or more those at 1, 2 and 5
///
/// Labels of an axis thus differ and have at most four figures. A linear range too narrow for two such labels
/// is widened. Units without SI prefixes get a power of ten, "error (10³ counts)".
nlohmann::ordered_json with_tick_labels(const Figure& figure);

}  // namespace zerocount::report
