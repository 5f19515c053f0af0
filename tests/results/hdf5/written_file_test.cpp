// What was written is there, or it is said that it is not.
#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/hdf5/library_use.hpp"
#include "results/layout/table_io.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t rows = 40000;  // three chunks

layout::Table numbers_table() {
  return {"numbers",
          {"row", "1", "row", hdf5::Element::int64, {}, ""},
          std::nullopt,
          {{"value", "m", "a value", hdf5::Element::int64, {}, ""}}};
}

/// Writes one example of everything that results files can contain.
void fill(hdf5::File& file) {
  file.set_text("name", "µ");
  file.set_integer("number", -3);
  file.set_unsigned("seed", UINT64_MAX);
  hdf5::Dataset labels = file.create_dataset("labels", {hdf5::Element::text, {2}, {2}});
  labels.write_texts(std::vector<std::string>{"one", "two"});
  layout::TableIo table = layout::TableIo::create(file, numbers_table(), rows, 1);
  table.number_rows(0);
  std::vector<std::int64_t> values(rows);
  std::iota(values.begin(), values.end(), 1000);
  for (std::int64_t first = 0; first < rows; first += 10000)
    table.column(0).write(first, 10000, &values[static_cast<std::size_t>(first)]);
  layout::TableIo::create(
      file, {"nothing", {"row", "1", "row", hdf5::Element::int64, {}, ""}, std::nullopt, {}}, 0, 1);
}

storage::WrittenBytes write_file(const fs::path& path) {
  hdf5::File file = hdf5::File::create(path);
  fill(file);
  return file.close();
}

TEST(WrittenFile, IsVerifiedAfterWritingAndAppending) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  storage::WrittenBytes before = write_file(path);
  before.require_in(path);
  hdf5::File file = hdf5::File::open_to_change(path, before);
  file.set_integer("finished", 1);
  file.open_dataset("numbers/value").write(0, 1, std::vector<std::int64_t>{7}.data());
  const storage::WrittenBytes written = file.close();
  EXPECT_EQ(hash::hexadecimal(written.require_in(path)), hash::sha256_hex(read_bytes(path)));
  EXPECT_THROW(before.require_in(path), Failure);
}

// Nearly every byte of a file is written: one that is changed is found, whether it is a value, a text, an
// attribute or a part of the index.
TEST(WrittenFile, IsRefusedIfAnyByteDiffers) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  const storage::WrittenBytes written = write_file(path);
  const std::string bytes = read_bytes(path);
  const std::string words = "file.h5: what was written is not what is read back: ";
  std::size_t unnoticed = 0;
  constexpr std::size_t step = 61;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    std::string changed = bytes;
    changed[at] ^= 16;
    write_bytes(path, changed);
    try {
      written.require_in(path);
      ++unnoticed;  // space that the library has set aside
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::machine_failed);
      EXPECT_TRUE(says(failure.what(), words + "bytes ")) << failure.what();
    }
  }
  EXPECT_LE(unnoticed, bytes.size() / step / 10);
  write_bytes(path, bytes.substr(0, bytes.size() - 1));
  expect_failure(ExitCode::machine_failed, words + "its end is missing", [&] { written.require_in(path); });
}

TEST(WrittenFile, IsRefusedIfAChunkIsAllZeros) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  const storage::WrittenBytes written = write_file(path);
  std::string bytes = read_bytes(path);
  bytes.replace(chunk_address(path, "numbers/value"), 100, 100, '\0');
  write_bytes(path, bytes);
  for (const storage::WrittenBytes& pieces : {written, written.hashed()})
    expect_failure(ExitCode::machine_failed, "file.h5: what was written is not what is read back: bytes ",
                   [&] { pieces.require_in(path); });
}

TEST(WrittenFile, CannotBeClosedBeforeItsObjects) {
  const TemporaryFolder folder;
  hdf5::File file = hdf5::File::create(folder / "file.h5");
  const hdf5::Group group = file.create_group("group");
  EXPECT_THROW(file.close(), std::logic_error);
}

// The HDF5 library has one state for all files and no locks.

template <class Action>
void in_another_thread(const Action& action) {
  std::thread(action).join();
}

TEST(LibraryUse, ASecondThreadAtTheSameTimeIsRefused) {
  const TemporaryFolder folder;
  hdf5::File file = hdf5::File::create(folder / "file.h5");
  hdf5::Dataset dataset =
      file.create_dataset("value", {.element = hdf5::Element::int64, .extent = {3}, .chunk = {3}});
  const std::vector<std::int64_t> values{1, 2, 3};
  const auto refused = [&] {
    EXPECT_THROW(dataset.extent(), std::logic_error);
    EXPECT_THROW(dataset.write(0, 3, values.data()), std::logic_error);
    EXPECT_THROW(dataset.set_text("units", "1"), std::logic_error);
    EXPECT_THROW(file.create_group("group"), std::logic_error);
    EXPECT_THROW(hdf5::File::create(folder / "other.h5"), std::logic_error);
  };
  {
    const hdf5::LibraryUse use;
    in_another_thread(refused);
    EXPECT_EQ(dataset.extent().size(), 1U);  // in this thread, inside the use
    in_another_thread(refused);
  }
  in_another_thread([&] { EXPECT_EQ(dataset.extent().size(), 1U); });
}

TEST(LibraryUse, FailuresPrintNothingInAnyThread) {
  const TemporaryFolder folder;
  hdf5::File file = hdf5::File::create(folder / "file.h5");
  const auto fail = [&] { EXPECT_ANY_THROW(file.create_group("twice")); };
  file.create_group("twice");
  ::testing::internal::CaptureStderr();
  fail();
  in_another_thread(fail);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// The size of encoded chunks: digits that are random are stored as they are, and repetitions are compressed.

constexpr std::size_t elements = 16384;

/// Compression ratio of a dataset: encoded size of a chunk over the size of its elements.
double ratio_of(const std::vector<double>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  const auto stored = hdf5::encode_chunk({sizeof(double), 1}, bytes);
  return static_cast<double>(stored.size()) / static_cast<double>(bytes.size());
}

std::vector<double> draws_with_period(std::size_t period, Draws& draws) {
  std::vector<double> values(elements);
  for (std::size_t i = 0; i < elements; ++i)
    values[i] = i < period ? draws.uniform(1.0, 2.0) : values[i - period];
  return values;
}

TEST(ChunkFilters, RandomDigitsTakeLittleMoreThanTheirOwnSize) {
  Draws draws(20260105);
  for (int round = 0; round < 10; ++round) EXPECT_LE(ratio_of(draws_with_period(elements, draws)), 0.88);
}

// Each design point, or each trial of a machine, has the same draws.
TEST(ChunkFilters, RepeatedDrawsAreCompressed) {
  Draws draws(20260106);
  for (const std::size_t period : {100U, 1000U, 2000U, 4096U, 5000U, 8192U}) {
    const double once = static_cast<double>(period) / elements;
    EXPECT_LE(ratio_of(draws_with_period(period, draws)), 0.01 + 1.1 * once) << period;
  }
}

TEST(ChunkFilters, RepeatedValuesAreCompressed) {
  Draws draws(20260107);
  for (const std::size_t times : {2U, 4U, 16U}) {
    std::vector<double> values(elements);
    for (std::size_t i = 0; i < elements; ++i)
      values[i] = i % times == 0 ? draws.uniform(1.0, 2.0) : values[i - 1];
    EXPECT_LE(ratio_of(values), times == 2 ? 0.75 : 0.5) << times;
  }
}

}  // namespace
}  // namespace zerocount::testing
