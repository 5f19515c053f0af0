#pragma once

#include <string>

#include "analysis/report/first_screen/axis_diagram.hpp"

namespace zerocount::report {

/// The block diagram as SVG, once from left to right for wide screens and paper, and once from top to bottom
/// for phones: classes "axis wide" and "axis tall", of which page.css shows one. Colours are those of the
/// page.
std::string axis_svg(const AxisDiagram& diagram);

}  // namespace zerocount::report
