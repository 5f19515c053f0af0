#include "experiments/parameters/earlier_defaults.hpp"

#include <array>

namespace zerocount::parameters {
namespace {

constexpr std::array changed_defaults{
    // Assumed until it was found that the outcomes reported in the paper imply another value.
    EarlierDefault{.name = "friction.beta", .value = 2.0e5, .until_version = 2},
};

}  // namespace

std::span<const EarlierDefault> earlier_defaults() {
  return changed_defaults;
}

double default_value_in(const Parameter& parameter, std::int64_t version) {
  for (const EarlierDefault& earlier : changed_defaults) {
    if (earlier.name == parameter.name && version <= earlier.until_version) return earlier.value;
  }
  return default_value(parameter);
}

}  // namespace zerocount::parameters
