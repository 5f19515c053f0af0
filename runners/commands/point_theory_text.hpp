#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "analysis/theory/point_theory.hpp"

namespace zerocount::commands {

/// The lines of `check` on a design point.
std::string describe(const theory::PointTheory& theory);

/// Why approach.exceeds_hold(), for a warning: continues "the loop's slowest time constant".
std::string slowness_text(const theory::Approach& approach);

/// "1 core", "3 cores".
std::string counted(std::int64_t count, std::string_view noun);

}  // namespace zerocount::commands
