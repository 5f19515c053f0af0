#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Record of the values written to a file, to compare with the values read back.
namespace zerocount::hdf5 {

using AttributeValue = std::variant<std::string, std::uint64_t, std::vector<std::int64_t>>;

/// Rows [first, first + rows) of a dataset.
struct WrittenRows {
  std::int64_t first{0};
  std::int64_t rows{0};
  std::size_t digest{0};  ///< of the bytes of their elements
};

/// A chunk of a dataset whose filters we have applied.
struct WrittenChunk {
  std::int64_t first{0};  ///< its first row
  std::size_t digest{0};  ///< of the stored bytes
};

/// A group or a dataset.
struct WrittenObject {
  std::map<std::string, AttributeValue> attributes;
  std::vector<WrittenRows> rows;
  std::vector<WrittenChunk> chunks;
  std::vector<std::string> texts;  ///< all elements of a dataset of texts
  bool is_scale{false};
  std::vector<std::pair<unsigned, std::string>> scales;  ///< dimension, and the path of its scale
};

/// By path.
using WrittenValues = std::map<std::string, WrittenObject>;

}  // namespace zerocount::hdf5
