#pragma once

#include <cstdio>

#include <fmt/format.h>

#include "experiments/study/study.hpp"

namespace zerocount::commands {

/// Prints the warnings about the manifest to stderr.
inline void warn(const study::Study& study) {
  for (const std::string& warning : study.warnings) fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace zerocount::commands
