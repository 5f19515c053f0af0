#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/yaml/scalars.hpp"

namespace zerocount::sections {

/// `count` numbers from `from` to `to`, both included, with equal distances or (logarithmic) equal ratios.
struct Spacing {
  double from{0.0};
  double to{1.0};
  std::size_t count{2};
  bool logarithmic{false};
};

/// The spacing in `field`, the value of the key `name`, linspace or logspace: [first value, last value,
/// number of values]. At most `max_values` values. Reports errors and returns nothing then.
std::optional<Spacing> read_spacing(const yaml::Field& field, const std::string& name, std::size_t max_values,
                                    yaml::Problems& problems);

/// The numbers; those between the ends are rounded to 15 significant digits.
std::vector<double> spaced_values(const Spacing& spacing);

/// "name=value" for each of `values`, as short as possible but all different.
std::vector<std::string> spaced_labels(const std::string& name, const std::vector<double>& values);

}  // namespace zerocount::sections
