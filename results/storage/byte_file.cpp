#include "results/storage/byte_file.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::storage {
namespace {

FileDescriptor open_file(const std::filesystem::path& path, ByteFile::Mode mode) {
  switch (mode) {
    case ByteFile::Mode::read:
      return FileDescriptor(
          ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));  // a pipe would be waited for
    case ByteFile::Mode::create:
      return create_file(path);
    case ByteFile::Mode::change:
      return FileDescriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  }
  return FileDescriptor();
}

/// Copies the bytes that both ranges have in common, from `source` (at `source_offset`) to `target` (at
/// `offset`).
void copy_overlap(std::uint64_t source_offset, std::span<const std::byte> source, std::uint64_t offset,
                  std::span<std::byte> target) {
  const std::uint64_t first = std::max(source_offset, offset);
  const std::uint64_t end = std::min(source_offset + source.size(), offset + target.size());
  if (first >= end) return;
  const std::span<const std::byte> shared = source.subspan(first - source_offset, end - first);
  std::copy(shared.begin(), shared.end(), target.subspan(first - offset).begin());
}

}  // namespace

ByteFile::ByteFile(std::filesystem::path path, Mode mode, WrittenBytes so_far)
    : path_(std::move(path)), mode_(mode), file_(open_file(path_, mode)), written_(std::move(so_far)) {
  const char* const action = writable() ? "open for writing" : "read";
  if (!file_.valid()) fail_with(path_, action, errno);
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) fail_with(path_, action, errno);
  if (!writable() && !S_ISREG(status.st_mode))
    throw Failure(ExitCode::bad_input, fmt::format("{}: this is not a regular file", path_.string()));
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::optional<IoFailure> ByteFile::read_unrecorded(std::uint64_t offset, std::span<std::byte> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t size =
        ::pread(file_.get(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return IoFailure{"read", errno};
    if (size == 0) break;
    done += static_cast<std::size_t>(size);
  }
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(done), bytes.end(), std::byte{0});
  return std::nullopt;
}

bool ByteFile::read(std::uint64_t offset, std::span<std::byte> bytes) {
  if (const std::optional<IoFailure> failed = read_unrecorded(offset, bytes)) {
    note(*failed);
    return false;
  }
  for (const Unwritten& kept : unwritten_) copy_overlap(kept.offset, kept.bytes, offset, bytes);
  return true;
}

void ByteFile::write(std::uint64_t offset, std::span<const std::byte> bytes, Rewritten rewritten) {
  written_.add(offset, bytes, rewritten);
  size_ = std::max<std::uint64_t>(size_, offset + bytes.size());
  while (!failure_ && !bytes.empty()) {
    const ssize_t size = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      note({"write", size < 0 ? errno : EIO});
      break;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(size));
    offset += static_cast<std::uint64_t>(size);
  }
  if (!bytes.empty()) unwritten_.push_back({offset, {bytes.begin(), bytes.end()}});
}

void ByteFile::resize(std::uint64_t size) {
  size_ = size;
  written_.cut(size);
  if (failure_) return;
  int result = 0;
  do {
    result = ::ftruncate(file_.get(), static_cast<off_t>(size));
  } while (result != 0 && errno == EINTR);
  if (result != 0) note({"write", errno});
}

void ByteFile::close(Flush flush) {
  if (flush == Flush::now && writable() && !failure_) {
    if (::fsync(file_.get()) != 0) note({"bring to the disk", errno});
    // Hints: what is read next comes from the disk, in large pieces.
    ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
    ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_WILLNEED);
  }
#ifdef __linux__
  // A hint: the disk begins to write while the program goes on.
  if (flush == Flush::later && writable()) ::sync_file_range(file_.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
#endif
  if (!file_.close()) note({"close", errno});
}

void ByteFile::note(const IoFailure& failure) {
  if (!failure_) failure_ = failure;
}

}  // namespace zerocount::storage
