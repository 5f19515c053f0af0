#include <algorithm>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "results/hdf5/chunk_transfer.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

constexpr std::size_t chunks_at_once = 64;  ///< what many tasks need; at most 8 MB

AttributeValue read_attribute(const Object& object, const std::string& name, const AttributeValue& like) {
  if (std::holds_alternative<std::string>(like)) return object.text(name);
  if (std::holds_alternative<std::uint64_t>(like)) return object.unsigned_integer(name);
  return object.integers(name);
}

void compare_attributes(const Object& object, const WrittenObject& written) {
  for (const auto& [name, value] : written.attributes) {
    if (read_attribute(object, name, value) != value)
      object.fail(fmt::format("the attribute '{}' differs", name));
  }
}

void compare_rows(const Dataset& dataset, const std::vector<WrittenRows>& written) {
  if (written.empty()) return;
  const std::size_t width = row_size(dataset.element(), dataset.extent());
  for (std::size_t first = 0; first < written.size(); first += chunks_at_once) {
    const auto part = std::span(written).subspan(first, std::min(chunks_at_once, written.size() - first));
    std::vector<std::vector<std::byte>> bytes;
    std::vector<RowsToRead> all;
    for (const WrittenRows& rows : part) {
      bytes.emplace_back(static_cast<std::size_t>(rows.rows) * width);
      all.push_back({&dataset, rows.first, rows.rows, bytes.back().data()});
    }
    read_rows(all);
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (digest_of(bytes[i].data(), bytes[i].size()) == part[i].digest) continue;
      dataset.fail(fmt::format("rows {} to {} differ", part[i].first, part[i].first + part[i].rows - 1));
    }
  }
}

void compare_scales(const Group& root, const Dataset& dataset, const WrittenObject& written) {
  if (written.is_scale && !dataset.is_scale()) dataset.fail("it is no axis any more");
  for (const auto& [dimension, path] : written.scales) {
    if (!dataset.has_scale(root.open_dataset(path.substr(1)), dimension)) {
      dataset.fail(fmt::format("its axis {} is missing", path));
    }
  }
}

void compare_dataset(const Group& root, const Dataset& dataset, const WrittenObject& written) {
  compare_attributes(dataset, written);
  compare_rows(dataset, written.rows);
  if (!written.texts.empty() && dataset.read_texts() != written.texts) dataset.fail("its texts differ");
  compare_scales(root, dataset, written);
}

}  // namespace

void require_written(const std::filesystem::path& path, const WrittenValues& written) {
  auto origin = std::make_shared<Origin>();
  origin->purpose = Purpose::read_back;
  origin->bytes = std::make_shared<storage::ByteFile>(path, storage::ByteFile::Mode::read);
  const File file = File::open(std::move(origin), false);
  for (const auto& [name, object] : written) {
    if (name == "/") {
      compare_attributes(file, object);
    } else if (file.is_group(name.substr(1))) {
      compare_attributes(file.open_group(name.substr(1)), object);
    } else {
      compare_dataset(file, file.open_dataset(name.substr(1)), object);
    }
  }
}

}  // namespace zerocount::hdf5
