// Chunks whose filters we apply are those of the HDF5 library: it reads ours, and we read its.

#include <oneapi/tbb/global_control.h>

#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/hdf5.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// A random dataset of one of the kinds that results files have, with its contents.
struct Sample {
  hdf5::Storage storage;
  std::string elements;

  std::int64_t rows() const { return static_cast<std::int64_t>(storage.extent[0]); }
  std::size_t row_size() const { return elements.size() / storage.extent[0]; }
};

/// Bytes of one of the kinds that deflate treats differently: random, the same, counting up, or few values.
std::string random_bytes(Draws& draws, std::size_t size) {
  const auto kind = static_cast<int>(draws.uniform(0.0, 4.0));
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i) {
    const double value = kind == 0   ? draws.uniform(0.0, 256.0)
                         : kind == 1 ? 7.0
                         : kind == 2 ? static_cast<double>(i / 8 % 256)
                                     : draws.uniform(0.0, 3.0);
    bytes[i] = static_cast<char>(static_cast<unsigned char>(value));
  }
  return bytes;
}

Sample random_sample(Draws& draws) {
  using hdf5::Element;
  constexpr Element elements[] = {Element::float64, Element::int64, Element::int32, Element::int8,
                                  Element::flag};
  Sample sample;
  sample.storage.element = elements[static_cast<std::size_t>(draws.uniform(0.0, 5.0))];
  const auto rows = static_cast<hdf5::Size>(draws.log_uniform(1.0, 30000.0));
  sample.storage.extent = {rows};
  sample.storage.chunk = {std::min(
      rows, static_cast<hdf5::Size>(draws.log_uniform(1.0, 20000.0)) + rows / 50)};  // at most 50 chunks
  if (draws.chance(0.5)) {
    const auto width = static_cast<hdf5::Size>(draws.uniform(1.0, 6.0));
    sample.storage.extent.push_back(width);
    sample.storage.chunk.push_back(draws.chance(0.8) ? width : (width + 1) / 2);
  }
  if (draws.chance(0.3)) sample.storage.compression = hdf5::Compression::none;
  const hdf5::Size width = sample.storage.extent.size() > 1 ? sample.storage.extent[1] : 1;
  sample.elements = random_bytes(draws, rows * width * hdf5::size_of(sample.storage.element));
  return sample;
}

/// Calls `piece` for consecutive ranges of the sample's rows, of random sizes.
void in_pieces(Draws& draws, const Sample& sample,
               const std::function<void(std::int64_t, std::int64_t)>& piece) {
  for (std::int64_t first = 0; first < sample.rows();) {
    const auto wanted =
        static_cast<std::int64_t>(draws.uniform(1.0, static_cast<double>(sample.rows()) + 1.0));
    const std::int64_t rows = std::min(wanted, sample.rows() - first);
    piece(first, rows);
    first += rows;
  }
}

/// Writes a file with the sample as the dataset `value`. `threads` threads write it as a whole, so in whole
/// chunks.
void write_whole(const fs::path& path, const Sample& sample, std::size_t threads) {
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  hdf5::File file = hdf5::File::create(path);
  file.create_dataset("value", sample.storage).write(0, sample.rows(), sample.elements.data());
  file.close().require_in(path);
}

/// Writes the sample in pieces that divide chunks, so that the HDF5 library encodes the chunks.
void write_pieces(const fs::path& path, const Sample& sample, Draws& draws) {
  hdf5::File file = hdf5::File::create(path);
  {
    hdf5::Dataset value = file.create_dataset("value", sample.storage);
    in_pieces(draws, sample, [&](std::int64_t first, std::int64_t rows) {
      value.write(first, rows, &sample.elements[static_cast<std::size_t>(first) * sample.row_size()]);
    });
  }
  file.close().require_in(path);
}

std::string read(const fs::path& path, const Sample& sample, std::int64_t first, std::int64_t rows) {
  const hdf5::File file = hdf5::File::open_to_read(path);
  std::string elements(static_cast<std::size_t>(rows) * sample.row_size(), '\0');
  file.open_dataset("value").read(first, rows, elements.data());
  return elements;
}

void copy(const fs::path& from, const fs::path& to, const Sample& sample) {
  const hdf5::File source = hdf5::File::open_to_read(from);
  const hdf5::Dataset from_value = source.open_dataset("value");
  hdf5::File target = hdf5::File::create(to);
  {
    hdf5::Dataset value = target.create_dataset("value", sample.storage);
    const hdf5::FetchedRows fetched = from_value.fetch(0, sample.rows());
    if (fetched.chunks.empty()) {  // a chunk has a part of the rows' width
      EXPECT_NE(sample.storage.chunk.back(), sample.storage.extent.back());
      return value.write(0, sample.rows(), sample.elements.data());
    }
    value.write(0, hdf5::stored_rows({&fetched, 1}).front());
  }
  target.close().require_in(to);
}

TEST(ChunkTransfer, InteroperatesWithTheHdf5LibraryBothWays) {
  const TemporaryFolder folder;
  Draws draws(20260101);
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    const Sample sample = random_sample(draws);
    write_whole(folder / "whole.h5", sample, 2);
    write_pieces(folder / "pieces.h5", sample, draws);
    ASSERT_EQ(elements_of(folder / "whole.h5", "value"), sample.elements);
    ASSERT_EQ(elements_of(folder / "pieces.h5", "value"), sample.elements);
    for (const char* name : {"whole.h5", "pieces.h5"}) {
      ASSERT_EQ(read(folder / name, sample, 0, sample.rows()), sample.elements) << name;
      in_pieces(draws, sample, [&](std::int64_t first, std::int64_t rows) {
        ASSERT_EQ(read(folder / name, sample, first, rows),
                  sample.elements.substr(static_cast<std::size_t>(first) * sample.row_size(),
                                         static_cast<std::size_t>(rows) * sample.row_size()))
            << name;
      });
    }
    copy(folder / "pieces.h5", folder / "copy.h5", sample);
    ASSERT_EQ(elements_of(folder / "copy.h5", "value"), sample.elements);
  }
}

