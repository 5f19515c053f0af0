#include "results/storage/output_lock.hpp"

#include <atomic>
#include <filesystem>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

TEST(OutputLock, IsHeldByOneAtATime) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  {
    const storage::OutputLock lock(output);
    expect_failure(ExitCode::machine_failed, "all.h5: another run is writing this output",
                   [&] { storage::OutputLock{output}; });
    const storage::OutputLock other(directory / "other.h5");
  }
  const storage::OutputLock again(output);
}

TEST(OutputLock, LeavesNoFile) {
  const TemporaryFolder directory;
  { const storage::OutputLock lock(directory / "all.h5"); }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(OutputLock, HoldsAgainstOtherProcessesUntilItsOwnDies) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  int ready[2] = {-1, -1};
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const storage::OutputLock lock(output);
    if (::write(ready[1], "x", 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  expect_failure(ExitCode::machine_failed, "another run", [&] { storage::OutputLock{output}; });
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  const storage::OutputLock lock(output);
}

TEST(OutputLock, IsNeverHeldTwiceWhileManyTry) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  std::atomic<int> holders{0};
  std::atomic<int> taken{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&] {
      for (int attempt = 0; attempt < 2000; ++attempt) {
        try {
          const storage::OutputLock lock(output);
          EXPECT_EQ(++holders, 1);
          ++taken;
          --holders;
        } catch (const Failure&) {
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(taken, 100);
}

TEST(OutputLock, SaysWhereItCannotBeMade) {
  expect_failure(ExitCode::machine_failed,
                 "/nowhere/all.h5.lock: cannot make the lock file: No such file or directory",
                 [] { storage::OutputLock{"/nowhere/all.h5"}; });
}

}  // namespace
}  // namespace zerocount::testing
