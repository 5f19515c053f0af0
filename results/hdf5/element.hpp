#pragma once

#include <cstddef>

namespace zerocount::hdf5 {

/// Type of a dataset's elements, in memory and in the file (little-endian in the file).
enum class Element {
  float64,  ///< double, 8 bytes
  int64,    ///< std::int64_t, 8 bytes
  int32,    ///< std::int32_t, 4 bytes
  int8,     ///< std::int8_t, 1 byte, for the numbers of an enumeration
  flag,     ///< Truth value: std::uint8_t, 0 or 1
  text      ///< UTF-8 string of variable length
};

/// Size of one element in memory, bytes. Not for text, which is read and written as strings.
constexpr std::size_t size_of(Element element) {
  switch (element) {
    case Element::float64:
    case Element::int64:
      return 8;
    case Element::int32:
      return 4;
    case Element::int8:
    case Element::flag:
      return 1;
    case Element::text:
      break;
  }
  return 0;
}

/// Filters of a new dataset: shuffle and deflate (smaller file), or none (larger, but faster to write).
enum class Compression { deflate, none };

}  // namespace zerocount::hdf5
