#include "results/reading/shard_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"

// A head is written as these fields, by their names.
namespace zerocount::layout {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Provenance, zerocount_version, git_commit, compiler, cpu, created)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RowRange, first, count)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FileHeader, retention, name, provenance, engine, seed, trials, points,
                                   rows, manifest, overrides, manifest_sha256, study_sha256)

}  // namespace zerocount::layout

namespace zerocount::reading {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ShardHead::Column, path, rows, chunks)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ShardHead, header, compression, columns)

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::string_view signature = "zerocount-shard ";

[[noreturn]] void fail_at(const fs::path& path, std::string_view place, std::string_view problem) {
  throw Failure(ExitCode::bad_data,
                text::printable_lines(fmt::format("{}: damaged: {}{}{}", path.string(), place,
                                                  place.empty() ? "" : ": ", problem)));
}

/// One column of a shard, as a source of stored rows.
class ShardColumn final : public hdf5::RowSource {
 public:
  ShardColumn(fs::path path, std::shared_ptr<const storage::FileDescriptor> file,
              const ShardHead::Column& column, std::uint64_t begin, hdf5::Element element,
              const hdf5::ChunkShape& shape)
      : path_(std::move(path)),
        file_(std::move(file)),
        name_(column.path),
        rows_(column.rows),
        element_(element),
        shape_(shape) {
    for (const std::uint64_t size : column.chunks)
      chunks_.push_back({std::exchange(begin, begin + size), size});
    if (std::ssize(chunks_) != (rows_ + shape.rows - 1) / shape.rows)
      fail("its chunks are not those of its rows");
  }

  hdf5::Element element() const override { return element_; }

  hdf5::FetchedRows fetch(std::int64_t first, std::int64_t rows) const override {
    if (first < 0 || rows < 0 || first + rows > rows_)
      fail(fmt::format("it has {} rows; rows {} to {} were expected", rows_, first, first + rows));
    hdf5::FetchedRows fetched{this, first, rows, shape_.row_size, shape_, {}, {}};
    if (rows == 0) return fetched;
    const auto begin = chunks_.begin() + first / shape_.rows;
    fetched.chunks.assign(begin, chunks_.begin() + (first + rows - 1) / shape_.rows + 1);
    return fetched;
  }

  std::vector<std::byte> bytes_of(hdf5::StoredChunk&& chunk) const override {
    std::vector<std::byte> bytes(chunk.size);
    storage::read_at(path_, *file_, chunk.address, bytes);
    return bytes;
  }

 private:
  void fail_with(std::string_view problem) const override { fail_at(path_, "/" + name_, problem); }

  fs::path path_;
  std::shared_ptr<const storage::FileDescriptor> file_;
  std::string name_;
  std::int64_t rows_;
  hdf5::Element element_;
  hdf5::ChunkShape shape_;
  std::vector<hdf5::StoredChunk> chunks_;
};

/// MessagePack parser that detects nesting deeper than in a shard's head, before anything recurses through
/// the data.
class DepthLimit final : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(Json::binary_t&) override { return true; }
  bool key(std::string&) override { return true; }
  bool start_object(std::size_t) override { return ++depth_ <= most; }
  bool start_array(std::size_t) override { return ++depth_ <= most; }
  bool end_object() override { return --depth_ >= 0; }
  bool end_array() override { return --depth_ >= 0; }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  static constexpr int most = 8;
  int depth_{0};
};

bool has_known_words(const ShardHead& head) {
  const auto is_known = [](auto word, auto last) {
    return static_cast<int>(word) >= 0 && static_cast<int>(word) <= static_cast<int>(last);
  };
  return is_known(head.header.retention, study::Retention::statistics) &&
         is_known(head.header.engine, study::Engine::reference) &&
         is_known(head.compression, hdf5::Compression::none);
}

bool has_possible_rows(const ShardHead& head) {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  return std::ranges::all_of(head.columns,
                             [](const auto& column) { return column.rows >= 0 && column.rows <= most; });
}

