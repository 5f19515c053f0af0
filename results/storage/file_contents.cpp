#include "results/storage/file_contents.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <memory>
#include <system_error>
#include <vector>

#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>
#include <sys/stat.h>
#include <unistd.h>

#include "results/storage/durable_file.hpp"
#include "results/timeline/timeline.hpp"

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

namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;

struct FileBlock {
  std::size_t offset;
  std::vector<std::byte> bytes;
};

/// @throws Failure (machine_failed) if it cannot be read to its end
void read_block(const std::filesystem::path& path, const FileDescriptor& file, FileBlock& block) {
  for (std::size_t done = 0; done < block.bytes.size();) {
    const ssize_t size = ::pread(file.get(), block.bytes.data() + done, block.bytes.size() - done,
                                 static_cast<off_t>(block.offset + done));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) fail_with(path, "read", size < 0 ? errno : EIO);
    done += static_cast<std::size_t>(size);
  }
}

}  // namespace

hash::Sha256 sha256_read_ahead(const std::filesystem::path& path, const FileDescriptor& file,
                               std::size_t length, timeline::Timeline* timeline) {
  namespace tbb = oneapi::tbb;
  using Mode = tbb::filter_mode;
  using BlockPointer = std::shared_ptr<FileBlock>;
  hash::Sha256Hash hash;
  std::size_t hashed = 0;
  std::size_t next = 0;
  const auto next_block = [&](tbb::flow_control& control) -> BlockPointer {
    if (next == length) {
      control.stop();
      return nullptr;
    }
    auto block = std::make_shared<FileBlock>(FileBlock{next, {}});
    next += std::min(block_size, length - next);
    block->bytes.resize(next - block->offset);
    return block;
  };
  const auto read = [&](const BlockPointer& block) {
    const timeline::TimeSpan span(timeline, "read", timeline::Work::parallel);
    read_block(path, file, *block);
    return block;
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(
        static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 2,
        tbb::make_filter<void, BlockPointer>(Mode::serial_in_order, next_block) &
            tbb::make_filter<BlockPointer, BlockPointer>(Mode::parallel, read) &
            tbb::make_filter<BlockPointer, void>(Mode::serial_in_order, [&](const BlockPointer& block) {
              hash.add(block->bytes);
              hashed += block->bytes.size();
            }));
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(pipeline);
  // A run that ends with an exception cancels the pipeline, which then returns early.
  if (hashed != length) fail_with(path, "read", ECANCELED);
  return hash.digest();
}

hash::Sha256 sha256_of(const std::filesystem::path& path, const FileDescriptor& file, std::size_t length) {
  hash::Sha256Hash hash;
  std::vector<std::byte> block(block_size);
  while (length > 0) {
    const std::size_t size = read_some(path, file, std::span(block).first(std::min(block.size(), length)));
    if (size == 0) fail_with(path, "read", EIO);
    hash.add(std::span(block).first(size));
    length -= size;
  }
  return hash.digest();
}

}  // namespace zerocount::storage
