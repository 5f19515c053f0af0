#pragma once

#include "results/layout/measure_table.hpp"

namespace zerocount::layout {

/// The measures of a move that do not depend on the study, in the order of the file.
MeasureTable move_measures();

/// The measures of the error band number `slot`, in the order of band_fields().
std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot);

/// The settling time of the tolerance number `slot`.
Measure measure_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot);

}  // namespace zerocount::layout
