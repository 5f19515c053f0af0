// `zerocount slurm` with stand-ins for the commands of Slurm; tests/slurm has a real one.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class SlurmCommand : public ::testing::Test {
 protected:
  SlurmCommand() {
    folder_.write("study.yaml", small_manifest(60));
    fs::create_directory(folder_ / "bin");
    // Gives the jobs 71, 72, …, and writes down what it was asked for.
    stand_in("sbatch",
             "n=$(cat bin/last 2>/dev/null || echo 70); n=$((n + 1)); [ \"$n\" -le \"${LAST_JOB:-99}\" ] || "
             "{ echo 'sbatch: error: Batch job submission failed' >&2; exit 1; }; "
             "echo $n > bin/last; echo \"$*\" >> bin/asked; echo \"$n;cluster\"");
    stand_in("squeue", "cat bin/queue 2>/dev/null; true");
    stand_in("scontrol", "echo \"MaxArraySize            = ${LARGEST:-1001}\"");
  }

  void stand_in(const std::string& name, const std::string& script) const {
    folder_.write("bin/" + name, "#!/bin/bash\ncd \"$(dirname \"$0\")/..\"\n" + script + "\n");
    fs::permissions(folder_ / "bin" / name, fs::perms::owner_all);
  }
  std::vector<std::string> environment(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{fmt::format("PATH={}:{}", (folder_ / "bin").string(), std::getenv("PATH"))};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramResult slurm(std::vector<std::string> words, const std::vector<std::string>& more = {}) const {
    words.insert(words.begin(), {"slurm", "study.yaml", "-o", "out.h5"});
    return zerocount_program(words, folder_.path(), environment(more));
  }
  /// Runs an element of the array job as Slurm would.
  int run_element(int element) const {
    return std::system(fmt::format("cd {} && SLURM_ARRAY_TASK_ID={} SLURM_CPUS_PER_TASK=1 bash "
                                   "out.h5.parts/array.sbatch > element.log 2>&1",
                                   folder_.path().string(), element)
                           .c_str());
  }
  int run_merge() const {
    return std::system(
        fmt::format("cd {} && bash out.h5.parts/merge.sbatch > merge.log 2>&1", folder_.path().string())
            .c_str());
  }
  void expect_refusal(const ProgramResult& result, int code, const std::string& what) const {
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  }

  TemporaryFolder folder_;
};

TEST_F(SlurmCommand, SubmitsAnArrayAndAMergeThatGiveTheDataOfALocalRun) {
  const ProgramResult submitted = slurm({"--tasks", "3"});
  ASSERT_EQ(submitted.code, 0) << submitted.err;
  EXPECT_EQ(submitted.out,
            "submitted: array job of 3 elements 71 (out.h5.parts/array.sbatch)\n"
            "submitted: merge job 72 (out.h5.parts/merge.sbatch)\n"
            "watch:     squeue --jobs=71,72\n"
            "           zerocount status out.h5\n");
  EXPECT_EQ(folder_.read("bin/asked"),
            "--parsable out.h5.parts/array.sbatch\n"
            "--parsable --dependency=afterany:71 out.h5.parts/merge.sbatch\n");
  for (const int element : {2, 0, 1}) EXPECT_EQ(run_element(element), 0) << folder_.read("element.log");
  EXPECT_EQ(run_merge(), 0) << folder_.read("merge.log");
  ASSERT_EQ(zerocount_program({"run", "study.yaml", "-q", "-o", "local.h5"}, folder_.path()).code, 0);
  expect_same_datasets(folder_ / "local.h5", folder_ / "out.h5");
}

TEST_F(SlurmCommand, SubmitsWhatIsMissing) {
  ASSERT_EQ(slurm({"--tasks", "3"}).code, 0);
  ASSERT_EQ(run_element(1), 0);
  EXPECT_NE(slurm({"--tasks", "3"}).out.find("array job of 2 elements"), std::string::npos);
  EXPECT_NE(folder_.read("out.h5.parts/array.sbatch").find("#SBATCH --array=0,2\n"), std::string::npos);
  folder_.write("out.h5.parts/part-2-of-3.h5", "damaged");
  EXPECT_NE(slurm({"--tasks", "3"}).out.find("array job of 3 elements"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "out.h5.parts/part-2-of-3.h5.damaged"));
  for (const int element : {0, 1, 2}) ASSERT_EQ(run_element(element), 0);
  EXPECT_NE(zerocount_program({"status", "out.h5"}, folder_.path()).out.find("not merged: "),
            std::string::npos);
  EXPECT_EQ(slurm({"--tasks", "3"}).out.find("array job"), std::string::npos);
}

