// Files of a study with a plugin: what is recorded, and what other commands do with them.

#include <csignal>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/plugins/plugin_manifest.hpp"
#include "tests/runners/program.hpp"

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

  /// Replaces the plugin library of the study by this example's library.
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
  EXPECT_TRUE(says(listing, "\ncontroller.parameters.zone "));
}

TEST_F(PluginStudy, ItsLibraryIsNeverReplacedByAnOutput) {
  const std::string library = folder_.read("own.so");
  EXPECT_EQ(run_study({"--force"}, "own.so").code, 2);
  ASSERT_EQ(run_study().code, 0);
  EXPECT_EQ(program({"trace", "out.h5", "--plugin", "own.so", "-o", "own.so", "--force"}).code, 2);
  EXPECT_EQ(folder_.read("own.so"), library);
}

TEST_F(PluginStudy, OtherCommandsWorkWithoutTheLibrary) {
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
  EXPECT_TRUE(says(folder_.read("out.html"), "the controller is the plugin pi 1.0"));
  EXPECT_FALSE(says(program({"plot", "out.h5"}).out, "bode"));  // its transfer function is not known
  const ProgramResult trace = program({"trace", "out.h5"});
  EXPECT_EQ(trace.code, 2);
  EXPECT_TRUE(trace.out.empty());
  EXPECT_TRUE(says(trace.err, "give its path with --plugin"));
  const ProgramResult confirm = program({"summary", "out.h5", "--confirm", "10"});
  EXPECT_EQ(confirm.code, 2);
  EXPECT_TRUE(says(confirm.err, "expected its path with --plugin"));
}

TEST_F(PluginStudy, AReplayNeedsTheSameLibrary) {
  ASSERT_EQ(run_study().code, 0);
  const std::vector<std::string> replay{"trace",   "out.h5", "--point",  "1",
                                        "--trial", "3",      "--plugin", "own.so"};
  EXPECT_EQ(program(replay).code, 0);
  use("pi_cpp");
  const ProgramResult other = program(replay);
  EXPECT_EQ(other.code, 4);
  EXPECT_TRUE(says(other.err, "its trials were run with the plugin pi 1.0 with SHA-256"));
}

TEST_F(PluginStudy, VerifyNeedsTheSameLibraryToRunTrialsAgain) {
  ASSERT_EQ(run_study().code, 0);
  EXPECT_EQ(program({"verify", "out.h5"}).code, 2);
  EXPECT_EQ(program({"verify", "out.h5", "--trials", "0"}).code, 0);
  const ProgramResult result = program({"verify", "out.h5", "--plugin", "own.so"});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_TRUE(says(result.out, "trials run again: 20 of 32"));
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

// The examples are the built-in PI with a conditional integrator, bit for bit.

struct Gains {
  double kp;
  double ki;
  double zone;
};

std::string manifest(const std::string& controller, const std::string& more) {
  return fmt::format("zerocount: 1\nname: law\nseed: 9\ntrials: 24\ncontroller: {}\n{}", controller, more);
}

std::string built_in(const Gains& g) {
  return fmt::format("{{kp: {}, ki: {}, integrator_zone: {}}}", g.kp, g.ki, g.zone);
}

std::string plugin(const std::string& example, const Gains& g) {
  return fmt::format("{{plugin: {}, parameters: {{kp: {}, ki: {}, zone: {}}}}}", example_controller(example),
                     g.kp, g.ki, g.zone);
}

const std::vector<std::string> studies{
    "command: {targets: [{integers: [1, 30]}, 0], hold: 0.2}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, integral: {uniform: [-0.01, 0.01]}}\n",
    "command: {targets: [400, -3], hold: 0.3, profile: {shape: s_curve, velocity_limit: 0.1}}\n"
    "dac: {bits: 8}\nencoder: {fine_errors: {noise: 0.3}}\n",
};

TEST(PluginOfABuiltInLaw, TracesAreBitwiseEqual) {
  std::mt19937_64 random(20020721);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const TemporaryFolder folder;
  for (const std::string& more : studies) {
    for (int i = 0; i < 4; ++i) {
      const Gains gains{1e-3 * uniform(random), 3e-4 * uniform(random),
                        i == 0 ? 1e12 : 25.0 * uniform(random)};
      folder.write("built-in.yaml", manifest(built_in(gains), more));
      const std::string expected =
          zerocount_program({"trace", "built-in.yaml", "--trial", std::to_string(i)}, folder.path()).out;
      ASSERT_GT(expected.size(), 10000u);
      for (const char* example : {"pi_c", "pi_cpp"}) {
        folder.write("plugin.yaml", manifest(plugin(example, gains), more));
        const ProgramResult own =
            zerocount_program({"trace", "plugin.yaml", "--trial", std::to_string(i)}, folder.path());
        EXPECT_EQ(own.code, 0) << own.err;
        EXPECT_TRUE(own.out == expected) << example << " " << built_in(gains);
      }
    }
  }
}

TEST(PluginOfABuiltInLaw, WholeRunsAreBitwiseEqual) {
  const TemporaryFolder folder;
  const Gains gains{4e-4, 9.45e-5, 12};
  folder.write("built-in.yaml", manifest(built_in(gains), studies[0]));
  folder.write("plugin.yaml", manifest(plugin("pi_c", gains), studies[0]));
  EXPECT_EQ(
      zerocount_program({"run", "built-in.yaml", "-o", "a.h5", "--engine", "reference"}, folder.path()).code,
      0);
  EXPECT_EQ(
      zerocount_program({"run", "plugin.yaml", "-o", "b.h5", "--engine", "reference"}, folder.path()).code,
      0);
  const reading::AllTrialsFile a(folder / "a.h5", reading::Require::complete);
  const reading::AllTrialsFile b(folder / "b.h5", reading::Require::complete);
  EXPECT_EQ(b.header().engine, study::Engine::reference);
  for (const char* measure :
       {"outcome", "arrival_time", "final_position", "holding_torque", "jerk_count", "creep"}) {
    const std::vector<double> one = a.measure(measure, a.rows());
    const std::vector<double> other = b.measure(measure, b.rows());
    ASSERT_EQ(one.size(), 48u);
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_TRUE(one[i] == other[i] || (std::isnan(one[i]) && std::isnan(other[i]))) << measure << " " << i;
  }
}

TEST(CrashingPlugin, IsNamed) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(18)));
  const ProgramResult result = zerocount_program({"trace", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 128 + SIGSEGV);
  EXPECT_TRUE(says(result.err, "crashed", faulty_controller(18)));
}

