// One call of the system fails at a time: a write that fails must never pass. Whatever call it is, the
// command ends with exit code 5 and a message that names the file, and nothing wrong stands in place: the
// output is the one from before (or none), or the right one.
#include <cerrno>
#include <csignal>
#include <regex>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// A failure that a system call is made to report.
struct Fault {
  /// Errno of the failed call, or the name of another failure, as text; see failing_calls.cpp.
  std::string error;
  bool lasting{false};
};

const std::array<Fault, 4> faults{Fault{std::to_string(ENOSPC), false}, Fault{std::to_string(EIO), true},
                                  Fault{std::to_string(EIO), false}, Fault{std::to_string(ENOSPC), true}};

/// A command that writes files in the test's folder.
struct Writer {
  std::vector<std::string> arguments;
  std::vector<std::string> outputs;
  std::string before;   ///< contents of each output before the command; empty: no file
  bool resumes{false};  ///< the next attempt uses the files that a failed one left behind
};

/// The content of an output file that must be right: the datasets of a results file, without attributes that
/// state the time, or the text of any other file, without the date of a record of baselines.
std::map<std::string, std::string> content_of(const fs::path& path) {
  if (path.extension() == ".yaml") {
    return {{"", std::regex_replace(read_bytes(path), std::regex("date: [^\n]*"), "")}};
  }
  if (path.extension() != ".h5") return {{"", read_bytes(path)}};
  const reading::AllTrialsFile file(path);  // checks the checksum trailer
  return stored_datasets(path);
}

