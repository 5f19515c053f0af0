#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/parameters/study_units.hpp"

namespace zerocount::report {

/// A column of the data of a figure.
struct FigureColumn {
  std::string field;  ///< name in the specification
  std::string title;  ///< header in the figure's data table; empty: not shown there
  std::string unit;   ///< "1" where dimensionless, "" for text
};

/// A dataset of a figure, named in the specification by {"data": {"name": name}}.
struct FigureData {
  std::string name;
  std::vector<FigureColumn> columns;
  std::vector<nlohmann::ordered_json> rows{};  ///< [row] an array with one value per column
};

/// A column of a dataset with a row for each subject, and its value of a subject.
template <class Subject>
struct ColumnOf {
  FigureColumn column;
  std::function<nlohmann::ordered_json(const Subject&)> value;
};

/// A dataset with a row for each of `subjects`.
template <class Subject>
FigureData data_of(std::string name, const std::vector<Subject>& subjects,
                   const std::vector<ColumnOf<Subject>>& columns) {
  FigureData data{std::move(name), {}};
  for (const ColumnOf<Subject>& one : columns) data.columns.push_back(one.column);
  for (const Subject& subject : subjects) {
    nlohmann::ordered_json& row = data.rows.emplace_back(nlohmann::ordered_json::array());
    for (const ColumnOf<Subject>& one : columns) row.push_back(one.value(subject));
  }
  return data;
}

/// A figure: a Vega-Lite specification, its data, title and caption.
struct Figure {
  std::string name;  ///< for `plot`, and its anchor in the page
  std::string title;
  std::string caption;  ///< plain text
  nlohmann::ordered_json specification;
  std::vector<FigureData> data;  ///< the first one is also shown as a table
};

/// A figure with the embedded specification `specification`.vl.json.
Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption,
                 std::vector<FigureData> data);

/// Marks all bounds in the data table and the tooltips as too narrow, and adds `why` to the caption. No
/// effect on a figure without bounds.
void call_bounds_too_narrow(Figure& figure, const std::string& why);

/// Converts the figure's titles, units and caption from a rotary axis to an axis of this kind.
void put_on_axis(Figure& figure, parameters::AxisKind axis);

/// The data as JSON: [{"name", "columns": [[field, title, unit]], "rows"}].
nlohmann::ordered_json data_json(const Figure& figure);

/// Sets the height to `rows` rows of `row` pixels each.
void set_rows(Figure& figure, std::size_t rows, int row);

/// A number for a dataset, with `digits` significant digits; null for NaN and infinities.
nlohmann::ordered_json datum(double value, int digits = 6);

/// Tick values in [low, high] for a logarithmic or symlog axis: 0, and ± 1, 2 and 5 times powers of ten from
/// `smallest` on (only powers of ten if there are many). Empty if an argument is not finite or `smallest` is
/// not positive.
nlohmann::ordered_json round_numbers(double low, double high, double smallest);

/// Sets the number format of an axis with the maximum `largest`: powers of ten for small numbers.
void set_number_format(nlohmann::ordered_json& axis, double largest);

/// Whether sorted positive numbers are closer to equal ratios than to equal differences.
bool spaced_by_ratio(const std::vector<double>& sorted);

}  // namespace zerocount::report
