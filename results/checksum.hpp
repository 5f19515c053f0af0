#pragma once

#include <span>
#include <string>

#include "experiments/sha256.hpp"

namespace zerocount {

/// SHA-256 of texts in order, each followed by a zero byte. HDF5 keeps texts where its own checksums do not reach.
inline std::string sha256_of_texts(std::span<const std::string> texts) {
  std::string joined;
  for (const std::string& text : texts) joined.append(text).push_back('\0');
  return sha256_hex(joined);
}

}  // namespace zerocount