class FailingCalls : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("study.yaml", small_manifest(8));
    folder_.write("retained.yaml", small_manifest(8, "retain: {trials: [0]}\n"));
  }

  void complete(const std::vector<std::string>& arguments) const {
    const ProgramResult result = zerocount_program(arguments, folder_.path());
    ASSERT_EQ(result.code, 0) << result.err;
  }

  ProgramResult run_with(const Writer& writer, const std::string& calls, long at, const Fault& fault) const {
    const std::string folder = folder_.path().string();
    std::vector<std::string> environment{std::string("LD_PRELOAD=") + ZEROCOUNT_FAILING_CALLS,
                                         "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0",
                                         "FAIL_UNDER=" + folder,
                                         "FAIL_CALLS=" + calls,
                                         "FAIL_AT=" + std::to_string(at),
                                         "FAIL_ERROR=" + fault.error,
                                         "FAIL_COUNT=" + (counts_ / "count").string()};
    if (fault.lasting) environment.emplace_back("FAIL_LASTING=1");
    return zerocount_program(writer.arguments, folder_.path(), environment);
  }

  /// Restores the output files to their contents before the command.
  void restore(const Writer& writer) const {
    for (const std::string& output : writer.outputs) {
      fs::remove_all(folder_ / (output + ".shards"));
      fs::remove(folder_ / output);
      if (!writer.before.empty()) folder_.write(output, writer.before);
    }
  }

  /// The number of system calls of this kind in a run without a failure, which also makes the correct
  /// outputs.
  long count_calls(const Writer& writer, const std::string& calls) {
    restore(writer);
    const ProgramResult result = run_with(writer, calls, 0, faults[0]);
    EXPECT_EQ(result.code, 0) << result.err;
    right_.clear();
    for (const std::string& output : writer.outputs) right_[output] = content_of(folder_ / output);
    return std::atol(read_bytes(counts_ / "count").c_str());
  }

  bool is_right(const std::string& output) const { return content_of(folder_ / output) == right_.at(output); }

  /// Expects that a failed call leaves no wrong output. A failed read ends the process at once, and may leave
  /// a *.part file (results/hdf5/file_driver.hpp).
  void expect_nothing_wrong(const Writer& writer, const std::string& calls,
                            const ProgramResult& result) const {
    EXPECT_TRUE(result.code == 0 || result.code == 5) << result.code << ": " << result.err;
    for (const std::string& output : writer.outputs) {
      const bool exists = fs::exists(folder_ / output);
      const bool untouched = writer.before.empty() ? !exists : read_bytes(folder_ / output) == writer.before;
      const bool removed = !writer.resumes && !exists;  // no earlier answer stands beside a failure
      EXPECT_TRUE((result.code != 0 && (untouched || removed)) || (exists && is_right(output))) << output;
      EXPECT_FALSE(calls == "writes" && fs::exists(folder_ / (output + ".part"))) << output;
    }
    if (result.code != 5) return;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(says(result.err, "HDF5"));
    const auto says = [&](const std::string& phrase) { return result.err.find(phrase) != std::string::npos; };
    EXPECT_TRUE(says("study.yaml") ||
                std::any_of(writer.outputs.begin(), writer.outputs.end(),
                            [&](const fs::path& output) { return says(output.begin()->string()); }))
        << result.err;
    EXPECT_TRUE(says("cannot ") || says(": what was written is not what is read back: ")) << result.err;
  }

  void expect_next_attempt_ends_right(const Writer& writer) const {
    const bool all_there =
        std::all_of(writer.outputs.begin(), writer.outputs.end(),
                    [&](const std::string& output) { return fs::exists(folder_ / output); });
    if (!writer.resumes && !all_there) restore(writer);
    if (!writer.resumes && all_there) return;
    const ProgramResult result = zerocount_program(writer.arguments, folder_.path());
    EXPECT_EQ(result.code, 0) << result.err;
    for (const std::string& output : writer.outputs) EXPECT_TRUE(is_right(output)) << output;
  }

  /// Makes every `step`-th of the system calls fail, one per run of the command, each with `ways` of the
  /// faults, which are used in turn.
  void fail_calls(const Writer& writer, const std::string& calls, std::span<const Fault> faults,
                  std::size_t ways, long step = 1) {
    const long count = count_calls(writer, calls);
    ASSERT_GT(count, 0);
    for (long at = 1; at <= count; at += step) {
      for (std::size_t way = 0; way < ways; ++way) {
        const Fault& fault = faults[(static_cast<std::size_t>(at / step) + way) % faults.size()];
        SCOPED_TRACE(writer.arguments.front() + ", call " + std::to_string(at) + " of " +
                     std::to_string(count) + ", error " + fault.error + (fault.lasting ? ", lasting" : ""));
        restore(writer);
        expect_nothing_wrong(writer, calls, run_with(writer, calls, at, fault));
        if (at / step % 8 == 0) expect_next_attempt_ends_right(writer);
        if (HasFailure()) return;
      }
    }
  }

  static Writer run() {
    return {{"run", "study.yaml", "-o", "out.h5", "-q", "--threads", "1"}, {"out.h5"}, "", true};
  }

  Writer merge() const {
    complete({"run", "retained.yaml", "-o", "a.h5", "-q", "--shard", "1/2"});
    complete({"run", "retained.yaml", "-o", "b.h5", "-q", "--shard", "2/2"});
    return {{"merge", "a.h5", "b.h5", "-o", "out.h5"}, {"out.h5"}, "", false};
  }

  void make_input() const {
    if (!fs::exists(folder_ / "in.h5")) complete({"run", "retained.yaml", "-o", "in.h5", "-q"});
  }

  Writer export_of_tables() const {
    make_input();
    return {{"export", "in.h5", "-o", "out"},
            {"out/points.csv", "out/trials.csv", "out/outcomes.csv", "out/jerks.csv", "out/profiles.csv",
             "out/trace.csv"},
            "",
            false};
  }

  /// Makes the system calls of the other outputs fail.
  /// @param ways number of faults that are tried for each call
  void fail_calls_of_other_outputs(std::size_t ways) {
    make_input();
    const std::string before = "what stood there before";
    fail_calls({{"report", "in.h5", "-o", "out.html", "--force"}, {"out.html"}, before, false}, "writes",
               faults, ways);
    fail_calls({{"trace", "in.h5", "-o", "out.csv"}, {"out.csv"}, "", false}, "writes", faults, ways);
    fail_calls({{"compare", "in.h5", "in.h5", "--json", "out.json", "--force"}, {"out.json"}, before, false},
               "writes", faults, ways);
    fail_calls({{"baseline", "in.h5", "-o", "out.h5", "--reason", "first"},
                {"out.h5", "out.h5.log.yaml"},
                "",
                false},
               "writes", faults, ways);
  }

  TemporaryFolder folder_;
  TemporaryFolder counts_;
  std::map<std::string, std::map<std::string, std::string>> right_;
};