// Controllers of the user's own that cannot be used: each is refused, with its place in the manifest.

struct Fault {
  int number;
  const char* message;
};

class BadPlugin : public ::testing::TestWithParam<Fault> {};

TEST_P(BadPlugin, IsRefused) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(GetParam().number)));
  for (const std::string command : {"check", "trace"}) {
    const ProgramResult result = zerocount_program({command, "study.yaml"}, folder.path());
    EXPECT_EQ(result.code, 2) << command;
    EXPECT_TRUE(says(result.err, "study.yaml:5:22: controller.plugin: ", GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadPlugin,
    ::testing::Values(
        Fault{1, "it is made for version 99 of zerocount/controller.h; expected version 2"},
        Fault{2, "its zerocount_controller has 16 bytes; expected size = sizeof(zerocount_controller)"},
        Fault{3, "it has no name"}, Fault{4, "it lacks a function; expected start and step"},
        Fault{5, "the name of its parameter 0 is 'Gain 1'; expected lower-case letters"},
        Fault{6, "two of its parameters have the name ki"},
        Fault{7, "the range of its parameter ki is from 2 to 1"},
        Fault{8, "the default of its parameter ki is -1; expected a number from 0 to 1"},
        Fault{9, "its state has 1073741824 bytes"}, Fault{10, "has no function zerocount_controller_entry"},
        Fault{11, "zerocount_controller_entry() returned nothing"}));

TEST(BadPlugins, AMissingFileIsRefused) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest("none.so"));
  const ProgramResult result = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(result.err, "controller.plugin: none.so: no such file"));
}

TEST(BadPlugins, AMissingFileIsReportedAtItsKeyAndNotAtSweptParameters) {
  const TemporaryFolder folder;
  folder.write("study.yaml",
               plugin_manifest("none.so") + "sweep: {grid: {controller.parameters.ki: [1.0e-5, 2.0e-5]}}\n");
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_FALSE(says(result.err, "unknown key"));
}

TEST(BadPlugins, AFileThatIsNotALibraryIsRefused) {
  const TemporaryFolder folder;
  folder.write("text.so", "no library");
  folder.write("study.yaml", plugin_manifest("text.so"));
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(result.err, "text.so is not a shared library"));
}

TEST(BadPlugins, ARefusedStartIsReportedWithTheReason) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(16)));
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(result.err, "the controller faulty cannot start: gain and zone do not fit"));
}

// A global integral, one that start resets, and a pointer into the state: the second works as long as trials
// run one after the other, the third as long as the state stays where it is.
TEST(BadPlugins, HiddenStateOfAPluginIsDetected) {
  for (const int fault : {12, 13, 14}) {
    const TemporaryFolder folder;
    folder.write("study.yaml", plugin_manifest(faulty_controller(fault)));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"check", "study.yaml"}, {"run", "study.yaml", "-o", "out.h5"}}) {
      const ProgramResult result = zerocount_program(words, folder.path());
      EXPECT_EQ(result.code, 2) << fault;
      EXPECT_TRUE(says(result.err, "the controller faulty keeps something outside its state"))
          << fault << result.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out.h5"));
  }
}

TEST(BadPlugins, ANonfiniteTorqueEndsTheTrialWithAMessage) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(15)));
  const ProgramResult result = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const ProgramResult summary = zerocount_program({"summary", "out.h5", "--format", "json"}, folder.path());
  const nlohmann::json point = nlohmann::json::parse(summary.out)["points"][0];
  EXPECT_EQ(point["nonfinite"], point["trials"]);
  EXPECT_TRUE(says(zerocount_program({"summary", "out.h5"}, folder.path()).out, "controller failed"));
  const ProgramResult trace = zerocount_program({"trace", "study.yaml"}, folder.path());
  EXPECT_EQ(std::count(trace.out.begin(), trace.out.end(), '\n'), 102);  // the head and samples 0 to 100
  EXPECT_TRUE(says(trace.err, "the controller returned a non-finite torque"));
}

TEST(BadPlugins, TheFloatingPointModeIsRestored) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest("none.so"));
  const auto trace = [&](int fault) {
    return zerocount_program(
               {"trace", "study.yaml", "--set", "controller.plugin=" + faulty_controller(fault)},
               folder.path())
        .out;
  };
  EXPECT_FALSE(trace(0).empty());
  EXPECT_EQ(trace(17), trace(0));
  EXPECT_EQ(zerocount_program({"check", "study.yaml", "--set", "controller.plugin=" + faulty_controller(17)},
                              folder.path())
                .code,
            0);
}

}  // namespace
}  // namespace zerocount::testing
