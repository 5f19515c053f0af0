#include "results/storage/seal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "core/failure.hpp"
#include "experiments/designs/sha256.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_descriptor.hpp"

namespace zerocount {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view seal_start = "zerocount-seal sha256 ";

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

/// The seal of the first `length` bytes of the file. Leaves the file's position behind them.
std::string seal_of(const fs::path& path, const FileDescriptor& file, std::size_t length) {
  Sha256Hash hash;
  std::vector<std::byte> block(std::size_t{1} << 18);
  while (length > 0) {
    const std::size_t size = read_some(path, file, std::span(block).first(std::min(block.size(), length)));
    if (size == 0) fail_with(path, "read", EIO);
    hash.add(std::span(block).first(size));
    length -= size;
  }
  return fmt::format("{}{}\n", seal_start, hexadecimal(hash.digest()));
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
  if (!found.starts_with(seal_start)) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the seal at its end is missing: it was changed since it was written, or damaged, "
                    "or is no results file of zerocount",
                    path.string()));
  }
  if (found != expected) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: changed since it was written, or damaged: the checksum at its end is not that "
                    "of its contents",
                    path.string()));
  }
}

}  // namespace zerocount
