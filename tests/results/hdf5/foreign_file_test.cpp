// Files that were damaged on purpose, under a right checksum: the HDF5 library crashes on some.
#include "results/hdf5/foreign_file.hpp"

#include <csignal>
#include <fstream>
#include <stop_token>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

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

/// Kills the children of a thread of this process as they appear, until the stop.
void kill_children(const std::stop_token& stop, pid_t thread) {
  const std::string children = fmt::format("/proc/self/task/{}/children", thread);
  while (!stop.stop_requested()) {
    std::ifstream list(children);
    for (pid_t child = 0; list >> child;) ::kill(child, SIGKILL);
  }
}

TEST_F(ForeignFile, WhoseReaderIsKilledIsNotCalledDamaged) {
  const std::jthread killer(kill_children, ::gettid());
  bool killed = false;
  for (int i = 0; i < 200 && !killed; ++i) {
    try {
      hdf5::open_foreign(original);
    } catch (const Failure& failure) {
      killed = true;
      EXPECT_EQ(failure.code(), ExitCode::machine_failed);
      EXPECT_NE(std::string(failure.what()).find("was killed (signal 9)"), std::string::npos)
          << failure.what();
    }
  }
  EXPECT_TRUE(killed);
}

TEST_F(ForeignFile, ThatIsWholeIsOpened) {
  EXPECT_TRUE(hdf5::open_foreign(original).contains("trial"));
}

}  // namespace
}  // namespace zerocount::testing
