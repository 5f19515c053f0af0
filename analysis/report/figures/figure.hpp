#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/figure.hpp"
#include "core/text/text.hpp"
#include "experiments/parameters/study_units.hpp"

/// Figures: data with the names and units of their columns, a caption, and an embedded specification, a
/// template that figures.js completes with the figure's parameters, titles, ticks, panels, colours and sizes,
/// in a page as in a picture.
namespace zerocount::report {

using document::ColumnOf;
using document::data_of;
using document::Figure;
using document::FigureColumn;
using document::FigureData;
using text::EmbeddedFile;

/// All files that are embedded in the program: the Vega-Lite specifications, the page of the report, and the
/// JavaScript libraries for drawing (if they were installed at build time).
std::span<const EmbeddedFile> embedded_files();

/// The contents of an embedded file.
/// @throws Failure (machine_failed) if the program was built without this file; the message says how to
/// include it.
std::string_view embedded_file(std::string_view name);

/// The scripts that draw figures in a page, in loading order: the libraries, then the project's own.
inline constexpr std::array<std::string_view, 4> drawing_scripts{"vega.min.js", "vega-lite.min.js",
                                                                 "vega-embed.min.js", "figures.js"};

/// Throws if the program cannot draw figures, so that the user learns it before long work.
/// @throws Failure (machine_failed) if the program was built without one of the drawing libraries.
void require_drawing_libraries();

/// Makes a figure that is drawn by the embedded Vega-Lite specification `specification`.vl.json.
Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption,
                 std::vector<FigureData> data);

/// Marks all confidence bounds in the figure as too narrow, and adds the reason `why` to the caption. No
/// effect on a figure without bounds.
void call_bounds_too_narrow(Figure& figure, const std::string& why);

/// Converts the figure's titles, units and caption from a rotary axis, for which they are written, to an axis
/// of this kind.
void put_on_axis(Figure& figure, parameters::AxisKind axis);

/// The figure as JSON: {"name", "specification", "parameters", "data": [{"name", "columns": [[field, title,
/// unit]], "rows"}]}
nlohmann::ordered_json figure_json(const Figure& figure);

/// JSON as the content of <script type="application/json">. Every '<' is escaped, so that the content cannot
/// end the script or open a comment. Bytes that are not UTF-8 become U+FFFD; NaN and infinity become null.
std::string script_json(const nlohmann::ordered_json& json);

/// JavaScript as the content of <script>: escapes "</script" and "<!--" in its literals, so that the content
/// cannot end the script.
std::string script_source(std::string_view source);

/// The theme of all figures as a Vega-Lite config. Its colours are CSS variables such as "var(--ink)", which
/// the page defines for light and dark mode.
nlohmann::ordered_json figure_theme();

/// The colours of a mode as CSS variables: {"--ink": "#…"}.
/// @param mode "light" or "dark"
nlohmann::ordered_json colours_of(const char* mode);

/// A self-contained program for node (JavaScript) that writes a figure.
/// @param form "svg": a picture; "specification": JSON for Vega-Lite that needs nothing else
std::string drawing_program(const Figure& figure, std::string_view form);

/// A rectangular cell of a map over two swept parameters: its edges on both axes.
struct CellEdges {
  double x_from{0.0}, x_to{0.0};
  double y_from{0.0}, y_to{0.0};
};

/// Empty dataset for boundaries on a map: edges between two neighbouring cells of which only one has a
/// property.
FigureData boundaries_data();
/// Adds to a dataset of boundaries_data() the edges between cells with a property and cells without it.
/// @param line name of the boundary line
/// @param cells cells of a grid, the index along x fastest
/// @param columns number of columns of the grid
/// @param has whether a cell has the property
void add_boundary(FigureData& boundaries, const std::string& line, const std::vector<CellEdges>& cells,
                  std::size_t columns, const std::function<bool(std::size_t)>& has);

/// A number for a dataset of a figure, rounded to `digits` significant digits; null for NaN and infinities.
nlohmann::ordered_json datum(double value, int digits = 6);

/// Scales the horizontal axis of a figure with the specification `ages`: logarithmic if the ages span
/// decades, and linear below the first age above 0.
/// @param ages ages of the axes, in rising order
void scale_ages(Figure& figure, const std::vector<double>& ages);

/// Whether sorted positive numbers have nearly equal ratios rather than nearly equal differences, so that a
/// logarithmic scale suits them.
bool spaced_by_ratio(const std::vector<double>& sorted);

/// Value of a quantity at a sample, as a function of the sample's index.
using SampleQuantity = std::function<double(std::size_t)>;

/// Indices of the samples of [first, end) that a plotted line needs: the first, the last, and those with the
/// minimum and the maximum of each quantity. They are sorted and distinct.
std::vector<std::size_t> extreme_samples(std::size_t first, std::size_t end,
                                         const std::vector<SampleQuantity>& quantities);

/// Indices of the samples that a plotted line needs: extreme_samples() of each group of `length` samples.
/// @param begins whether a sample begins a new group; empty: groups follow each other by length alone
std::vector<std::size_t> thinned_samples(std::size_t samples, std::size_t length,
                                         const std::vector<SampleQuantity>& quantities,
                                         const std::function<bool(std::size_t)>& begins = {});

}  // namespace zerocount::report
