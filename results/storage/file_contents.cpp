#include "results/storage/file_contents.hpp"

#include <algorithm>
#include <cerrno>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

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
