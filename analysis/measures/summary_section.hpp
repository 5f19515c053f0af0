#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "results/layout/layout.hpp"

namespace zerocount::measures {

/// A part of a summary that only some studies have.
struct SummarySection {
  std::string key;                           ///< its name in the JSON of each point
  std::vector<nlohmann::ordered_json> json;  ///< [point]
  std::vector<layout::PointColumn> columns;  ///< of the CSV: a value per point
  std::string text;                          ///< below the table, whole lines
  bool open{false};                          ///< the report shows the text at once: it is a result
};

}  // namespace zerocount::measures
