#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// A figure as SVG, as PNG with 300 pixels per inch at a width of 140 mm, or as a Vega-Lite specification
/// that needs nothing else. Runs node, and rsvg-convert for PNG.
/// @param extension ".svg", ".png" or ".json"
/// @throws Failure (machine_failed) where they are missing or fail.
std::string picture(const report::Figure& figure, std::string_view extension);

/// The kind of a file with figures: an HTML page of all of them, or a picture of one.
enum class DrawingKind { page, svg, png };

/// The kind by the ending of a file's name; standard output gets a page. Refuses other endings.
DrawingKind drawing_kind(const command_line::Arguments& arguments, std::string_view option,
                         const std::filesystem::path& place);

/// The page, or the picture of its first figure.
/// @throws Failure as picture().
std::string drawing(const report::ReportPage& page, DrawingKind kind);

}  // namespace zerocount::commands
