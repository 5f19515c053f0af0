// Files of a study with a plugin: what is recorded, and what other commands do with them.
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/plugins/plugin_manifest.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class PluginStudy : public ProgramTest {
 protected:
  PluginStudy() {
    use("pi_c");
    folder_.write("study.yaml",
                  "zerocount: 1\nname: own\nseed: 5\ntrials: 16\n"
                  "controller: {plugin: own.so, parameters: {zone: {uniform: [1, 30]}, ki: 9.45e-5}}\n"
                  "command: {targets: [{integers: [1, 30]}], hold: 0.15}\n"
                  "sweep: {grid: {controller.parameters.kp: {linspace: [0, 6.0e-4, 2]}}}\n");
  }

  /// Puts this example in the place of the study's library.
  void use(const std::string& example) {
    fs::copy_file(example_controller(example), folder_ / "own.so", fs::copy_options::overwrite_existing);
  }
  ProgramResult run_study(std::vector<std::string> more = {}, const std::string& output = "out.h5") {
    std::vector<std::string> words{"run", "study.yaml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
};

TEST_F(PluginStudy, ItsParametersAreColumnsAndAxes) {
  ASSERT_EQ(run_study().code, 0);
  const reading::AllTrialsFile file(folder_ / "out.h5", reading::Require::complete);
  EXPECT_EQ(file.axes().front().name, "controller.parameters.kp");
  EXPECT_EQ(file.axes().front().unit, "N m/count");
  std::vector<std::string> names;
  for (const study::InputColumn& column : file.input_columns()) names.push_back(column.name);
  EXPECT_EQ(names, (std::vector<std::string>{"controller.parameters.kp", "controller.parameters.zone",
                                             "command.targets.0"}));
  ASSERT_TRUE(file.header().plugin);
  EXPECT_EQ(file.header().plugin->name, "pi");
  EXPECT_EQ(file.header().plugin->parameters.size(), 3u);
  EXPECT_EQ(file.header().plugin->sha256.size(), 64u);
  const std::string listing = program({"parameters", "--manifest", "study.yaml"}).out;
  EXPECT_NE(listing.find("\ncontroller.parameters.zone "), std::string::npos);
}

TEST_F(PluginStudy, ItsLibraryIsNeverReplacedByAnOutput) {
  const std::string library = folder_.read("own.so");
  EXPECT_EQ(run_study({"--force"}, "own.so").code, 2);
  ASSERT_EQ(run_study().code, 0);
  EXPECT_EQ(program({"trace", "out.h5", "--plugin", "own.so", "-o", "own.so", "--force"}).code, 2);
  EXPECT_EQ(folder_.read("own.so"), library);
}

TEST_F(PluginStudy, OtherCommandsDoWithoutTheLibrary) {
  ASSERT_EQ(run_study().code, 0);
  fs::remove(folder_ / "own.so");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"summary", "out.h5"},
                                                {"report", "out.h5", "-o", "out.html"},
                                                {"export", "out.h5", "-o", "tables"},
                                                {"sensitivity", "out.h5"},
                                                {"compare", "out.h5", "out.h5"}}) {
    const ProgramResult result = program(words);
    EXPECT_TRUE(result.code == 0 || (words[0] == "compare" && result.code == 3)) << words[0] << result.err;
  }
  EXPECT_NE(folder_.read("out.html").find("the controller is the plugin pi 1.0"), std::string::npos);
  EXPECT_EQ(program({"plot", "out.h5"}).out.find("bode"),
            std::string::npos);  // its transfer function is not known
  const ProgramResult trace = program({"trace", "out.h5"});
  EXPECT_EQ(trace.code, 2);
  EXPECT_TRUE(trace.out.empty());
  EXPECT_NE(trace.err.find("give its path with --plugin"), std::string::npos) << trace.err;
  const ProgramResult confirm = program({"summary", "out.h5", "--confirm", "10"});
  EXPECT_EQ(confirm.code, 2);
  EXPECT_NE(confirm.err.find("expected its path with --plugin"), std::string::npos) << confirm.err;
}

TEST_F(PluginStudy, AReplayNeedsTheSameLibrary) {
  ASSERT_EQ(run_study().code, 0);
  const std::vector<std::string> replay{"trace",   "out.h5", "--point",  "1",
                                        "--trial", "3",      "--plugin", "own.so"};
  EXPECT_EQ(program(replay).code, 0);
  use("pi_cpp");
  const ProgramResult other = program(replay);
  EXPECT_EQ(other.code, 4);
  EXPECT_NE(other.err.find("its trials were run with the plugin pi 1.0 with SHA-256"), std::string::npos);
}

TEST_F(PluginStudy, VerifyNeedsTheSameLibraryToRunTrialsAgain) {
  ASSERT_EQ(run_study().code, 0);
  EXPECT_EQ(program({"verify", "out.h5"}).code, 2);
  EXPECT_EQ(program({"verify", "out.h5", "--trials", "0"}).code, 0);
  const ProgramResult result = program({"verify", "out.h5", "--plugin", "own.so"});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("trials run again: 20 of 32"), std::string::npos) << result.out;
  use("pi_cpp");
  EXPECT_EQ(program({"verify", "out.h5", "--plugin", "own.so"}).code, 4);
}

TEST_F(PluginStudy, ResumingWithAnotherLibraryIsRefused) {
  ASSERT_EQ(run_study().code, 0);
  EXPECT_EQ(run_study().code, 0);  // complete already
  use("pi_cpp");
  EXPECT_EQ(run_study().code, 4);
  EXPECT_EQ(run_study({"--set", "trials=32"}).code, 4);
  EXPECT_EQ(run_study({"--force"}).code, 0);
}

TEST_F(PluginStudy, UnfinishedRunsAreNotContinuedWithAnotherLibrary) {
  ASSERT_EQ(run_study({"--shard", "1/2"}, "part.h5").code, 0);
  fs::create_directory(folder_ / "out.h5.shards");
  fs::rename(folder_ / "part.h5", folder_ / "out.h5.shards/trials-0.h5");
  use("pi_cpp");
  const ProgramResult other = run_study();
  EXPECT_EQ(other.code, 4) << other.err;
  use("pi_c");
  EXPECT_EQ(run_study().code, 0);
}

TEST_F(PluginStudy, PartsOfDifferentLibrariesAreNotMerged) {
  ASSERT_EQ(run_study({"--shard", "1/2"}, "a.h5").code, 0);
  use("pi_cpp");
  ASSERT_EQ(run_study({"--shard", "2/2"}, "b.h5").code, 0);
  EXPECT_EQ(program({"merge", "a.h5", "b.h5", "-o", "all.h5"}).code, 4);
  use("pi_c");
  ASSERT_EQ(run_study({"--shard", "2/2"}, "c.h5").code, 0);
  EXPECT_EQ(program({"merge", "a.h5", "c.h5", "-o", "all.h5"}).code, 0);
}

TEST_F(PluginStudy, RunsOnEitherEngine) {
  for (const char* engine : {"batch", "reference"}) {
    const ProgramResult result = run_study({"--engine", engine, "--force"});
    EXPECT_EQ(result.code, 0) << result.err;
  }
}

}  // namespace
}  // namespace zerocount::testing
