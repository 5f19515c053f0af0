#pragma once

#include <string>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/sections/assignments.hpp"
#include "experiments/study/columns.hpp"

namespace zerocount::sections {

/// Reads `sweep: {grid, cases}`. The cases are the slowest axis, followed by the keys of the grid in their
/// order, the last one fastest. If both give a value to a parameter, the grid takes precedence, with a
/// warning. A product of more than max_points is an error, found without expanding it. `linspace: [a, b, n]`
/// is n numbers with equal distances from a to b, both included; `logspace: [a, b, n]` is n numbers with
/// equal ratios from a to b (values, not exponents). The values between the ends are rounded to 15
/// significant digits.
std::vector<SweptAxis> read_sweep(const yaml::Field& sweep, keys::Reading& reading);

/// One label per point, "a, controller.kp=0"; {"all"} without axes.
std::vector<std::string> label_points(const std::vector<SweptAxis>& axes);

/// The axes of the results file: the name of the case, and one axis for every swept slot.
std::vector<study::SweepAxis> describe_axes(const std::vector<SweptAxis>& axes, const study::StudyPlan& plan);

}  // namespace zerocount::sections
