#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "core/hash/sha256.hpp"

namespace zerocount::timeline {
class Timeline;
}

namespace zerocount::storage {

/// How bytes of a file are written again: some of them, or all or none, as those of a chunk.
enum class Rewritten { in_part, as_a_whole };

/// What was written to a file, to prove that it is there. Of bytes that are rewritten as a whole their hash
/// is kept, so that memory does not grow with the data; others are kept themselves.
class WrittenBytes {
 public:
  void add(std::uint64_t offset, std::span<const std::byte> bytes, Rewritten rewritten);
  /// The file ends at `size`.
  void cut(std::uint64_t size);
  /// Without the bytes that are rewritten in part.
  WrittenBytes hashed() const;

  /// Reads the whole closed file and compares it. Several threads read and compare.
  /// @return the SHA-256 of the file
  /// @param timeline gets the spans of reading; null: none
  /// @throws Failure (machine_failed) if anything differs or is missing, or the file cannot be read
  hash::Sha256 require_in(const std::filesystem::path& path, timeline::Timeline* timeline = nullptr) const;

 private:
  struct Piece {
    std::size_t size{0};
    std::size_t hash{0};
    std::vector<std::byte> bytes{};  ///< empty where only the hash is known
  };
  void clear(std::uint64_t first, std::uint64_t end);

  std::map<std::uint64_t, Piece> pieces_;  ///< by offset, without overlaps
};

}  // namespace zerocount::storage
