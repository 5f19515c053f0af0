#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/shapes/shape.hpp"

namespace zerocount::sections {

constexpr std::size_t max_points = 1'000'000;  ///< of a sweep

/// `count` numbers from `from` to `to`, both included, with equal distances or (logarithmic) equal ratios.
struct Spacing {
  double from{0.0};
  double to{1.0};
  std::size_t count{2};
  bool logarithmic{false};
};

/// The value of the key linspace, or logspace: [first value, last value, number of values].
shapes::Shape spacing_shape(bool logarithmic);

/// The spacing in `field`, the value of that key. Reports errors and returns nothing then.
std::optional<Spacing> read_spacing(const yaml::Field& field, bool logarithmic, yaml::Problems& problems);

/// The numbers; those between the ends are rounded to 15 significant digits.
std::vector<double> spaced_values(const Spacing& spacing);

/// "name=value" for each of `values`, as short as possible but all different.
std::vector<std::string> spaced_labels(const std::string& name, const std::vector<double>& values);

}  // namespace zerocount::sections
