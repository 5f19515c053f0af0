#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Trials `first` to `first + count − 1` of experiments/<name>.yaml, which has one design point.
/// @param overrides "key=value", as with --set.
std::vector<trial::TrialParameters> bench_trials(const std::string& name, std::int64_t first,
                                                 std::int64_t count,
                                                 const std::vector<std::string>& overrides = {});

}  // namespace zerocount::testing
