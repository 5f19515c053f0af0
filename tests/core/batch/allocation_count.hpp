#pragma once

#include <cstdint>

namespace zerocount::testing {

/// Number of calls of malloc, calloc, realloc and aligned_alloc so far, by this program and all its
/// libraries. The implementation replaces these functions of the GNU C library in the program that links it.
std::int64_t allocations_so_far();

/// Whether allocations are counted. They are not if a sanitizer has replaced the functions.
bool allocations_are_counted();

}  // namespace zerocount::testing
