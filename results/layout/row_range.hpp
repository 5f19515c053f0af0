#pragma once

#include <cstdint>

namespace zerocount {

/// A contiguous block of trials by global row: row = point·trials + index, so that the trials of a point are
/// neighbours.
struct RowRange {
  std::int64_t first{0};
  std::int64_t count{0};

  std::int64_t end() const { return first + count; }
  bool operator==(const RowRange&) const = default;
};

}  // namespace zerocount
