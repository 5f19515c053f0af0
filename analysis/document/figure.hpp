#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace zerocount::document {

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

/// A column of a dataset, with the function that returns its value for a subject.
template <class Subject>
struct ColumnOf {
  FigureColumn column;
  std::function<nlohmann::ordered_json(const Subject&)> value;
};

/// A dataset with one row for each of `subjects`.
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
  std::string name;  ///< Name for the command `plot`, and anchor of the figure in the page.
  std::string title;
  std::string caption;  ///< plain text
  nlohmann::ordered_json specification;
  std::vector<FigureData> data;  ///< the first one is also shown as a table
  /// Values for the placeholders in the specification: {"NAME": value that replaces "$NAME"}.
  nlohmann::ordered_json parameters{};
};

}  // namespace zerocount::document
