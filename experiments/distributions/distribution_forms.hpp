#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/distributions/distribution.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// How a manifest writes one distribution: a map with the one key `name`.
struct DistributionForm {
  std::string_view name;
  std::string_view shown;              ///< what stands after the name: "[low, high]"
  std::vector<std::string_view> keys;  ///< the numbers it takes; none: a list of any length
  bool by_key{false};                  ///< a map of the keys; else a list in their order
  bool whole_numbers{false};           ///< takes and draws whole numbers
  std::string_view meaning;
  Distribution (*make)(const std::vector<double>& numbers){nullptr};
};

/// All distributions, except `profile`.
std::span<const DistributionForm> distribution_forms();

/// The names, "uniform, log_uniform, …", for messages.
std::string distribution_names();

/// The distribution in `field`, the value of the key `form.name`. Reports what is wrong and returns nothing,
/// also where the numbers make no distribution (low above high, say).
std::optional<Distribution> read_distribution(const DistributionForm& form, const Field& field,
                                              Problems& problems);

/// The form that `entry` of the map names. Reports what stands there instead, with the nearest name among the
/// forms and `others`, and returns null.
const DistributionForm* find_form(const Field& map, const YamlEntry& entry,
                                  const std::vector<std::string>& others, std::string_view expected,
                                  Problems& problems);

}  // namespace zerocount
