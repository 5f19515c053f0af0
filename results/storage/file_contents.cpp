#include "results/storage/file_contents.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
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

namespace {

namespace fs = std::filesystem;

constexpr std::string_view trailer_start = "zerocount-seal sha256 ";
/// The last bytes of the open file, as many as a checksum trailer has.
std::string read_trailer(const fs::path& path, const FileDescriptor& file) {
  std::string found(checksum_trailer_length, '\0');
  const std::size_t size = size_of_file(path, file);
  if (size <= checksum_trailer_length) return found;
  if (::lseek(file.get(), static_cast<off_t>(size - checksum_trailer_length), SEEK_SET) < 0)
    fail_with(path, "read", errno);
  read_some(path, file, std::as_writable_bytes(std::span(found)));
  return found;
}

/// Whether the file is in the format of HDF5 1.10 and later, which zerocount never writes.
bool has_newer_format(const fs::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  constexpr char newest_version = 2;  // of the superblock, which follows the signature
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "read", errno);
  std::string start(signature.size() + 1, '\0');
  read_some(path, file, std::as_writable_bytes(std::span(start)));
  return start.starts_with(signature) && start.back() > newest_version;
}

[[noreturn]] void fail_missing(const fs::path& path) {
  if (has_newer_format(path)) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: another program has rewritten it in the format of HDF5 1.10, as "
                              "'h5repack --latest' does, and without the checksum at its end; "
                              "run its manifest again",
                              path.string()));
  }
  throw Failure(
      ExitCode::bad_data,
      fmt::format(
          "{}: the checksum at its end is missing: it was changed since it was written, or "
          "damaged, or is not a results file of zerocount (a program that only opens it to write cuts the "
          "checksum off); run its manifest again",
          path.string()));
}

}  // namespace

std::string checksum_trailer(const hash::Sha256& checksum) {
  return fmt::format("{}{}\n", trailer_start, hash::hexadecimal(checksum));
}

ChecksumState check_checksum(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "read", errno);
  const std::size_t size = size_of_file(path, file);
  std::string expected;
  if (size > checksum_trailer_length)
    expected = checksum_trailer(sha256_of(path, file, size - checksum_trailer_length));
  const std::string found = read_trailer(path, file);
  if (!found.starts_with(trailer_start)) return ChecksumState::missing;
  return found == expected ? ChecksumState::valid : ChecksumState::wrong;
}

void require_valid_checksum(const fs::path& path) {
  switch (check_checksum(path)) {
    case ChecksumState::valid:
      return;
    case ChecksumState::missing:
      fail_missing(path);
    case ChecksumState::wrong:
      throw Failure(
          ExitCode::bad_data,
          fmt::format("{}: changed since it was written, or damaged: the checksum at its end is not that "
                      "of its contents; run its manifest again",
                      path.string()));
  }
}

void publish_compared(const fs::path& path, const hash::Sha256& checksum) {
  const fs::path part = part_of(path);
  {
    const FileDescriptor file(::open(part.c_str(), O_RDWR | O_CLOEXEC));
    if (!file.valid()) fail_with(part, "open for writing", errno);
    if (::lseek(file.get(), 0, SEEK_END) < 0) fail_with(part, "write", errno);
    const std::string text = checksum_trailer(checksum);
    write_all(part, file, text);
    synchronise(part, file);
    if (read_trailer(part, file) != text) fail_read_back(part, "the checksum at its end differs");
  }
  publish(path);
}

std::string recorded_checksum(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "read", errno);
  const std::string found = read_trailer(path, file);
  if (!found.starts_with(trailer_start)) fail_missing(path);
  return found.substr(trailer_start.size(), 64);
}

}  // namespace zerocount::storage
