#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace zerocount::document {

/// A column of a dataset of a figure.
struct FigureColumn {
  std::string field;  ///< Name of the column in the figure's specification.
  /// Header of the column in the data table that is shown with the figure; empty: the column is not shown
  /// there.
  std::string title;
  std::string unit;  ///< Unit of the values; "1" for dimensionless numbers, "" for text.
};

/// A dataset of a figure, named in the specification by {"data": {"name": name}}.
struct FigureData {
  std::string name;
  std::vector<FigureColumn> columns;
  std::vector<nlohmann::ordered_json> rows{};  ///< [row] JSON array with one value per column.
};

/// A column of a dataset, with the function that returns its value for a subject (the object that one row
/// describes).
template <class Subject>
struct ColumnOf {
  FigureColumn column;
  std::function<nlohmann::ordered_json(const Subject&)> value;
};

/// The dataset with one row for each of `subjects`, whose values the functions of `columns` return.
/// @param name name of the dataset in the specification
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
  /// Name of the figure, by which the command `plot` selects it; also its anchor in the HTML page.
  std::string name;
  std::string title;
  std::string caption;  ///< Caption, plain text.
  nlohmann::ordered_json specification;
  std::vector<FigureData> data;  ///< Datasets of the figure; the first one is also shown as a table.
  /// Values for the placeholders in the specification: {"NAME": value that replaces "$NAME"}.
  nlohmann::ordered_json parameters{};
};

}  // namespace zerocount::document
