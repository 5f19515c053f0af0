#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "analysis/text/text.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::measures {

/// A part of a summary that only some studies have.
struct SummarySection {
  std::string key;                           ///< its name in the JSON of each point
  std::vector<nlohmann::ordered_json> json;  ///< [point]
  std::vector<layout::PointColumn> columns;  ///< of the CSV: a value per point
  std::string title{};                       ///< above its tables, one line; may be empty
  std::vector<text::PointTable> tables{};    ///< below the main table
  std::string note{};                        ///< below these, whole lines
  bool open{false};                          ///< the report shows the section at once: it is a result
  bool of_success{false};                    ///< about success: not the question of a study with a goal
};

/// The rows of these points in the tables of the section, with its title and its note; empty without rows.
std::string text_of(const SummarySection& section, std::span<const std::int64_t> points);

}  // namespace zerocount::measures
