// The HDF5 library has one state for all files and no locks.
#include "results/hdf5/library_use.hpp"

#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "results/hdf5/hdf5.hpp"
#include "tests/support/temporary_folder.hpp"

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

}  // namespace
}  // namespace zerocount::testing
