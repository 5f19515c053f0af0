#include "core/hash/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include "core/failure/failure.hpp"

namespace zerocount::hash {
namespace {

void require(bool success) {
  if (!success) {
    throw Failure(ExitCode::machine_failed, "the cryptography library cannot compute SHA-256");
  }
}

}  // namespace

Sha256Hash::Sha256Hash() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  require(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256Hash::add(std::span<const std::byte> bytes) {
  require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
}

Sha256 Sha256Hash::digest() {
  Sha256 digest{};
  require(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) == 1);
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
  std::array<unsigned char, 45> text{};  // with the zero that the library appends
  const int size = EVP_EncodeBlock(text.data(), digest.data(), static_cast<int>(digest.size()));
  return {text.begin(), text.begin() + size};
}

std::string sha256_hex(std::string_view text) {
  return hexadecimal(sha256(text));
}

}  // namespace zerocount::hash
