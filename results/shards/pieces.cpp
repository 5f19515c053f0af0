#include "results/shards/pieces.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::shards {
namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> number_of(std::string_view digits) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

void append_shards(std::vector<fs::path>& pieces, const fs::path& output) {
  const fs::path directory = layout::shards_directory(output);
  if (!is_folder(directory)) return;
  try {
    std::vector<fs::path> shards = shard_files(directory);
    pieces.insert(pieces.end(), std::make_move_iterator(shards.begin()),
                  std::make_move_iterator(shards.end()));
  } catch (const Failure&) {
    if (is_folder(directory)) throw;  // otherwise its shards were joined in the meantime
  }
}

}  // namespace

std::vector<Part> begun_parts(const fs::path& output) {
  const fs::path directory = parts_directory(output);
  const auto before = [](const Part& one, const Part& other) {
    return std::pair(one.number, one.count) < std::pair(other.number, other.count);
  };
  std::set<Part, decltype(before)> parts(before);
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    if (const std::optional<Part> part = part_named(entry->path())) parts.insert(*part);
  }
  if (error) storage::fail_with(directory, "read the directory", error.value());
  return {parts.begin(), parts.end()};
}

fs::path parts_directory(const fs::path& output) {
  fs::path directory = output;
  return directory += ".parts";
}

std::optional<Part> part_named(const fs::path& path) {
  constexpr std::string_view begin = "part-", middle = "-of-", end = ".h5";
  const fs::path file = path.extension() == ".shards" ? fs::path(path).replace_extension() : path;
  const std::string name = file.filename().string();
  const std::size_t of = name.find(middle);
  if (!name.starts_with(begin) || !name.ends_with(end) || of == std::string::npos) return std::nullopt;
  const std::string_view all = name;
  const std::size_t count_at = of + middle.size();
  const auto number = number_of(all.substr(begin.size(), of - begin.size()));
  const auto count = number_of(all.substr(count_at, all.size() - count_at - end.size()));
  if (!number || !count || *number < 1 || *number > *count) return std::nullopt;
  return Part{file, *number, *count};
}

std::vector<fs::path> finished_pieces(const fs::path& output) {
  std::vector<fs::path> pieces;
  append_shards(pieces, output);
  if (!is_folder(parts_directory(output))) return pieces;
  for (const Part& part : begun_parts(output)) {
    if (is_file(part.path)) {
      pieces.push_back(part.path);
    } else {
      append_shards(pieces, part.path);
    }
  }
  return pieces;
}

bool has_begun(const fs::path& output) {
  return is_folder(layout::shards_directory(output)) || is_folder(parts_directory(output));
}

}  // namespace zerocount::shards
