// Files that were damaged on purpose, under a right checksum: the HDF5 library crashes on some.
#include "results/hdf5/foreign_file.hpp"

#include <csignal>
#include <stop_token>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/storage/file_contents.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class ForeignFile : public ::testing::Test {
 protected:
  /// Skips the test in a sanitized program. Such a program reads without a child process if it has threads,
  /// as it has after writing a file.
  static void require_readers() {
#ifdef ZEROCOUNT_SANITIZED
    GTEST_SKIP() << "no reader in a sanitized program with threads";
#endif
  }

  /// A copy of the file in which one byte of its first collection of texts (the library's global heap) is
  /// changed, with a valid checksum trailer.
  std::filesystem::path with_byte(std::size_t place, char value) const {
    std::string bytes = read_bytes(original);
    const std::size_t collection = bytes.find("GCOL");
    if (collection == std::string::npos) throw std::logic_error("no global heap");
    bytes.at(collection + place) = value;
    bytes.resize(bytes.size() - storage::checksum_trailer_length);
    write_bytes(directory / "changed.h5", bytes);
    append_checksum(directory / "changed.h5");
    return directory / "changed.h5";
  }

  TemporaryFolder directory;
  std::filesystem::path original = write_sample_file(directory.path(), sample_study(1, 5, 1));
};

TEST_F(ForeignFile, AFileThatCrashesTheLibraryIsRefused) {
  require_readers();
  if (IsSkipped()) return;
  int refused = 0;
  for (const std::size_t place : {9U, 25U, 28U, 31U, 40U, 48U}) {
    for (const char value : {'\x01', '\x7f', '\xff'}) {
      const std::filesystem::path path = with_byte(place, value);
      try {
        hdf5::open_foreign(path);
      } catch (const Failure& failure) {
        EXPECT_EQ(failure.code(), ExitCode::bad_data);
        EXPECT_TRUE(says(failure.what(), "changed.h5: damaged: the HDF5 library fails"));
        ++refused;
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

TEST_F(ForeignFile, AKilledReaderDoesNotMeanDamage) {
  require_readers();
  if (IsSkipped()) return;
  const std::jthread killer(kill_children, ::gettid());
  bool killed = false;
  for (int i = 0; i < 200 && !killed; ++i) {
    try {
      hdf5::open_foreign(original);
    } catch (const Failure& failure) {
      killed = true;
      EXPECT_EQ(failure.code(), ExitCode::machine_failed);
      EXPECT_TRUE(says(failure.what(), "was ended by signal 9"));
    }
  }
  EXPECT_TRUE(killed);
}

/// Opens a file as a user who may not start any more processes, and ends with the exit code of the attempt.
[[noreturn]] void open_without_children(const std::filesystem::path& path) {
  constexpr uid_t nobody = 65534;
  const rlimit none{0, 0};
  try {
    if (geteuid() == 0 && setuid(nobody) != 0) throw std::logic_error("root cannot become another user");
    setrlimit(RLIMIT_NPROC, &none);
    hdf5::open_foreign(path);
  } catch (const Failure& failure) {
    std::fputs(failure.what(), stderr);
    std::_Exit(static_cast<int>(failure.code()));
  }
  std::_Exit(EXIT_SUCCESS);
}

TEST_F(ForeignFile, IsNotOpenedIfNoReaderProcessCanStart) {
  EXPECT_EXIT(
      open_without_children(original), ::testing::ExitedWithCode(5),
      "sample.h5: cannot start a child process that reads it first: Resource temporarily unavailable");
}

/// Process id of the first child of a child of this process; 0 if that child ends without having one.
pid_t wait_for_grandchild(pid_t child) {
  const std::string list = fmt::format("/proc/{0}/task/{0}/children", child);
  pid_t grandchild = 0;
  while (!(std::ifstream(list) >> grandchild)) {
    if (waitpid(child, nullptr, WNOHANG) == child) return 0;
  }
  return grandchild;
}

/// Stops the reader of a file, kills its parent, and returns whether the reader has ended then. False also if
/// the reader was stopped before it had asked the system for that signal.
bool reader_ends_with_its_parent(const std::filesystem::path& path) {
  const pid_t parent = fork();
  if (parent == 0) {
    hdf5::open_foreign(path);
    std::_Exit(EXIT_SUCCESS);
  }
  const pid_t reader = wait_for_grandchild(parent);
  if (reader == 0) return false;
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  kill(reader, SIGSTOP);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  int status = 0;
  if (waitpid(reader, &status, WNOHANG) == 0) {
    kill(reader, SIGKILL);
    waitpid(reader, nullptr, 0);
    return false;
  }
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

// It has the parent's locks.
TEST_F(ForeignFile, ReaderEndsWithItsParent) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // the reader becomes a child of this process
  bool ended = false;
  for (int i = 0; i < 50 && !ended; ++i) ended = reader_ends_with_its_parent(original);
  EXPECT_TRUE(ended);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
}

TEST_F(ForeignFile, AWholeFileIsOpened) {
  EXPECT_TRUE(hdf5::open_foreign(original).contains("trial"));
}

}  // namespace
}  // namespace zerocount::testing
