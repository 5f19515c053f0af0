#pragma once

#include <string>

#include "analysis/report/figure.hpp"

namespace zerocount::commands {

/// A figure as SVG, or as PNG with 300 pixels per inch at a width of 140 mm. Runs node, and rsvg-convert for
/// PNG.
/// @throws Failure (machine_failed) where they are missing or fail.
std::string picture(const report::Figure& figure, bool png);

}  // namespace zerocount::commands
