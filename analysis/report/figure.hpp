#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/parameters/study_units.hpp"

namespace zerocount {

/// A column of the data of a figure.
struct FigureColumn {
  std::string field;  ///< name that the specification has for it
  std::string title;  ///< head in the table behind the figure; empty: not shown there
  std::string unit;   ///< "1" where dimensionless, "" for text
};

/// Data of a figure: what the specification calls {"data": {"name": name}}.
struct FigureData {
  std::string name;
  std::vector<FigureColumn> columns;
  std::vector<nlohmann::ordered_json> rows{};  ///< [row] an array with a value per column
};

/// A figure: a Vega-Lite specification with its data, and what is said of it.
struct Figure {
  std::string name;  ///< by which `plot` asks for it, and its place in the page
  std::string title;
  std::string caption;  ///< what to see in it, plain text
  nlohmann::ordered_json specification;
  std::vector<FigureData> data;  ///< the first is the table behind the figure
};

/// A figure without data whose specification is the embedded file `specification`.vl.json.
Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption);

/// Says of all bounds in the data and at the pointer that they are too narrow, and adds `why` to the caption.
/// Does nothing to a figure without bounds.
void call_bounds_too_narrow(Figure& figure, const std::string& why);

/// Puts the figure's titles, units and caption into the words of an axis of this kind; those of figures are
/// for a rotary one.
void put_on_axis(Figure& figure, AxisKind axis);

/// Gives a figure the height of `rows` rows of `row` pixels each.
void set_rows(Figure& figure, std::size_t rows, int row);

/// A number for a dataset: `digits` significant ones; null for NaN and infinities.
nlohmann::ordered_json datum(double value, int digits = 6);

/// Round numbers in [low, high] for an axis that is not linear: 1, 2 and 5 times the powers of ten between,
/// and those alone where there are many; 0 where it is inside, and negative ones alike. None where an
/// argument is not finite or `smallest` not positive.
nlohmann::ordered_json round_numbers(double low, double high, double smallest);

/// Writes the numbers of an axis that reaches to `largest` with powers of ten where they are small.
void set_number_format(nlohmann::ordered_json& axis, double largest);

/// Whether positive numbers, sorted, are spaced evenly by their ratio rather than by their difference.
bool spaced_by_ratio(const std::vector<double>& sorted);

}  // namespace zerocount
