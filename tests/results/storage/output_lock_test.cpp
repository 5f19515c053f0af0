#include "results/storage/output_lock.hpp"

#include <stop_token>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr storage::Heartbeat quick{std::chrono::milliseconds(10), std::chrono::milliseconds(400)};

class QuickOwnerLock : public storage::OwnerLock {
 public:
  explicit QuickOwnerLock(const std::filesystem::path& output) : OwnerLock(output, quick) {}
};

template <class Lock>
class Locks : public ::testing::Test {};

using LockTypes = ::testing::Types<storage::OutputLock, QuickOwnerLock>;
TYPED_TEST_SUITE(Locks, LockTypes);

TYPED_TEST(Locks, AreHeldByOneAtATime) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  {
    const TypeParam lock(output);
    expect_failure(ExitCode::machine_failed, "all.h5: another run is writing this output",
                   [&] { TypeParam{output}; });
    const TypeParam other(directory / "other.h5");
  }
  const TypeParam again(output);
}

TYPED_TEST(Locks, LeaveNoFile) {
  const TemporaryFolder directory;
  { const TypeParam lock(directory / "all.h5"); }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TYPED_TEST(Locks, HoldAgainstOtherProcessesUntilTheirOwnDies) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  int ready[2] = {-1, -1};
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const TypeParam lock(output);
    if (::write(ready[1], "x", 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  expect_failure(ExitCode::machine_failed, "another run", [&] { TypeParam{output}; });
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  const TypeParam lock(output);
}

TYPED_TEST(Locks, AreNeverHeldTwiceWhileManyTry) {
  const TemporaryFolder directory;
  const std::filesystem::path output = directory / "all.h5";
  std::atomic<int> holders{0};
  std::atomic<int> taken{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&] {
      for (int attempt = 0; attempt < 200; ++attempt) {
        try {
          const TypeParam lock(output);
          EXPECT_EQ(++holders, 1);
          ++taken;
          --holders;
        } catch (const Failure&) {
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(taken, 0);
}

TEST(OutputLock, NamesThePathWhereItCannotBeMade) {
  expect_failure(ExitCode::machine_failed,
                 "/nowhere/all.h5.lock: cannot make the lock file: No such file or directory",
                 [] { storage::OutputLock{"/nowhere/all.h5"}; });
}

TEST(OwnerLock, TakesTheOutputOfAnOwnerThatDoesNotRenewItsFile) {
  const TemporaryFolder directory;
  directory.write("all.h5.owner-node-7-0123456789ab-4711-00c0ffee", "");
  const QuickOwnerLock lock(directory / "all.h5");
  EXPECT_FALSE(std::filesystem::exists(directory / "all.h5.owner-node-7-0123456789ab-4711-00c0ffee"));
  EXPECT_TRUE(std::filesystem::exists(lock.path()));
}

TEST(OwnerLock, IsRefusedWhileAnOwnerOfAnotherHostRenewsItsFile) {
  const TemporaryFolder directory;
  const std::filesystem::path file = directory / "all.h5.owner-node-7-0123456789ab-4711-00c0ffee";
  directory.write(file.filename().string(), "");
  const std::jthread owner([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
      std::this_thread::sleep_for(quick.interval);
    }
  });
  expect_failure(
      ExitCode::machine_failed,
      "all.h5: another run is writing this output: process 4711 on node-7; wait for it or stop it, or "
      "name another output",
      [&] { QuickOwnerLock{directory / "all.h5"}; });
  const QuickOwnerLock other(directory / "other.h5");
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(OwnerLock, EndsAProcessWhoseOutputAnotherHasTaken) {
  const TemporaryFolder directory;
  const auto halted = [&] {
    const QuickOwnerLock lock(directory / "all.h5");
    ::unlink(lock.path().c_str());
    for (;;) ::pause();
  };
  EXPECT_EXIT(halted(), ::testing::ExitedWithCode(5), "all.h5.owner.*another run has taken this output");
}

/// Locks and unlocks; the exit code is 1 if another process had the lock at the same time.
[[noreturn]] void lock_again_and_again(const TemporaryFolder& directory) {
  const std::filesystem::path held = directory / "held";
  for (int attempt = 0; attempt < 10; ++attempt) {
    try {
      const QuickOwnerLock lock(directory / "all.h5");
      const int mark = ::open(held.c_str(), O_CREAT | O_EXCL, 0600);
      if (mark < 0) ::_exit(1);
      ::close(mark);
      std::this_thread::sleep_for(quick.interval);
      ::unlink(held.c_str());
    } catch (const Failure&) {
    }
  }
  ::_exit(0);
}

TEST(OwnerLock, IsNeverHeldByTwoProcesses) {
  const TemporaryFolder directory;
  std::vector<pid_t> children;
  for (int child = 0; child < 4; ++child) {
    children.push_back(::fork());
    if (children.back() == 0) lock_again_and_again(directory);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
}

TEST(OwnerLock, OtherFilesAreNotTakenForOwnerFiles) {
  const TemporaryFolder directory;
  const std::vector<std::string> others{"all.h5.owner-", "all.h5.owner-node-m-x-1", "all.h5.owner-1-2-3",
                                        "all.h5.owner"};
  for (const std::string& name : others) directory.write(name, "");
  const storage::OwnerLock lock(directory / "all.h5");
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(directory / name)) << name;
}

}  // namespace
}  // namespace zerocount::testing
