#pragma once

#include <cstdint>

namespace zerocount::testing {

/// Calls of malloc, calloc, realloc and aligned_alloc, by this program and all its libraries, so far. Built
/// into a program, it takes the place of those functions (of the GNU C library).
std::int64_t allocations_so_far();

/// Whether they are counted: not where a sanitizer has taken their place.
bool allocations_are_counted();

}  // namespace zerocount::testing