TEST_F(SlurmCommand, DoesNotMixPartsOfStudies) {
  ASSERT_EQ(slurm({"--tasks", "2"}).code, 0);
  ASSERT_EQ(run_element(0), 0);
  folder_.write("study.yaml", small_manifest(62));
  EXPECT_NE(run_element(1), 0);
  EXPECT_NE(folder_.read("element.log").find("not the study asked for"), std::string::npos);
  expect_refusal(slurm({"--tasks", "2"}), 2, "trials");
  fs::rename(folder_ / "bin/scontrol", folder_ / "bin/no-scontrol");
  expect_refusal(zerocount_program({"slurm", "study.yaml", "-o", "out.h5", "--tasks", "2", "--force"},
                                   folder_.path(), {"PATH=" + (folder_ / "bin").string()}),
                 5, "Slurm is not installed here");
  fs::rename(folder_ / "bin/no-scontrol", folder_ / "bin/scontrol");
  EXPECT_TRUE(fs::exists(folder_ / "out.h5.parts/part-1-of-2.h5"));
  EXPECT_NE(slurm({"--tasks", "2", "--force"}).out.find("array job of 2 elements"), std::string::npos);
  for (const int element : {0, 1}) ASSERT_EQ(run_element(element), 0) << folder_.read("element.log");
  ASSERT_EQ(run_merge(), 0) << folder_.read("merge.log");
}

TEST_F(SlurmCommand, IsRefusedWhileAJobIsInTheQueue) {
  ASSERT_EQ(slurm({"--tasks", "2"}).code, 0);
  folder_.write("bin/queue", "70\n72\n");
  expect_refusal(slurm({"--tasks", "2"}), 2, "out.h5: job 72 of this output is still in the queue");
}

TEST_F(SlurmCommand, KeepsToOneDivision) {
  ASSERT_EQ(slurm({"--tasks", "2"}).code, 0);
  expect_refusal(slurm({"--tasks", "3"}), 2, "the trials were divided into 2 parts earlier; give --tasks 2");
  expect_refusal(slurm({"--tasks", "3", "--dry-run"}), 2, "divided into 2 parts");
  fs::remove_all(folder_ / "out.h5.parts");
  fs::create_directory(folder_ / "out.h5.shards");
  expect_refusal(slurm({"--tasks", "3"}), 2, "left shards in out.h5.shards");
}

TEST_F(SlurmCommand, SaysWhatIsSubmittedWhereTheRestCannotBe) {
  const ProgramResult result = slurm({"--tasks", "2"}, {"LAST_JOB=71"});
  expect_refusal(
      result, 5,
      "sbatch has failed with exit code 1 (--dry-run shows the scripts): sbatch: error: Batch job");
  EXPECT_EQ(result.out, "submitted: array job of 2 elements 71 (out.h5.parts/array.sbatch)\n");
  folder_.write("bin/queue", "71\n");
  expect_refusal(slurm({"--tasks", "2"}), 2, "job 71 of this output is still in the queue");
}

TEST_F(SlurmCommand, MapsPartsToTheLargestArray) {
  ASSERT_EQ(slurm({"--tasks", "7", "--at-once", "2"}, {"LARGEST=3"}).code, 0);
  const std::string script = folder_.read("out.h5.parts/array.sbatch");
  EXPECT_NE(script.find("#SBATCH --array=0-2%2\n"), std::string::npos) << script;
  for (const int element : {0, 1, 2}) ASSERT_EQ(run_element(element), 0);
  EXPECT_EQ(run_merge(), 0) << folder_.read("merge.log");
  fs::remove(folder_ / "out.h5");
  fs::remove_all(folder_ / "out.h5.parts");
  expect_refusal(slurm({"--tasks", "7"}, {"LARGEST=0"}), 5, "MaxArraySize is 0");
  EXPECT_EQ(slurm({"--tasks", "1"}, {"LARGEST=0"}).code, 0);
}

TEST_F(SlurmCommand, ShowsTheScriptsWithoutAController) {
  stand_in("scontrol",
           "echo 'scontrol: error: DNS' >&2; echo 'scontrol: fatal: no configuration source' >&2; exit 1");
  const ProgramResult shown =
      slurm({"--tasks", "4", "--cpus", "2", "--sbatch=--partition=long", "--dry-run"});
  ASSERT_EQ(shown.code, 0) << shown.err;
  for (const char* line : {"#SBATCH --array=0-3\n", "#SBATCH --cpus-per-task=2\n",
                           "#SBATCH --partition=long\n", "==> out.h5.parts/merge.sbatch <==\n"})
    EXPECT_NE(shown.out.find(line), std::string::npos) << line << shown.out;
  EXPECT_FALSE(fs::exists(folder_ / "out.h5.parts"));
  const ProgramResult refused = slurm({"--tasks", "4"});
  expect_refusal(
      refused, 5,
      "scontrol has failed with exit code 1 (--dry-run shows the scripts): scontrol: error: DNS; ");
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
}

