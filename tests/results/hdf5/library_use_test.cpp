// The HDF5 library has one state for all files and no locks.
#include "results/hdf5/library_use.hpp"

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/hdf5.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

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
