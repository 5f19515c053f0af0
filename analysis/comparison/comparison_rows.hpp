#pragma once

#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"

namespace zerocount::comparison {

/// One judgement as the cells of a table.
struct ComparisonRow {
  std::string point;
  std::string measure;
  std::string baseline;
  std::string current;
  std::string worse_by;  ///< the effect
  std::string bounds;
  std::string margin;  ///< or the limit of a requirement
  std::string p;       ///< adjusted
  std::string verdict;
  std::string note;
  bool noteworthy{false};  ///< it did not simply pass
};

/// The measures and requirements of all points, in order.
std::vector<ComparisonRow> comparison_rows(const StudyComparison& comparison);

/// What was compared with what, as names and values.
std::vector<std::pair<std::string, std::string>> comparison_facts(const StudyComparison& comparison);

}  // namespace zerocount::comparison
