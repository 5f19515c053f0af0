#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/theory/point_theory.hpp"

namespace zerocount::study_commands {

/// A statement of the theory on a design point, such as "(6) stable below" and "1.5e-04 N m/count".
struct TheoryItem {
  std::string name;
  std::string value;
  std::string brief{};  ///< the value in a table; empty: as it is
};

std::vector<TheoryItem> theory_items(const theory::PointTheory& theory);

/// The items of design points: of a single one a line each; of several first those that are the same at all
/// of them, then a table with a row per point.
/// @param labels, items [point] of the first points. @param points of the study
std::string theory_text(std::span<const std::string> labels, std::span<const std::vector<TheoryItem>> items,
                        std::int64_t points);

/// Why approach.exceeds_hold(), for a warning: continues "the loop's slowest time constant".
std::string slowness_text(const theory::Approach& approach);

/// "1 core", "3 cores".
std::string counted(std::int64_t count, std::string_view noun);

}  // namespace zerocount::study_commands
