#pragma once

#include "experiments/sections/assignments.hpp"

namespace zerocount::sections {

/// Reads `ages: {at: [0, 1.0e+5], unit: cycles}` into the study and its plan. Must come before the values
/// that change with age.
/// @param root the manifest
void read_ages(const yaml::Field& root, keys::Reading& reading);

/// The axis of what every machine bears in turn: each condition at each age, those of an age together. Their
/// names go to the study. An axis without options where there are neither.
/// @param conditions of read_conditions(); without options where there are none
SweptAxis conditions_at_ages(const SweptAxis& conditions, keys::Reading& reading);

}  // namespace zerocount::sections
