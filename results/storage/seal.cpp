#include "results/storage/seal.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>

#include "core/failure.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_descriptor.hpp"

namespace zerocount {
namespace {

namespace fs = std::filesystem;

/// Reads up to `bytes.size()` bytes at the file's position; fewer at its end only.
std::size_t read_some(const fs::path& path, const FileDescriptor& file, std::span<std::byte> bytes) {
  std::size_t total = 0;
  while (total < bytes.size()) {
    const ssize_t size = ::read(file.get(), bytes.data() + total, bytes.size() - total);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) fail_with(path, "read", errno);
    if (size == 0) break;
    total += static_cast<std::size_t>(size);
  }
  return total;
}

void require_sha256(bool success) {
  if (!success)
    throw Failure(ExitCode::machine_failed, "the cryptography library of this machine has no SHA-256");
}

/// The seal of the first `length` bytes of the file. Leaves the file's position behind them.
std::string seal_of(const fs::path& path, const FileDescriptor& file, std::size_t length) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  require_sha256(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  std::vector<std::byte> block(std::size_t{1} << 18);
  while (length > 0) {
    const std::size_t size = read_some(path, file, std::span(block).first(std::min(block.size(), length)));
    if (size == 0) fail_with(path, "read", EIO);
    require_sha256(EVP_DigestUpdate(context.get(), block.data(), size) == 1);
    length -= size;
  }
  std::array<unsigned char, 32> digest{};
  require_sha256(EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) == 1);
  std::string text = "zerocount-seal sha256 ";
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text + "\n";
}

std::size_t size_of_file(const fs::path& path, const FileDescriptor& file) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_with(path, "read", errno);
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

void seal(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "write", errno);
  const std::string text = seal_of(path, file, size_of_file(path, file));
  write_all(path, file, text);
}

void require_seal(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "read", errno);
  const std::size_t size = size_of_file(path, file);
  std::string found(seal_length, '\0');
  std::string expected;
  if (size > seal_length) {
    expected = seal_of(path, file, size - seal_length);
    read_some(path, file, std::as_writable_bytes(std::span(found)));
  }
  if (!found.starts_with("zerocount-seal sha256 ")) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: the seal at its end is missing: it was cut short, changed or "
                              "never finished, or is no results file of zerocount",
                              path.string()));
  }
  if (found != expected) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged or changed: the checksum at its end is not that of its contents",
                              path.string()));
  }
}

}  // namespace zerocount
