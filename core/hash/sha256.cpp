#include "core/hash/sha256.hpp"

#include <fmt/format.h>
#include <nettle/base64.h>

namespace zerocount::hash {

Sha256Hash::Sha256Hash() {
  sha256_init(&context_);
}

void Sha256Hash::add(std::span<const std::byte> bytes) {
  sha256_update(&context_, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

Sha256 Sha256Hash::digest() {
  Sha256 digest{};
  sha256_digest(&context_, digest.size(), digest.data());
  return digest;
}

Sha256 sha256(std::string_view text) {
  Sha256Hash hash;
  hash.add(std::as_bytes(std::span(text)));
  return hash.digest();
}

std::string hexadecimal(const Sha256& digest) {
  std::string digits;
  for (const std::uint8_t byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::string base64(const Sha256& digest) {
  std::string text(BASE64_ENCODE_RAW_LENGTH(digest.size()), '\0');
  base64_encode_raw(text.data(), digest.size(), digest.data());
  return text;
}

std::string sha256_hex(std::string_view text) {
  return hexadecimal(sha256(text));
}

}  // namespace zerocount::hash
