#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/figure.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::report {

using document::ColumnOf;
using document::data_of;
using document::Figure;
using document::FigureColumn;
using document::FigureData;

/// A figure with the embedded specification `specification`.vl.json.
Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption,
                 std::vector<FigureData> data);

/// Marks all bounds in the data table and the tooltips as too narrow, and adds `why` to the caption. No
/// effect on a figure without bounds.
void call_bounds_too_narrow(Figure& figure, const std::string& why);

/// Replaces titles in the specification. @param words each title as it is there, and as it shall be
void retitle(Figure& figure, const std::map<std::string_view, std::string_view>& words);

/// Converts the figure's titles, units and caption from a rotary axis to an axis of this kind.
void put_on_axis(Figure& figure, parameters::AxisKind axis);

/// The data as JSON: [{"name", "columns": [[field, title, unit]], "rows"}].
nlohmann::ordered_json data_json(const Figure& figure);

/// Sets the height to `rows` rows of `row` pixels each.
void set_rows(Figure& figure, std::size_t rows, int row);

/// A part of a figure that shows the rows with one value of a field.
struct FigurePanel {
  std::string value;  ///< of the field
  std::string title;
};

/// Divides a figure of one view into panels, one below the other, of the rows of its datasets in which
/// `field` has the panel's value. Datasets without the field are shown in all. One panel leaves the figure as
/// it is.
void divide_into_panels(Figure& figure, const std::string& field, const std::vector<FigurePanel>& panels);

/// A cell of a map.
struct CellEdges {
  double x_from{0.0}, x_to{0.0};
  double y_from{0.0}, y_to{0.0};
};

/// The dataset of boundaries on a map: edges between neighbouring cells of which one has a property.
FigureData boundaries_data();
/// Adds a boundary to it. @param cells of a grid, x fastest @param columns of it
void add_boundary(FigureData& boundaries, const std::string& line, const std::vector<CellEdges>& cells,
                  std::size_t columns, const std::function<bool(std::size_t)>& has);

/// Gives each name of a colour channel its colour, whichever of them a figure shows.
void colour_by_name(nlohmann::ordered_json& colour, const std::vector<std::string>& names);

/// A number for a dataset, with `digits` significant digits; null for NaN and infinities.
nlohmann::ordered_json datum(double value, int digits = 6);

/// Tick values in [low, high] for a logarithmic or symlog axis: 0, and ± 1, 2 and 5 times powers of ten from
/// `smallest` on (only powers of ten if there are many). Empty if an argument is not finite or `smallest` is
/// not positive.
nlohmann::ordered_json round_numbers(double low, double high, double smallest);

/// The horizontal axis of figures of the specification `ages`: logarithmic where the ages span decades, and
/// linear below the first age above 0. @param ages rising
void scale_ages(Figure& figure, const std::vector<double>& ages, const std::string& unit);

/// Whether sorted positive numbers are closer to equal ratios than to equal differences.
bool spaced_by_ratio(const std::vector<double>& sorted);

}  // namespace zerocount::report
