#pragma once

#include <nlohmann/json_fwd.hpp>

#include "analysis/report/figures/figure.hpp"

namespace zerocount::report {

/// The figure as one Vega-Lite specification that needs nothing else: with its data, its theme, the colours
/// of a light page and a width.
nlohmann::ordered_json standalone_specification(const Figure& figure);

}  // namespace zerocount::report
