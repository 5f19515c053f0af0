// Files that were damaged on purpose, under a right checksum: the HDF5 library crashes on some.
#include "results/hdf5/foreign_file.hpp"

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "results/hdf5/array_file.hpp"
#include "results/reading/study_file.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

class ForeignFile : public ::testing::Test {
 protected:
  /// The file with a byte of its first collection of texts (the library's global heap) set, under a right
  /// checksum.
  std::filesystem::path with_byte(std::size_t place, char value) const {
    std::string bytes = read_bytes(original);
    const std::size_t collection = bytes.find("GCOL");
    if (collection == std::string::npos) throw std::logic_error("no global heap");
    bytes.at(collection + place) = value;
    bytes.resize(bytes.size() - storage::checksum_trailer_length);
    write_bytes(directory / "changed.h5", bytes);
    storage::append_checksum(directory / "changed.h5");
    return directory / "changed.h5";
  }

  TemporaryFolder directory;
  std::filesystem::path original = write_sample_file(directory.path(), sample_study(1, 5, 1));
};

TEST_F(ForeignFile, ThatCrashesTheLibraryIsRefused) {
  int refused = 0;
  for (const std::size_t place : {9U, 25U, 28U, 31U, 40U, 48U}) {
    for (const char value : {'\x01', '\x7f', '\xff'}) {
      const std::filesystem::path path = with_byte(place, value);
      try {
        hdf5::open_foreign(path);
      } catch (const Failure& failure) {
        EXPECT_EQ(failure.code(), ExitCode::bad_data);
        EXPECT_NE(std::string(failure.what()).find("changed.h5: damaged: the HDF5 library fails"),
                  std::string::npos);
        ++refused;
        EXPECT_THROW(reading::StudyFile{path}, Failure);
        EXPECT_THROW(hdf5::ArrayFile{path}, Failure);
      }
    }
  }
  EXPECT_GT(refused, 0);
}

TEST_F(ForeignFile, ThatIsWholeIsOpened) {
  EXPECT_TRUE(hdf5::open_foreign(original).contains("trial"));
}

}  // namespace
}  // namespace zerocount::testing
