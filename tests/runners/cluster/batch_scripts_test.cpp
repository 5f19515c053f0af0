#include "runners/cluster/batch_scripts.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "results/shards/pieces.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// A program that writes its arguments, and the parts of which it makes.
cluster::BatchRequest request_of(const TemporaryFolder& folder, cluster::ArrayJob job) {
  folder.write("program", "#!/bin/bash\nprintf '%s\\n' \"$*\" >> called\n");
  fs::permissions(folder / "program", fs::perms::owner_all);
  return {.name = "an axis",
          .study_sha256 = "abc",
          .program = folder / "program",
          .folder = folder.path(),
          .manifest = "my study.yaml",
          .overrides = {"friction.k1={normal: {mean: 1, sd: 2}}"},
          .output = "out.h5",
          .job = job,
          .elements = {0, 1},
          .at_once = {},
          .cpus = 3,
          .time = "10:00",
          .sbatch_options = {"--partition=long"}};
}

void run_script(const TemporaryFolder& folder, const std::string& script, const std::string& variables) {
  folder.write("script", script);
  ASSERT_EQ(std::system((variables + " bash " + (folder / "script").string()).c_str()), 0);
}

TEST(ArrayScript, RunsEveryPartOfItsElement) {
  const TemporaryFolder folder;
  const cluster::BatchRequest request = request_of(folder, {12, 5});
  const std::string script = cluster::array_script(request);
  for (const char* line :
       {"#SBATCH --job-name=zerocount-an-axis\n", "#SBATCH --array=0-1\n", "#SBATCH --cpus-per-task=3\n",
        "#SBATCH --time=10:00\n", "#SBATCH --partition=long\n"})
    EXPECT_NE(script.find(line), std::string::npos) << line << script;
  run_script(folder, script, "SLURM_ARRAY_TASK_ID=1 SLURM_CPUS_PER_TASK=3");
  const std::string common =
      "run my study.yaml --set friction.k1={normal: {mean: 1, sd: 2}} --study abc --shard ";
  const std::string more = "/12 --threads 3 --quiet --output out.h5.parts/part-";
  EXPECT_EQ(folder.read("called"), common + "2" + more + "02-of-12.h5\n" + common + "7" + more +
                                       "07-of-12.h5\n" + common + "12" + more + "12-of-12.h5\n");
  EXPECT_EQ(shards::part_of("out.h5", 7, 12).path, "out.h5.parts/part-07-of-12.h5");
}

TEST(ArrayScript, EndsWithTheRunThatIsInterrupted) {
  const TemporaryFolder folder;
  const std::string script = cluster::array_script(request_of(folder, {12, 5}));
  folder.write("program", "#!/bin/bash\necho x >> called\nexit 130\n");
  fs::permissions(folder / "program", fs::perms::owner_all);
  folder.write("script", script);
  const std::string line = "SLURM_ARRAY_TASK_ID=1 SLURM_CPUS_PER_TASK=3 bash " + (folder / "script").string();
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 130);
  EXPECT_EQ(folder.read("called"), "x\n");
}

// Folders and outputs have no control characters, which the command refuses; manifests and overrides may.
TEST(Scripts, PassEveryNameAsItIs) {
  constexpr std::string_view of_names = "ab'\" $`*;&|<>()#!~%-\xc3\xa9";
  std::mt19937 random(81);
  const auto some = [&](std::string_view more = "") {
    const std::string characters = std::string(of_names) + std::string(more);
    std::string word = "-";
    for (int i = 0; i < 12; ++i) word += characters[random() % characters.size()];
    return word;
  };
  for (int repetition = 0; repetition < 10; ++repetition) {
    const TemporaryFolder folder;
    cluster::BatchRequest request = request_of(folder, {2, 1});
    const fs::path place = folder / some();
    fs::create_directory(place);
    folder.write("program", "#!/bin/bash\nprintf '%s\\0' \"$@\" >> called\n");
    request.folder = place;
    request.program = folder / some();
    fs::rename(folder / "program", request.program);
    request.manifest = some("\\\n\t");
    request.overrides = {some("\\\n\t"), some("\\\n\t")};
    request.output = some() + ".h5";
    const std::string output = "./" + request.output.string();
    const auto called = [&](const std::string& script) {
      folder.write("script", script);
      const std::string command = "SLURM_ARRAY_TASK_ID=1 bash " + (folder / "script").string();
      EXPECT_EQ(std::system(command.c_str()), 0) << script;
      const std::string words = read_bytes(place / "called");
      fs::remove(place / "called");
      return words;
    };
    const auto words = [](const std::vector<std::string>& all) {
      std::string text;
      for (const std::string& one : all) text += one + '\0';
      return text;
    };
    const std::vector<std::string> run{"run",   "./" + request.manifest, "--set",   request.overrides[0],
                                       "--set", request.overrides[1],    "--study", "abc"};
    const auto after_run = [&](std::vector<std::string> more) {
      more.insert(more.begin(), run.begin(), run.end());
      return words(more);
    };
    EXPECT_TRUE(called(cluster::single_script(request)) ==
                after_run({"--threads", "1", "--quiet", "--output", output}));
    EXPECT_TRUE(called(cluster::array_script(request)) ==
                after_run({"--shard", "2/2", "--threads", "1", "--quiet", "--output",
                           output + ".parts/part-2-of-2.h5"}));
    EXPECT_TRUE(called(cluster::merge_script(request)) ==
                words({"merge", output + ".parts", "--output", output}));
  }
}

TEST(SbatchPath, IsReadAsOneWordWithoutReplacements) {
  EXPECT_EQ(cluster::sbatch_path("/a b%a/\"c\""), "\"/a b%%a/\\\"c\\\"\"");
}

TEST(MergeScript, MergesTheFolderOfTheParts) {
  const TemporaryFolder folder;
  run_script(folder, cluster::merge_script(request_of(folder, {12, 5})), "");
  EXPECT_EQ(folder.read("called"), "merge out.h5.parts --output out.h5\n");
}

TEST(SingleScript, RunsTheWholeStudy) {
  const TemporaryFolder folder;
  run_script(folder, cluster::single_script(request_of(folder, {1, 1})), "SLURM_CPUS_PER_TASK=3");
  EXPECT_EQ(folder.read("called"),
            "run my study.yaml --set friction.k1={normal: {mean: 1, sd: 2}} --study abc --threads 3 --quiet "
            "--output out.h5\n");
}

}  // namespace
}  // namespace zerocount::testing
