#include <oneapi/tbb/global_control.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/reading/export.hpp"
#include "results/storage/durable_file.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/test.hpp"

/// Suppressions that the leak sanitizer reads, if it is linked. The HDF5 library does not free everything of
/// a file that it could not close.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

struct Ending {
  int status{0};
  std::string message;  ///< message of the failure, followed by everything written to stderr
};

/// Runs `action` in a process whose files cannot grow beyond `bytes`, as on a full disk.
Ending with_file_limit(rlim_t bytes, const std::function<void()>& action) {
  int pipe_ends[2] = {-1, -1};
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const struct rlimit limit { bytes, bytes };
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::dup2(pipe_ends[1], STDERR_FILENO);
    int code = 0;
    try {
      action();
    } catch (const Failure& failure) {
      code = static_cast<int>(failure.code());
      const std::string text = failure.what();
      if (::write(pipe_ends[1], text.data(), text.size()) < 0) code = 99;
    }
    ::exit(code);  // not _exit: what the library does at exit belongs to the test
  }
  ::close(pipe_ends[1]);
  Ending ending;
  char buffer[4096];
  for (ssize_t size = 0; (size = ::read(pipe_ends[0], buffer, sizeof buffer)) > 0;)
    ending.message.append(buffer, static_cast<std::size_t>(size));
  ::close(pipe_ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  ending.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return ending;
}

void expect_full(const Ending& ending, const fs::path& path) {
  EXPECT_EQ(ending.status, 5) << ending.message;
  EXPECT_TRUE(says(ending.message, path.string(), "File too large"));
  EXPECT_FALSE(says(ending.message, "HDF5"));
  EXPECT_EQ(ending.message.find('\n'), std::string::npos) << ending.message;
}

/// Tests of outputs that do not fit on the disk. The parent process must not have threads: its child would
/// not have them, and could not wait for them when it ends.
class FullOutput : public ::testing::Test {
 protected:
  const oneapi::tbb::global_control one_thread{oneapi::tbb::global_control::max_allowed_parallelism, 1};
};

TEST_F(FullOutput, FailsAShardWithItsPathAndTheReason) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  for (const rlim_t limit : {0U, 100U, 2000U, 20000U, 60000U}) {
    const fs::path path = directory / "shard.h5";
    expect_full(with_file_limit(limit,
                                [&] {
                                  shards::write_shard(path, study, {0, 120}, sample_results(study, {0, 120}));
                                }),
                path);
    EXPECT_FALSE(fs::exists(path));
    EXPECT_FALSE(fs::exists(storage::part_of(path)));
  }
}

TEST_F(FullOutput, FailsAMergeAndKeepsTheShards) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 40);
  const fs::path path = directory / "all.h5";
  for (const rlim_t limit : {0U, 2000U, 50000U, 100000U}) {
    expect_full(
        with_file_limit(
            limit,
            [&] { testing::merge_shards(shards, study, path, layout::all_rows(study), sample_statistics); }),
        path);
    EXPECT_FALSE(fs::exists(path));
    EXPECT_FALSE(fs::exists(storage::part_of(path)));
  }
  EXPECT_EQ(shards::list_shards(directory / "shards", study).shards.size(), shards.size());
  testing::merge_shards(shards, study, path, layout::all_rows(study), sample_statistics);
}

TEST_F(FullOutput, FailsAnExport) {
  const TemporaryFolder directory;
  const fs::path path = write_sample_file(directory.path(), sample_study());
  expect_full(
      with_file_limit(1000, [&] { reading::export_csv(reading::AllTrialsFile(path), directory / "csv"); }),
      directory / "csv");
  // The table of points fits and the next does not: neither stays to stop the next attempt.
  EXPECT_TRUE(fs::is_empty(directory / "csv"));
  EXPECT_EQ(reading::export_csv(reading::AllTrialsFile(path), directory / "csv").size(), 7U);
}

TEST(UnwritableOutput, IsReportedWithTheReason) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  write_bytes(directory / "file", "not a directory");
  const std::vector<shards::TrialResult> results = sample_results(study, {0, 120});
  expect_failure(ExitCode::machine_failed, "Not a directory", [&] {
    shards::write_shard(directory.path() / "file" / "shard.h5", study, {0, std::ssize(results)}, results);
  });
  expect_failure(ExitCode::machine_failed, "No such file or directory", [&] {
    shards::write_shard(directory.path() / "nowhere" / "shard.h5", study, {0, std::ssize(results)}, results);
  });
  expect_failure(ExitCode::machine_failed, "Not a directory",
                 [&] { storage::make_directory(directory.path() / "file" / "below"); });
  expect_failure(ExitCode::machine_failed, "File exists",
                 [&] { storage::make_directory(directory / "file"); });
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 40);
  expect_failure(ExitCode::machine_failed, "No such file or directory", [&] {
    testing::merge_shards(shards, study, directory.path() / "nowhere" / "all.h5", layout::all_rows(study),
                          {});
  });
}

TEST(MakeDirectory, MakesItsParentsToo) {
  const TemporaryFolder directory;
  storage::make_directory(directory.path() / "a" / "b" / "c");
  storage::make_directory(directory.path() / "a" / "b" / "c");
  EXPECT_TRUE(fs::is_directory(directory.path() / "a" / "b" / "c"));
}

}  // namespace
}  // namespace zerocount::testing
