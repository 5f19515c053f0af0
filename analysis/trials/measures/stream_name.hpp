#pragma once

#include <string_view>

namespace zerocount::measures {

/// Name of a measure within the names of random streams. A measure that was renamed keeps its old name here:
/// a stream with another name has other random numbers, and every bound by resampling would change.
constexpr std::string_view stream_name(std::string_view measure) {
  return measure == "arrival_time" ? "settling_time" : measure;
}

}  // namespace zerocount::measures