// In these, a call fails in one of four ways, which take turns: ENOSPC or EIO, once or from then on. The
// steps are primes, so that they meet all kinds of calls that come in turns.
TEST_F(FailingCalls, WritesOfARunNeverLeaveAWrongFile) {
  fail_calls(run(), "writes", faults, 1, 53);
}

TEST_F(FailingCalls, WritesOfAMergeNeverLeaveAWrongFile) {
  fail_calls(merge(), "writes", faults, 1, 43);
}

TEST_F(FailingCalls, WritesOfAnExportNeverLeaveAWrongFile) {
  fail_calls(export_of_tables(), "writes", faults, 1, 5);
}

TEST_F(FailingCalls, WritesOfOtherOutputsNeverLeaveAWrongFile) {
  fail_calls_of_other_outputs(1);
}

// A history is changed in place: whatever fails, it has the runs from before, and the new one or not.
TEST_F(FailingCalls, WritesOfAHistoryKeepTheEarlierRuns) {
  make_input();
  complete({"run", "study.yaml", "-o", "earlier.h5", "-q"});
  complete({"history", "add", "earlier.h5"});
  const std::string before = read_bytes(folder_ / "history.sqlite");
  const Writer add{{"history", "add", "in.h5"}, {"history.sqlite"}, before, false};
  const auto runs = [&] {
    const ProgramResult shown = zerocount_program({"history", "show", "--format", "json"}, folder_.path());
    EXPECT_EQ(shown.code, 0) << shown.err;
    const std::regex run("\"study_sha256\": \"[0-9a-f]+\"");
    std::set<std::string> found;
    for (std::sregex_iterator it(shown.out.begin(), shown.out.end(), run), end; it != end; ++it)
      found.insert(it->str());
    return found.size();
  };
  ASSERT_EQ(run_with(add, "writes", 0, faults[0]).code, 0);
  ASSERT_EQ(runs(), 2U);
  const long count = std::atol(read_bytes(counts_ / "count").c_str());
  ASSERT_GT(count, 5);
  for (long at = 1; at <= count; at += 3) {
    const Fault& fault = faults[static_cast<std::size_t>(at / 3) % faults.size()];
    SCOPED_TRACE("call " + std::to_string(at) + ", error " + fault.error +
                 (fault.lasting ? ", lasting" : ""));
    fs::remove(folder_ / "history.sqlite-journal");
    restore(add);
    const ProgramResult result = run_with(add, "writes", at, fault);
    EXPECT_TRUE(result.code == 0 || result.code == 5) << result.code << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(says(result.err, "history.sqlite"));
    const std::size_t found = runs();
    EXPECT_TRUE(found == 2 || (found == 1 && result.code == 5)) << found;
    if (HasFailure()) return;
  }
}

// The disk says that it has written, and has not.
TEST_F(FailingCalls, LostWritesAreDetected) {
  fail_calls(run(), "writes", std::array{Fault{"lost", false}}, 1, 113);
}

TEST_F(FailingCalls, ReadsOfWrittenDataNeverLeaveAWrongFile) {
  fail_calls(run(), "reads", std::array{Fault{std::to_string(EIO), false}}, 1, 293);
}

TEST_F(FailingCalls, ReadsOfAnExistingFileLeaveItUnchanged) {
  complete({"run", "study.yaml", "-o", "out.h5", "-q"});
  const Writer again{run().arguments, {"out.h5"}, read_bytes(folder_ / "out.h5"), true};
  fail_calls(again, "reads", std::array{Fault{std::to_string(EIO), true}}, 1, 23);
}

