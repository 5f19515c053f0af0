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

/// Manner in which bytes of a file may be written again: some of them, or all or none as with a chunk.
enum class Rewritten { in_part, as_a_whole };

/// Record of the bytes written to a file, to prove that they are there. For bytes that are rewritten as a
/// whole only a hash is kept, so that memory does not grow with the data. Other bytes are kept themselves.
class WrittenBytes {
 public:
  void add(std::uint64_t offset, std::span<const std::byte> bytes, Rewritten rewritten);
  /// Notes that the file ends at `size`.
  void cut(std::uint64_t size);
  /// The pieces of which only the hash is known, without the bytes that are rewritten in part.
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
    std::vector<std::byte> bytes{};  ///< Bytes of the piece; empty if only the hash is known
  };
  void clear(std::uint64_t first, std::uint64_t end);

  std::map<std::uint64_t, Piece> pieces_;  ///< Pieces by offset, without overlaps
};

}  // namespace zerocount::storage
