#include "tests/core/batch/allocation_count.hpp"

#include <cstddef>

namespace zerocount::testing {
namespace {

std::int64_t allocations = 0;

}  // namespace

std::int64_t allocations_so_far() {
  return allocations;
}

bool allocations_are_counted() {
#ifdef ZEROCOUNT_SANITIZED
  return false;
#else
  return true;
#endif
}

}  // namespace zerocount::testing

#ifndef ZEROCOUNT_SANITIZED

// The functions behind malloc and the like, which the GNU C library keeps for those who replace them.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++zerocount::testing::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++zerocount::testing::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++zerocount::testing::allocations;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++zerocount::testing::allocations;
  return __libc_memalign(alignment, size);
}
}
// NOLINTEND(bugprone-reserved-identifier)

#endif