// Takes a quarter of an hour.
TEST_F(FailingCalls, DISABLED_EveryCallFailsInEveryWay) {
  fail_calls(run(), "writes", faults, faults.size());
  fail_calls(run(), "writes", std::array{Fault{"lost", false}}, 1);
  fail_calls(run(), "reads", faults, 2);
  fail_calls(merge(), "writes", faults, faults.size());
  fail_calls(merge(), "writes", std::array{Fault{"lost", false}}, 1);
  fail_calls(merge(), "reads", faults, 2);
  fail_calls(export_of_tables(), "writes", faults, faults.size());
  fail_calls_of_other_outputs(faults.size());
}

// Runs on a file system without flock, such as some network file systems.

class WithoutFlock : public ::testing::Test {
 protected:
  ProgramResult program(const std::vector<std::string>& arguments) const {
    return zerocount_program(arguments, folder_.path(),
                             {std::string("LD_PRELOAD=") + ZEROCOUNT_NO_FLOCK,
                              "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0"});
  }

  std::vector<std::string> owner_files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.find(".owner-") != std::string::npos) names.push_back(name);
    }
    return names;
  }

  TemporaryFolder folder_;
};

TEST_F(WithoutFlock, ARunGivesTheSameDataAndNamesItsLock) {
  folder_.write("study.yaml", small_manifest(8));
  const ProgramResult result = program({"run", "study.yaml", "-o", "out.h5"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "out.h5: the file system has no locks (flock); out.h5.owner-"));
  EXPECT_EQ(owner_files().size(), 0U);
  ASSERT_EQ(zerocount_program({"run", "study.yaml", "-o", "locked.h5"}, folder_.path()).code, 0);
  EXPECT_EQ(stored_datasets(folder_ / "out.h5"), stored_datasets(folder_ / "locked.h5"));
}

TEST_F(WithoutFlock, PartsAreMerged) {
  folder_.write("study.yaml", small_manifest(8));
  for (const std::string part : {"1", "2"})
    ASSERT_EQ(program({"run", "study.yaml", "-o", part + ".h5", "--shard", part + "/2"}).code, 0);
  const ProgramResult merged = program({"merge", "1.h5", "2.h5", "-o", "all.h5"});
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(owner_files().size(), 0U);
}

TEST_F(WithoutFlock, TheOwnerFileOfAKilledRunBlocksNothing) {
  folder_.write("study.yaml", small_manifest(100000));
  const std::string line = "cd " + folder_.path().string() +
                           " && LD_PRELOAD=" ZEROCOUNT_NO_FLOCK
                           " ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 " ZEROCOUNT_PROGRAM
                           " run study.yaml -q -o out.h5 & sleep 0.5; kill -KILL $!; wait $!";
  ASSERT_NE(std::system(line.c_str()), 0);
  ASSERT_EQ(owner_files().size(), 1U);
  folder_.write("study.yaml", small_manifest(8));
  const ProgramResult result = program({"run", "study.yaml", "-q", "-o", "out.h5", "--force"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(owner_files().size(), 0U);
}

// Runs on a file system that cannot bring the entries of a folder to the disk, as some network and user-space
// file systems.

ProgramResult run_where_folders_fail_with(int error, const TemporaryFolder& folder) {
  return zerocount_program(
      {"run", "study.yaml", "-o", std::to_string(error) + ".h5"}, folder.path(),
      {std::string("LD_PRELOAD=") + ZEROCOUNT_NO_FOLDER_FSYNC, "FSYNC_ERROR=" + std::to_string(error),
       "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0"});
}

TEST(WithoutFsyncOfFolders, ARunCompletesButADiskFailureIsAnError) {
  const TemporaryFolder folder;
  folder.write("study.yaml", small_manifest(8));
  for (const int missing : {EINVAL, EOPNOTSUPP, ENOSYS}) {
    const ProgramResult result = run_where_folders_fail_with(missing, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(zerocount_program({"summary", std::to_string(missing) + ".h5"}, folder.path()).code, 0);
  }
  const ProgramResult broken = run_where_folders_fail_with(EIO, folder);
  EXPECT_EQ(broken.code, 5);
  EXPECT_TRUE(says(broken.err, "cannot bring its name to the disk"));
}

}  // namespace
}  // namespace zerocount::testing
