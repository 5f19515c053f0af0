#include <cstddef>
#include <map>
#include <optional>
#include <string>
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

bool is_dataset(const WrittenObject& written) {
  return written.is_scale || !written.scales.empty() || !written.rows.empty() || !written.chunks.empty() ||
         !written.texts.empty();
}

}  // namespace

/// A file that is compared with what was written to it. The library only finds the chunks; all of them are
/// read at the end.
class ReadBack {
 public:
  explicit ReadBack(File&& file) : file_(std::move(file)) {}

  void compare(const std::string& path, const WrittenObject& written) {
    if (path == "/") {
      compare_attributes(file_, written);
    } else if (!is_dataset(written) && file_.is_group(path.substr(1))) {
      compare_attributes(file_.open_group(path.substr(1)), written);
    } else {
      compare_dataset(path, written);
    }
  }

  void compare_chunks(timeline::Timeline* timeline) {
    for_each_job(jobs_.size(), timeline, "compare", [&](std::size_t index) {
      Job& job = jobs_[index];
      const std::vector<std::byte> stored = job.dataset->bytes_of(std::move(job.found));
      job.digest = digest_of(stored.data(), stored.size());
    });
    for (const Job& job : jobs_) {
      if (job.digest != job.written.digest)
        job.dataset->fail(fmt::format("the rows from {} on differ", job.written.first));
    }
  }

 private:
  struct Opened {
    Dataset dataset;
    std::optional<Dataset::ScaleUses> uses{};  ///< of a scale, once they are read
  };
  /// A chunk to compare.
  struct Job {
    const Dataset* dataset;
    StoredChunk found;
    WrittenChunk written;
    std::size_t digest;
  };

  Opened& open(const std::string& path) {
    const auto found = opened_.find(path);
    if (found != opened_.end()) return found->second;
    return opened_.emplace(path, Opened{file_.open_dataset(path.substr(1))}).first->second;
  }

  void compare_dataset(const std::string& path, const WrittenObject& written) {
    const Dataset& dataset = open(path).dataset;
    compare_attributes(dataset, written);
    compare_rows(dataset, written.rows);
    if (!written.texts.empty() && dataset.read_texts() != written.texts) dataset.fail("its texts differ");
    compare_scales(dataset, written);
    for (const WrittenChunk& chunk : written.chunks)
      jobs_.push_back({&dataset, dataset.find_chunk(chunk.first), chunk, {}});
  }

  void compare_scales(const Dataset& dataset, const WrittenObject& written) {
    if (written.is_scale && !dataset.is_scale()) dataset.fail("it is not an axis any more");
    for (const auto& [dimension, path] : written.scales) {
      Opened& scale = open(path);
      if (!scale.uses) scale.uses = scale.dataset.uses_as_scale();
      if (!dataset.has_scale(scale.dataset, *scale.uses, dimension))
        dataset.fail(fmt::format("its axis {} is missing", path));
    }
  }

  File file_;
  std::map<std::string, Opened> opened_;  ///< by path
  std::vector<Job> jobs_;
};

void require_written(const std::filesystem::path& path, const WrittenValues& written,
                     timeline::Timeline* timeline) {
  auto origin = std::make_shared<Origin>();
  origin->purpose = Purpose::read_back;
  origin->bytes = std::make_shared<storage::ByteFile>(path, storage::ByteFile::Mode::read);
  ReadBack file(File::open(std::move(origin), false));
  for (const auto& [name, object] : written) file.compare(name, object);
  file.compare_chunks(timeline);
}

}  // namespace zerocount::hdf5
