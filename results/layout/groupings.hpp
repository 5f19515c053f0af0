#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// A grouping of the trials of every design point in a file: what is known of each group is in an HDF5 group
/// of its name, with how many of its trials succeeded at each point.
struct Grouping : study::GroupingTraits {
  std::string_view meaning;     ///< of the dimension scale
  std::string_view trials_of;   ///< which trials are counted: "in the world"
  bool has_equal_sizes{false};  ///< all groups have the same number of trials
  bool has_labels{false};       ///< groups have names
  bool has_values{false};       ///< the scale has the ages; otherwise it counts from 0
};

/// In the order of the file: machine, world, condition, age.
std::span<const Grouping> groupings();
const Grouping& grouping_named(std::string_view name);

/// @param unit of ages; of other groupings "1"
Column group_scale(const Grouping& grouping, const std::string& unit);
/// The table of the groups of a grouping, with what is drawn for each: [group].
Table group_table(const Grouping& grouping, const std::vector<study::InputColumn>& inputs,
                  const std::string& unit);
/// Trials of the groups at the design points, and further statistics: [point, group]. It shares the HDF5
/// group and the scale of group_table().
Table group_count_table(const Grouping& grouping, bool has_goal, std::span<const PointColumn> statistics,
                        const std::string& unit);

}  // namespace zerocount::layout
