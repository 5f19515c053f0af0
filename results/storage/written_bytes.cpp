#include "results/storage/written_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::storage {
namespace {

std::size_t hash_of(std::span<const std::byte> bytes) {
  return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

void WrittenBytes::add(std::uint64_t offset, std::span<const std::byte> bytes, Rewritten rewritten) {
  clear(offset, offset + bytes.size());
  Piece piece{bytes.size(), hash_of(bytes)};
  if (rewritten == Rewritten::in_part) piece.bytes.assign(bytes.begin(), bytes.end());
  if (!bytes.empty()) pieces_.emplace(offset, std::move(piece));
}

void WrittenBytes::cut(std::uint64_t size) {
  clear(size, std::numeric_limits<std::uint64_t>::max());
}

WrittenBytes WrittenBytes::hashed() const {
  WrittenBytes hashed = *this;
  std::erase_if(hashed.pieces_, [](const auto& piece) { return !piece.second.bytes.empty(); });
  return hashed;
}

/// Forgets the bytes from `first` to `end`. A piece of which only the hash is known is forgotten as a whole.
void WrittenBytes::clear(std::uint64_t first, std::uint64_t end) {
  auto next = pieces_.lower_bound(first);
  if (next != pieces_.begin() && std::prev(next)->first + std::prev(next)->second.size > first) --next;
  while (next != pieces_.end() && next->first < end) {
    const std::uint64_t offset = next->first;
    const std::vector<std::byte> bytes = std::move(next->second.bytes);
    next = pieces_.erase(next);
    const std::span<const std::byte> old(bytes);
    const auto add_again = [&](std::uint64_t at, std::span<const std::byte> rest) {
      pieces_.emplace(at, Piece{rest.size(), hash_of(rest), {rest.begin(), rest.end()}});
    };
    if (!old.empty() && offset < first) add_again(offset, old.first(first - offset));
    if (offset + old.size() > end) add_again(end, old.subspan(end - offset));
  }
}

hash::Sha256 WrittenBytes::require_in(const std::filesystem::path& path, timeline::Timeline* timeline) const {
  namespace tbb = oneapi::tbb;
  using Mode = tbb::filter_mode;
  struct Block {
    std::uint64_t offset;
    std::vector<std::byte> bytes;
    const Piece* written;  ///< The bytes that were written to this range; null: nothing was written there
  };
  using BlockPointer = std::shared_ptr<Block>;
  constexpr std::uint64_t max_gap = 1 << 18;

  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) fail_with(path, "read", errno);
  const std::uint64_t length = size_of_file(path, file);
  if (!pieces_.empty() && pieces_.rbegin()->first + pieces_.rbegin()->second.size > length)
    fail_read_back(path, "its end is missing");

  hash::Sha256Hash hash;
  std::uint64_t hashed = 0;
  std::uint64_t at = 0;
  auto piece = pieces_.begin();
  const auto next_block = [&](tbb::flow_control& control) -> BlockPointer {
    if (at == length) {
      control.stop();
      return nullptr;
    }
    const Piece* const written = piece != pieces_.end() && piece->first == at ? &piece->second : nullptr;
    const std::uint64_t next_piece = piece != pieces_.end() ? piece->first : length;
    const std::uint64_t size = written != nullptr ? written->size : std::min(next_piece - at, max_gap);
    if (written != nullptr) ++piece;
    auto block = std::make_shared<Block>(Block{at, std::vector<std::byte>(size), written});
    at += size;
    return block;
  };
  const auto read = [&](const BlockPointer& block) {
    const timeline::TimeSpan span(timeline, "read", timeline::Work::parallel);
    read_at(path, file, block->offset, block->bytes);
    if (block->written != nullptr && hash_of(block->bytes) != block->written->hash)
      fail_read_back(
          path, fmt::format("bytes {} to {} differ", block->offset, block->offset + block->bytes.size() - 1));
    return block;
  };
  const auto add = [&](const BlockPointer& block) {
    hash.add(block->bytes);
    hashed += block->bytes.size();
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_pipeline(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 2,
                           tbb::make_filter<void, BlockPointer>(Mode::serial_in_order, next_block) &
                               tbb::make_filter<BlockPointer, BlockPointer>(Mode::parallel, read) &
                               tbb::make_filter<BlockPointer, void>(Mode::serial_in_order, add));
  });
  // A run that ends with an exception cancels the pipeline, which then returns early.
  if (hashed != length) fail_with(path, "read", ECANCELED);
  return hash.digest();
}

}  // namespace zerocount::storage
