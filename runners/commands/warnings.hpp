#pragma once

#include <cstdio>

#include <fmt/format.h>

#include "experiments/study/study.hpp"

namespace zerocount {

/// Prints to stderr what of the manifest is allowed but may surprise.
inline void warn(const Study& study) {
  for (const std::string& warning : study.warnings) fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace zerocount
