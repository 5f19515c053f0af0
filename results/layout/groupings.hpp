#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// A way of dividing the trials of every design point into groups: by machine, world (one draw of what all
/// machines share), condition or age. In a results file, the HDF5 group with the grouping's name holds the
/// data of each of its groups, and the number of successful trials of each at each design point.
struct Grouping : study::GroupingTraits {
  std::string_view meaning;     ///< Description of the HDF5 dimension scale that numbers the groups, as its
                                ///< attribute long_name
  std::string_view trials_of;   ///< Phrase that says which trials a group counts, such as "in the world"
  bool has_equal_sizes{false};  ///< Whether all groups have the same number of trials
  bool has_labels{false};       ///< Whether the groups have names
  bool has_values{false};       ///< Whether the HDF5 dimension scale holds the ages; otherwise it numbers the
                                ///< groups from 0
};

/// All groupings of trials, in the order of the results file: machine, world (one draw of what all machines
/// share), condition, age.
std::span<const Grouping> groupings();
const Grouping& grouping_named(std::string_view name);

/// Description of the HDF5 dimension scale that numbers the groups of a grouping.
/// @param unit unit of the ages; "1" for other groupings.
Column group_scale(const Grouping& grouping, const std::string& unit);
/// Description of the table of a grouping's groups, [group], with the inputs that are drawn once for each
/// group.
/// @param unit unit of the ages; "1" for other groupings.
Table group_table(const Grouping& grouping, const std::vector<study::InputColumn>& inputs,
                  const std::string& unit);
/// Description of the table of counts and statistics of a grouping's groups at the design points, [point,
/// group]. It shares the HDF5 group and the scale of group_table().
/// @param has_goal whether trials that meet the goal are counted too.
Table group_count_table(const Grouping& grouping, bool has_goal, std::span<const PointColumn> statistics,
                        const std::string& unit);

}  // namespace zerocount::layout
