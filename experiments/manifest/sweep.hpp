#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/manifest/values.hpp"
#include "experiments/study/study.hpp"

namespace zerocount {

constexpr std::size_t max_points = 1'000'000;

/// A factor of the product of design points, as read: the axis for the plan, and what names its options.
struct SweptAxis {
  bool cases{false};
  std::string name;                   ///< the swept key; "case" for the cases
  std::vector<std::string> labels{};  ///< [option]
  PlanAxis axis{};
  std::vector<Place> places{};       ///< [assignment]
  std::vector<std::size_t> slots{};  ///< that some option assigns, in order of appearance
};

/// Reads `sweep: {grid, cases}`. The cases are the slowest axis; then come the keys of the grid in their
/// order, the last one fastest. Where both give a value to one parameter, the grid's wins, with a warning. A
/// product of more than max_points is a problem, found without writing it out. `linspace: [a, b, n]` is n
/// numbers at equal distances from a to b, both included; `logspace: [a, b, n]` is n numbers at equal ratios
/// from a to b, which are the end values themselves and not exponents. The values between are rounded to 15
/// significant digits.
std::vector<SweptAxis> read_sweep(const Field& sweep, Reading& reading);

/// One label per point, "a, controller.kp=0"; {"all"} where there are no axes.
std::vector<std::string> label_points(const std::vector<SweptAxis>& axes);

/// The axes as results files show them: the name of the case, and one axis for every slot that is swept.
std::vector<SweepAxis> describe_axes(const std::vector<SweptAxis>& axes, const StudyPlan& plan);

}  // namespace zerocount