/// Reads the head of a shard.
/// @returns the head, and the position of the first chunk in the file.
std::pair<ShardHead, std::uint64_t> read_head(const fs::path& path, const storage::FileDescriptor& file) {
  constexpr std::size_t max_line = 64;
  const std::size_t size = storage::size_of_file(path, file);
  std::string line(std::min(size, max_line), '\0');
  storage::read_at(path, file, 0, std::as_writable_bytes(std::span(line)));
  std::int64_t version = 0;
  std::size_t length = 0;
  const char* const end = line.data() + line.size();
  const auto after_version =
      std::from_chars(line.data() + std::min(signature.size(), line.size()), end, version);
  const std::size_t begin = line.find('\n') + 1;
  if (begin > 0 && after_version.ptr != end) std::from_chars(after_version.ptr + 1, end, length);
  if (begin > 0 && version != layout::format_version)
    throw layout::ForeignFile(path,
                              fmt::format("a shard in format version {}, and this program reads version "
                                          "{}: the zerocount that began the run can finish it",
                                          version, layout::format_version));
  if (length == 0 || begin == 0 || length > size - begin) fail_at(path, "", "its head is cut short");
  std::string bytes(length, '\0');
  storage::read_at(path, file, begin, std::as_writable_bytes(std::span(bytes)));
  DepthLimit limit;
  if (!Json::sax_parse(bytes, &limit, Json::input_format_t::msgpack))
    fail_at(path, "", "its head cannot be read");
  ShardHead head;
  try {
    const Json json = Json::from_msgpack(bytes);
    head = json.get<ShardHead>();
    if (json.contains("plugin"))
      head.header.plugin = layout::plugin_from_json(json["plugin"].get<std::string>());
    if (json.contains("plugin") && !head.header.plugin) fail_at(path, "", "its plugin cannot be read");
    if (json.contains("samples")) head.header.samples = json["samples"].get<std::string>();
  } catch (const Json::exception&) {
    fail_at(path, "", "its head cannot be read");
  }
  head.header.kind = layout::FileKind::shard;
  head.header.finished = true;
  if (!layout::has_possible_numbers(head.header) || !has_known_words(head) || !has_possible_rows(head))
    fail_at(path, "", "its head has impossible numbers");
  return {std::move(head), begin + length};
}

}  // namespace

std::string bytes_of(const ShardHead& head) {
  Json json = head;
  if (head.header.plugin) json["plugin"] = layout::plugin_as_json(*head.header.plugin);
  if (head.header.samples) json["samples"] = *head.header.samples;
  const std::vector<std::uint8_t> bytes = Json::to_msgpack(json);
  return fmt::format("{}{} {}\n{}", signature, layout::format_version, bytes.size(),
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

bool is_shard(const fs::path& path) {
  return storage::bytes_at(path, 0, signature.size()) == signature;
}

ShardFile::ShardFile(const fs::path& path, layout::Checksum checksum)
    : path_(path),
      file_(std::make_shared<const storage::FileDescriptor>(::open(path.c_str(), O_RDONLY | O_CLOEXEC))) {
  if (!file_->valid()) storage::fail_with(path, "read", errno);
  if (checksum == layout::Checksum::required) storage::require_valid_checksum(path);
  auto [head, begin] = read_head(path, *file_);
  head_ = std::move(head);
  const std::uint64_t size = storage::size_of_file(path, *file_);
  begins_.push_back(begin);
  for (const ShardHead::Column& column : head_.columns) {
    std::uint64_t end = begins_.back();
    for (const std::uint64_t chunk : column.chunks) {
      if (chunk > size - end) fail("its end is missing");
      end += chunk;
    }
    begins_.push_back(end);
  }
}

void ShardFile::fail(const std::string& problem) const {
  fail_at(path_, "", problem);
}

const ShardHead::Column* ShardFile::find(const std::string& path) const {
  const auto found = std::ranges::find(head_.columns, path, &ShardHead::Column::path);
  return found == head_.columns.end() ? nullptr : &*found;
}

layout::TableReader::Column ShardFile::column(const layout::Table& table, const layout::Column& column,
                                              std::int64_t second) const {
  const ShardHead::Column* const found = find(table.group + "/" + column.name);
  if (found == nullptr || found->rows < 0)
    fail(fmt::format("the column '{}/{}' is missing", table.group, column.name));
  const bool is_scale = column.name == table.rows.name;
  const bool of_sums = table.group == layout::sums_table().group;  // always compressed
  const hdf5::Storage storage =
      is_scale ? layout::scale_storage(column, found->rows)
               : layout::column_storage(table, column, found->rows, second,
                                        of_sums ? hdf5::Compression::deflate : head_.compression);
  return std::make_shared<const ShardColumn>(path_, file_, *found,
                                             begins_[static_cast<std::size_t>(found - head_.columns.data())],
                                             column.element, hdf5::chunk_shape_of(storage).value());
}

layout::TableReader ShardFile::open(const layout::Table& table, std::int64_t second) const {
  const layout::Provenance& writer = head_.header.provenance;
  if (!layout::same_build(writer, layout::current_provenance()))
    throw layout::ForeignFile(path_, fmt::format("a shard of zerocount {} (commit {}), which alone reads its "
                                                 "trials and finishes the run",
                                                 writer.zerocount_version, writer.git_commit));
  std::vector<layout::TableReader::Column> columns;
  std::int64_t rows = 0;
  for (const layout::Column& one : table.columns) {
    columns.push_back(column(table, one, second));
    const std::int64_t own = find(table.group + "/" + one.name)->rows;
    if (columns.size() > 1 && own != rows)
      fail(fmt::format("the columns of '{}' differ in size", table.group));
    rows = own;
  }
  const bool has_scale = find(table.group + "/" + table.rows.name) != nullptr;
  layout::TableReader::Column scale = has_scale ? column(table, table.rows, 1) : columns.front();
  const std::int64_t width = (table.second ? second : 1) * (table.last ? std::ssize(table.last->values) : 1);
  return {rows, width, std::move(scale), std::move(columns)};
}

}  // namespace zerocount::reading
