#pragma once

#include <vector>

#include "experiments/sections/assignments.hpp"

namespace zerocount::sections {

/// Reads `conditions: {NAME: {PATH: value}}` as the last axis of the plan: an override is another value of
/// its slot, drawn as often as the parameter and with the same random number. Reports an override of a
/// parameter that is swept. Their names go to the study.
/// @param swept axes of the sweep. All parameters must be read already
/// @return an axis without options, after a report, if there are none
SweptAxis read_conditions(const yaml::Field& field, const std::vector<SweptAxis>& swept,
                          keys::Reading& reading);

/// Reports overrides of parameters that come from `samples`, or that `tune` may change.
/// @param root the manifest. @param sampled [sampled slot of the plan] place in the header of the table
void check_overrides(const yaml::Field& root, const SweptAxis& conditions,
                     const std::vector<yaml::Place>& sampled, keys::Reading& reading);

}  // namespace zerocount::sections