TEST(ChunkTransfer, StoresTheSameBytesWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  Draws draws(20260102);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Sample sample = random_sample(draws);
    write_whole(folder / "one.h5", sample, 1);
    write_whole(folder / "two.h5", sample, 2);
    expect_same_datasets(folder / "one.h5", folder / "two.h5");
  }
}

/// Writes the sample's rows as chunks that were encoded before the dataset existed.
void write_encoded(const fs::path& path, const Sample& sample, const hdf5::ChunkShape& shape) {
  const hdf5::RowsToEncode rows{shape, sample.rows(), sample.elements.data()};
  const std::vector<hdf5::EncodedRows> encoded = hdf5::encode_rows({&rows, 1});
  hdf5::File file = hdf5::File::create(path);
  file.create_dataset("value", sample.storage).write(0, encoded.front());
  file.close().require_in(path);
}

TEST(EncodedRows, AreStoredAsTheDatasetWouldEncodeThem) {
  const TemporaryFolder folder;
  Draws draws(20260105);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Sample sample = random_sample(draws);
    const std::optional<hdf5::ChunkShape> shape = hdf5::chunk_shape_of(sample.storage);
    write_whole(folder / "whole.h5", sample, 2);
    ASSERT_EQ(shape, hdf5::File::open_to_read(folder / "whole.h5").open_dataset("value").chunk_shape());
    if (!shape) continue;  // a chunk has a part of the rows' width
    write_encoded(folder / "encoded.h5", sample, *shape);
    EXPECT_EQ(read_bytes(folder / "encoded.h5"), read_bytes(folder / "whole.h5"));
  }
}

TEST(EncodedRows, AreRefusedByAnotherDataset) {
  const TemporaryFolder folder;
  const hdf5::Storage storage{hdf5::Element::float64, {100}, {50}};
  const std::vector<double> values(100, 1.5);
  const hdf5::RowsToEncode rows{*hdf5::chunk_shape_of(storage), 100, values.data()};
  const hdf5::EncodedRows encoded = hdf5::encode_rows({&rows, 1}).front();
  hdf5::File file = hdf5::File::create(folder / "file.h5");
  hdf5::Dataset other = file.create_dataset("other", {hdf5::Element::float64, {100}, {20}});
  EXPECT_THROW(other.write(0, encoded), std::logic_error);
  hdf5::Dataset longer = file.create_dataset("longer", {hdf5::Element::float64, {150}, {50}});
  EXPECT_THROW(longer.write(25, encoded), std::logic_error);
  longer.write(50, encoded);
}

TEST(FetchedRows, DecodeToTheRowsThatTheDatasetReads) {
  const TemporaryFolder folder;
  Draws draws(20260106);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Sample sample = random_sample(draws);
    write_whole(folder / "file.h5", sample, 2);
    const hdf5::File file = hdf5::File::open_to_read(folder / "file.h5");
    const hdf5::Dataset value = file.open_dataset("value");
    std::vector<hdf5::FetchedRows> fetched;
    in_pieces(draws, sample,
              [&](std::int64_t first, std::int64_t rows) { fetched.push_back(value.fetch(first, rows)); });
    std::string elements;
    for (const std::vector<std::byte>& piece : hdf5::decode_rows(fetched))
      elements.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    ASSERT_EQ(elements, sample.elements);
  }
}

/// Without compression the stored bytes are the elements and their checksum: every implementation must give
/// the same.
TEST(ChunkTransfer, HasTheLibrarysChecksum) {
  const TemporaryFolder folder;
  Draws draws(20260103);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Sample sample = random_sample(draws);
    sample.storage.compression = hdf5::Compression::none;
    write_whole(folder / "whole.h5", sample, 2);
    write_pieces(folder / "pieces.h5", sample, draws);
    expect_same_datasets(folder / "whole.h5", folder / "pieces.h5");
  }
}

TEST(ChunkTransfer, RefusesADamagedChunk) {
  const TemporaryFolder folder;
  Draws draws(20260104);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Sample sample = random_sample(draws);
    sample.storage.chunk.back() = sample.storage.extent.size() > 1 ? sample.storage.extent[1] : sample.rows();
    const fs::path path = folder / "file.h5";
    write_whole(path, sample, 2);
    std::string bytes = read_bytes(path);
    char& byte = bytes[chunk_address(path, "value") + static_cast<std::size_t>(draws.uniform(0.0, 4.0))];
    byte = static_cast<char>(byte ^ (1 << static_cast<int>(draws.uniform(0.0, 8.0))));
    write_bytes(path, bytes);
    EXPECT_EQ(elements_of(path, "value"), std::nullopt);
    expect_failure(ExitCode::bad_data, "/value: its values cannot be read or their checksum is wrong",
                   [&] { read(path, sample, 0, sample.rows()); });
    expect_failure(ExitCode::bad_data, "/value: its values cannot be read or their checksum is wrong",
                   [&] { copy(path, folder / "copy.h5", sample); });
    expect_failure(ExitCode::bad_data, "/value: its values cannot be read or their checksum is wrong", [&] {
      const hdf5::File file = hdf5::File::open_to_read(path);
      const hdf5::Dataset value = file.open_dataset("value");
      const hdf5::FetchedRows fetched = value.fetch(0, sample.rows());
      hdf5::decode_rows({&fetched, 1});
    });
  }
}

}  // namespace
}  // namespace zerocount::testing
