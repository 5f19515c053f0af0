#pragma once

#include <cstdint>
#include <span>

namespace zerocount::layout {

/// A contiguous block of trials by global row: row = point·trials + index, so that the trials of a point are
/// neighbours.
struct RowRange {
  std::int64_t first{0};
  std::int64_t count{0};

  std::int64_t end() const { return first + count; }
  bool operator==(const RowRange&) const = default;
};

/// Number of rows of all `ranges`.
inline std::int64_t total_rows(std::span<const RowRange> ranges) {
  std::int64_t rows = 0;
  for (const RowRange& range : ranges) rows += range.count;
  return rows;
}

}  // namespace zerocount::layout
