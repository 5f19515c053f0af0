#pragma once

#include <cstddef>

namespace zerocount::hdf5 {

/// Type of a column's elements, in memory and in the file (little-endian in the file).
enum class Element {
  float64,  ///< double
  int64,    ///< std::int64_t
  int32,    ///< std::int32_t
  int8,     ///< std::int8_t, an enumeration
  flag,     ///< std::uint8_t, 0 or 1
  text      ///< variable-length UTF-8 string
};

/// Bytes of one element in memory. Not for text, which is read and written as strings.
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

/// Filters of a dataset: shuffle and deflate, or none (faster to write, larger).
enum class Compression { deflate, none };

}  // namespace zerocount::hdf5
