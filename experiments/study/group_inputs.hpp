#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The inputs that all trials of a group share: [column of InputColumns::shared], in that column's unit.
/// @throws Failure (bad_input) for a group that the study does not have
std::vector<double> group_inputs(const Study& study, Grouping grouping, std::int64_t group);

/// A value that is drawn for each world.
struct WorldValues {
  std::string name;  ///< dotted path
  std::string unit;
  std::vector<double> values;  ///< [world]
};

/// The values drawn per world at a design point, those of the sweep included; empty without worlds.
std::vector<WorldValues> world_values(const Study& study, std::int64_t point);

}  // namespace zerocount::study
