#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// A grouping of the trials of every design point in a file. The HDF5 group with its name holds the data of
/// each of its groups, and how many of their trials succeeded at each point.
struct Grouping : study::GroupingTraits {
  std::string_view meaning;     ///< Long name of the dimension scale
  std::string_view trials_of;   ///< Phrase that says which trials are counted, such as "in the world"
  bool has_equal_sizes{false};  ///< All groups have the same number of trials.
  bool has_labels{false};       ///< The groups have names.
  bool has_values{false};       ///< The scale holds the ages; otherwise it counts from 0.
};

/// All groupings, in the order of the file: machine, world, condition, age.
std::span<const Grouping> groupings();
const Grouping& grouping_named(std::string_view name);

/// Dimension scale of a grouping.
/// @param unit unit of the ages; "1" for other groupings.
Column group_scale(const Grouping& grouping, const std::string& unit);
/// The table of the groups of a grouping, with the inputs that are drawn for each group: [group].
Table group_table(const Grouping& grouping, const std::vector<study::InputColumn>& inputs,
                  const std::string& unit);
/// Trials of the groups at the design points, and further statistics: [point, group]. It shares the HDF5
/// group and the scale of group_table().
Table group_count_table(const Grouping& grouping, bool has_goal, std::span<const PointColumn> statistics,
                        const std::string& unit);

}  // namespace zerocount::layout
