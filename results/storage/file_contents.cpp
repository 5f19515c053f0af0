#include "results/storage/file_contents.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

std::string bytes_at(const std::filesystem::path& path, std::size_t offset, std::size_t size) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

std::size_t size_of_file(const std::filesystem::path& path, const FileDescriptor& file) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_with(path, "read", errno);
  return static_cast<std::size_t>(status.st_size);
}

std::size_t read_some(const std::filesystem::path& path, const FileDescriptor& file,
                      std::span<std::byte> bytes) {
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

void read_at(const std::filesystem::path& path, const FileDescriptor& file, std::uint64_t offset,
             std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::pread(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) fail_with(path, "read", size < 0 ? errno : EIO);
    offset += static_cast<std::uint64_t>(size);
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

hash::Sha256 sha256_of(const std::filesystem::path& path, const FileDescriptor& file, std::size_t length) {
  hash::Sha256Hash hash;
  std::vector<std::byte> block(std::size_t{1} << 18);
  while (length > 0) {
    const std::size_t size = read_some(path, file, std::span(block).first(std::min(block.size(), length)));
    if (size == 0) fail_with(path, "read", EIO);
    hash.add(std::span(block).first(size));
    length -= size;
  }
  return hash.digest();
}

}  // namespace zerocount::storage