TEST_F(SlurmCommand, LeavesNothingWhereNothingWasSubmitted) {
  expect_refusal(slurm({"--tasks", "2"}, {"LAST_JOB=70"}), 5, "Batch job submission failed");
  EXPECT_FALSE(fs::exists(folder_ / "out.h5.parts"));
  fs::remove(folder_ / "bin/sbatch");
  expect_refusal(zerocount_program({"slurm", "study.yaml", "-o", "out.h5", "--tasks", "1"}, folder_.path(),
                                   {"PATH=" + (folder_ / "bin").string()}),
                 5, "Slurm is not installed here");
  EXPECT_FALSE(fs::exists(folder_ / "out.h5.parts"));
}

TEST_F(SlurmCommand, KeepsWhatWasThereWhereNothingWasSubmitted) {
  fs::create_directory(folder_ / "before");
  folder_.write("before/array.sbatch", "mine");
  fs::create_directory_symlink("before", folder_ / "out.h5.parts");
  expect_refusal(slurm({"--tasks", "2"}, {"LAST_JOB=70"}), 5, "Batch job submission failed");
  EXPECT_TRUE(fs::exists(folder_ / "out.h5.parts/array.sbatch"));
}

TEST_F(SlurmCommand, RefusesWhatTheScriptsCannotHold) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--sbatch=partition=long"}, "'partition=long' is not an option of sbatch"},
      {{"--sbatch=--array=0-3"}, "--array is set by this command"},
      {{"--sbatch=-a5"}, "-a5 is set by this command"},
      {{"--sbatch=--arr=5"}, "--arr is set by this command"},
      {{"--sbatch=--comment=a\nb"}, "is not an option of sbatch"},
      {{"--time", ":::"}, "is not a Slurm time"},
      {{"--time", ""}, "is not a Slurm time"},
      {{"--time", "1 day"}, "is not a Slurm time"},
      {{"--time", "1:2:3:4"}, "is not a Slurm time"},
      {{"--time", "1-2-3"}, "is not a Slurm time"},
      {{"--time", "1:2-3"}, "is not a Slurm time"},
      {{"--time", "-1"}, "is not a Slurm time"},
      {{"--time", "1-"}, "is not a Slurm time"},
      {{"--time", "1:"}, "is not a Slurm time"},
      {{"--cpus", "0"}, "--cpus"},
      {{"--at-once", "0"}, "--at-once"}};
  for (const auto& [words, what] : cases) {
    std::vector<std::string> all{"--tasks", "2"};
    all.insert(all.end(), words.begin(), words.end());
    expect_refusal(slurm(all), 2, what);
  }
  EXPECT_FALSE(fs::exists(folder_ / "out.h5.parts"));
  for (const char* const time : {"1-12:30", "90", "10:00:00", "1-0:00:00"}) {
    EXPECT_EQ(slurm({"--tasks", "2", "--dry-run", "--sbatch=--export=NONE", "--time", time}).code, 0) << time;
  }
  expect_refusal(slurm({"--tasks", "1", "--at-once", "2"}), 2, "--at-once");
  expect_refusal(slurm({"--tasks", "121"}), 2, "cannot be divided into 121 parts");
  expect_refusal(zerocount_program({"slurm", "study.yaml", "-o", "a\\b.h5", "--tasks", "2", "--dry-run"},
                                   folder_.path(), environment()),
                 2, "a path with a backslash");
}

TEST_F(SlurmCommand, RunsAStudyThatStopsItselfAsOneJob) {
  folder_.write("study.yaml", small_manifest(60, "stop: {success_rate_halfwidth: 0.2, max_trials: 600}\n"));
  expect_refusal(slurm({"--tasks", "2"}), 2, "give --tasks 1");
  const ProgramResult submitted = slurm({"--tasks", "1"});
  EXPECT_NE(submitted.out.find("submitted: job 71 (out.h5.parts/run.sbatch)"), std::string::npos)
      << submitted.out << submitted.err;
  EXPECT_EQ(std::system(fmt::format("cd {} && SLURM_CPUS_PER_TASK=1 bash out.h5.parts/run.sbatch",
                                    folder_.path().string())
                            .c_str()),
            0);
  EXPECT_TRUE(fs::exists(folder_ / "out.h5"));
  const ProgramResult status = zerocount_program({"status", "out.h5"}, folder_.path());
  EXPECT_NE(status.out.find("small: complete, "), std::string::npos) << status.out << status.err;
  EXPECT_EQ(status.out.find("parts"), std::string::npos) << status.out;
}

}  // namespace
}  // namespace zerocount::testing
