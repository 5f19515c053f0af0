#pragma once

#include <string_view>

namespace zerocount::measures {

/// Name of a measure within the names of random streams. A measure that is renamed keeps it, because a stream
/// of another name has other random numbers, and every bound by resampling would change.
constexpr std::string_view stream_name(std::string_view measure) {
  return measure == "arrival_time" ? "settling_time" : measure;
}

}  // namespace zerocount::measures
