#include <cstddef>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

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
  std::vector<std::byte> bytes;
  for (const WrittenRows& rows : written) {
    bytes.resize(static_cast<std::size_t>(rows.rows) * width);
    dataset.read(rows.first, rows.rows, bytes.data());
    if (digest_of(bytes.data(), bytes.size()) != rows.digest) {
      dataset.fail(fmt::format("rows {} to {} differ", rows.first, rows.first + rows.rows - 1));
    }
  }
}

void compare_scales(const Group& root, const Dataset& dataset, const WrittenObject& written) {
  if (written.is_scale && !dataset.is_scale()) dataset.fail("it is not an axis any more");
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

/// The chunks that were written, in all datasets. The library only finds them.
class ChunkComparison {
 public:
  void add(Dataset&& dataset, std::span<const WrittenChunk> written) {
    for (const WrittenChunk& chunk : written)
      jobs_.push_back({datasets_.size(), dataset.find_chunk(chunk.first), chunk, {}});
    datasets_.push_back(std::move(dataset));
  }

  void require_equal(timeline::Timeline* timeline) {
    for_each_job(jobs_.size(), timeline, "compare", [&](std::size_t index) {
      Job& job = jobs_[index];
      const std::vector<std::byte> stored = datasets_[job.dataset].bytes_of(std::move(job.found));
      job.digest = digest_of(stored.data(), stored.size());
    });
    for (const Job& job : jobs_) {
      if (job.digest != job.written.digest)
        datasets_[job.dataset].fail(fmt::format("the rows from {} on differ", job.written.first));
    }
  }

 private:
  struct Job {
    std::size_t dataset;  ///< index
    StoredChunk found;
    WrittenChunk written;
    std::size_t digest;
  };

  std::vector<Dataset> datasets_;
  std::vector<Job> jobs_;
};

void require_written(const std::filesystem::path& path, const WrittenValues& written,
                     timeline::Timeline* timeline) {
  auto origin = std::make_shared<Origin>();
  origin->purpose = Purpose::read_back;
  origin->bytes = std::make_shared<storage::ByteFile>(path, storage::ByteFile::Mode::read);
  const File file = File::open(std::move(origin), false);
  ChunkComparison chunks;
  for (const auto& [name, object] : written) {
    if (name == "/") {
      compare_attributes(file, object);
    } else if (file.is_group(name.substr(1))) {
      compare_attributes(file.open_group(name.substr(1)), object);
    } else {
      Dataset dataset = file.open_dataset(name.substr(1));
      compare_dataset(file, dataset, object);
      chunks.add(std::move(dataset), object.chunks);
    }
  }
  chunks.require_equal(timeline);
}

}  // namespace zerocount::hdf5
