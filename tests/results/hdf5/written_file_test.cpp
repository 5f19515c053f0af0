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

/// Writes some of everything that results files have.
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

hdf5::WrittenValues write_file(const fs::path& path) {
  hdf5::File file = hdf5::File::create(path);
  fill(file);
  return file.close();
}

TEST(WrittenFile, IsFoundAsItWasWritten) {
  const TemporaryFolder folder;
  const hdf5::WrittenValues written = write_file(folder / "file.h5");
  hdf5::require_written(folder / "file.h5", written);
  EXPECT_TRUE(written.contains("/numbers/value"));
  EXPECT_TRUE(written.contains("/nothing/row"));
}

TEST(WrittenFile, IsFoundAsItWasWrittenAndAddedTo) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  hdf5::WrittenValues before = write_file(path);
  hdf5::File file = hdf5::File::open_to_change(path, std::move(before));
  file.set_integer("finished", 1);
  const hdf5::WrittenValues written = file.close();
  EXPECT_TRUE(written.at("/").attributes.contains("finished"));
  EXPECT_TRUE(written.contains("/numbers/value"));
  hdf5::require_written(path, written);
}

/// Each of these changes one thing that a file was to hold.
TEST(WrittenFile, IsRefusedWhereAnythingDiffers) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  const hdf5::WrittenValues written = write_file(path);
  const auto refused = [&](const std::string& words,
                           const std::function<void(hdf5::WrittenValues&)>& change) {
    hdf5::WrittenValues other = written;
    change(other);
    expect_failure(ExitCode::machine_failed, "file.h5: what was written is not what is read back: " + words,
                   [&] { hdf5::require_written(path, other); });
  };
  refused("/: the attribute 'name' differs", [](auto& values) { values["/"].attributes["name"] = "u"; });
  refused("/: the attribute 'seed' differs",
          [](auto& values) { values["/"].attributes["seed"] = std::uint64_t{1}; });
  refused("/: the attribute 'other' is missing", [](auto& values) { values["/"].attributes["other"] = "u"; });
  refused("/labels: its texts differ", [](auto& values) { values["/labels"].texts[1] = "three"; });
  refused("/numbers/value: rows 10000 to 19999 differ",
          [](auto& values) { values["/numbers/value"].rows[1].digest ^= 1; });
  refused("/numbers/row: the rows from 16384 on differ",
          [](auto& values) { values["/numbers/row"].chunks[1].digest ^= 1; });
  refused("/numbers/value: its axis /labels is missing",
          [](auto& values) { values["/numbers/value"].scales.emplace_back(0, "/labels"); });
  refused("/labels: it is not an axis", [](auto& values) { values["/labels"].is_scale = true; });
  refused("/", [](auto& values) { values["/more"]; });
}

// A dataset names its axes, and an axis its datasets: both are read back.
TEST(WrittenFile, IsRefusedWhereAnAxisIsNotNamed) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  for (const auto& [dataset, attribute] : std::vector<std::pair<std::string, std::string>>{
           {"numbers/row", "REFERENCE_LIST"}, {"numbers/value", "DIMENSION_LIST"}}) {
    const hdf5::WrittenValues written = write_file(path);
    remove_dataset_attribute(path, dataset, attribute);
    expect_failure(ExitCode::machine_failed,
                   "file.h5: what was written is not what is read back: /numbers/value: its axis "
                   "/numbers/row is missing",
                   [&] { hdf5::require_written(path, written); });
  }
}

TEST(WrittenFile, IsRefusedWhereAChunkIsZeros) {
  const TemporaryFolder folder;
  const fs::path path = folder / "file.h5";
  const hdf5::WrittenValues written = write_file(path);
  std::string bytes = read_bytes(path);
  bytes.replace(chunk_address(path, "numbers/value"), 100, 100, '\0');
  write_bytes(path, bytes);
  expect_failure(ExitCode::machine_failed,
                 "file.h5: what was written is not what is read back: /numbers/value",
                 [&] { hdf5::require_written(path, written); });
}

TEST(WrittenFile, IsClosedAfterWhatIsInIt) {
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

TEST(LibraryUse, OfASecondThreadAtTheSameTimeIsRefused) {
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

TEST(LibraryUse, ThatFailsPrintsNothingInAnyThread) {
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

/// Encoded size of a chunk over that of its elements.
double ratio_of(const std::vector<double>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  const auto stored = hdf5::encode_chunk({sizeof(double), 1}, bytes);
  EXPECT_TRUE(stored);
  return stored ? static_cast<double>(stored->size()) / static_cast<double>(bytes.size()) : 1.0;
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

// Each design point, or each trial of a rig, has the same draws.
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
