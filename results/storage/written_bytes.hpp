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

/// Manner in which a range of bytes in a file may be written again later: some of its bytes (in_part), or all
/// or none of them (as_a_whole), as for a chunk.
enum class Rewritten { in_part, as_a_whole };

/// Record of the bytes written to a file, to prove later that the file contains them. For ranges that are
/// rewritten only as a whole, just a hash is kept, so that memory does not grow with the data. Other bytes
/// are kept themselves.
class WrittenBytes {
 public:
  void add(std::uint64_t offset, std::span<const std::byte> bytes, Rewritten rewritten);
  /// Records that the file was cut or extended to `size` bytes.
  void cut(std::uint64_t size);
  /// A record with only the ranges whose hash is kept, without the bytes that may be rewritten in part.
  WrittenBytes hashed() const;

  /// Reads the whole closed file and compares it with this record. Several threads read and compare.
  /// @return the SHA-256 of the file
  /// @param timeline records the threads' reading; null: no record
  /// @throws Failure (machine_failed) if anything differs or is missing, or the file cannot be read
  hash::Sha256 require_in(const std::filesystem::path& path, timeline::Timeline* timeline = nullptr) const;

 private:
  struct Piece {
    std::size_t size{0};
    std::size_t hash{0};
    std::vector<std::byte> bytes{};  ///< Bytes of the range; empty if only the hash is kept
  };
  void clear(std::uint64_t first, std::uint64_t end);

  std::map<std::uint64_t, Piece> pieces_;  ///< Ranges of written bytes, by offset in the file, without
                                           ///< overlaps
};

}  // namespace zerocount::storage
