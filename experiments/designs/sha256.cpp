#include "experiments/designs/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include "core/failure.hpp"

namespace zerocount {

Sha256 sha256(std::string_view text) {
  Sha256 digest{};
  if (EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1) {
    throw Failure(ExitCode::machine_failed, "the cryptography library cannot compute SHA-256");
  }
  return digest;
}

std::string sha256_hex(std::string_view text) {
  std::string digits;
  for (const std::uint8_t byte : sha256(text)) digits += fmt::format("{:02x}", byte);
  return digits;
}

}  // namespace zerocount
