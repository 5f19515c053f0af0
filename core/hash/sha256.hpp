#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nettle/sha2.h>

namespace zerocount::hash {

using Sha256 = std::array<std::uint8_t, 32>;

/// Computes the SHA-256 checksum (FIPS 180-4) of bytes that are added piece by piece.
class Sha256Hash {
 public:
  Sha256Hash();

  void add(std::span<const std::byte> bytes);
  /// The SHA-256 checksum of all added bytes. No bytes can be added afterwards.
  Sha256 digest();

 private:
  sha256_ctx context_{};
};

/// SHA-256 of the bytes of `text`.
Sha256 sha256(std::string_view text);

/// The checksum as 64 lower-case hexadecimal digits.
std::string hexadecimal(const Sha256& digest);

/// The checksum in base64 (RFC 4648, section 4), 44 characters.
std::string base64(const Sha256& digest);

/// SHA-256 of the bytes of `text` as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace zerocount::hash
