// Where commands read and write: one rule for what exists already, "-" for the standard streams, names that
// tell the kind of a file.

#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// A command that writes the file `output`.
struct Writing {
  std::string output;
  std::vector<std::string> arguments;
};

class Places : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("study.yaml", small_manifest(40));
    ASSERT_EQ(program({"run", "study.yaml", "-o", "all.h5"}).code, 0);
    for (const char* part : {"1", "2"}) {
      ASSERT_EQ(program({"run", "study.yaml", "-o", std::string("part") + part + ".h5", "--shard",
                         std::string(part) + "/2"})
                    .code,
                0);
    }
    folder_.write(
        "levels.yaml",
        "zerocount: 1\nname: levels\ntrials: 1\ncommand: {torque_levels: [0.001, 0.002], hold: 0.2}\n");
  }

  ProgramResult program(const std::vector<std::string>& arguments) {
    return zerocount_program(arguments, folder_.path());
  }

  /// Exit code of a line that the shell runs in the test's folder; $Z in it is the program.
  int shell(const std::string& line) {
    const std::string command =
        fmt::format("cd {} && Z={} && {} 2> err", folder_.path().string(), ZEROCOUNT_PROGRAM, line);
    return WEXITSTATUS(std::system(command.c_str()));
  }

  fs::path at(const std::string& name) const { return folder_.path() / name; }

  TemporaryFolder folder_;
};

TEST_F(Places, ExistingFilesAreReplacedOnlyWithForce) {
  const std::vector<Writing> writing{
      {"run.h5", {"run", "study.yaml", "-o", "run.h5"}},
      {"merged.h5", {"merge", "part1.h5", "part2.h5", "-o", "merged.h5"}},
      {"tables/trials.csv", {"export", "all.h5", "-o", "tables"}},
      {"report.html", {"report", "all.h5", "-o", "report.html"}},
      {"success.svg", {"plot", "all.h5", "--figure", "success", "-o", "success.svg"}},
      {"trace.csv", {"trace", "all.h5", "-o", "trace.csv"}},
      {"gate.json", {"compare", "all.h5", "all.h5", "--json", "gate.json"}},
      {"gate.xml", {"compare", "all.h5", "all.h5", "--junit", "gate.xml"}},
      {"gate.md", {"compare", "all.h5", "all.h5", "--markdown", "gate.md"}}};
  for (const Writing& command : writing) {
    SCOPED_TRACE(command.arguments[0] + " to " + command.output);
    if (command.arguments[0] == "export") fs::create_directory(at("tables"));
    folder_.write(command.output, "my notes");
    const ProgramResult refused = program(command.arguments);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_TRUE(says(refused.err, "--force"));
    EXPECT_EQ(folder_.read(command.output), "my notes");

    std::vector<std::string> forced = command.arguments;
    forced.emplace_back("--force");
    const ProgramResult replaced = program(forced);
    EXPECT_EQ(replaced.code, 0) << replaced.err;
    EXPECT_NE(folder_.read(command.output), "my notes");

    const ProgramResult help = program({command.arguments[0], "--help"});
    EXPECT_TRUE(says(help.out, "is replaced only with --force"));
  }
}

// A report of an earlier command that says "passed" would be read as the answer of one that failed.
TEST_F(Places, AFailureLeavesNoEarlierAnswer) {
  folder_.write("damaged.h5", folder_.read("all.h5").substr(0, 5000));
  const std::vector<Writing> failing{
      {"gate.json", {"compare", "all.h5", "damaged.h5", "--json", "gate.json"}},
      {"gate.xml", {"compare", "all.h5", "damaged.h5", "--junit", "gate.xml"}},
      {"gate.md", {"compare", "all.h5", "none.h5", "--markdown", "gate.md"}},
      {"report.html", {"report", "damaged.h5", "-o", "report.html"}},
      {"trace.csv", {"trace", "damaged.h5", "-o", "trace.csv"}},
      {"trace.csv", {"trace", "all.h5", "--trial", "1000000", "-o", "trace.csv"}},
      {"success.svg", {"plot", "damaged.h5", "--figure", "success", "-o", "success.svg"}}};
  for (Writing command : failing) {
    SCOPED_TRACE(::testing::PrintToString(command.arguments));
    folder_.write(command.output, "passed");
    EXPECT_NE(program(command.arguments).code, 0);
    EXPECT_EQ(folder_.read(command.output), "passed") << "without --force";
    command.arguments.emplace_back("--force");
    EXPECT_NE(program(command.arguments).code, 0);
    EXPECT_FALSE(fs::exists(at(command.output)));
  }
  const std::string before = folder_.read("all.h5");
  fs::copy_file(at("all.h5"), at("merged.h5"));
  EXPECT_NE(program({"merge", "part1.h5", "damaged.h5", "-o", "merged.h5", "--force"}).code, 0);
  EXPECT_EQ(folder_.read("merged.h5"), before) << "results are kept until there are new ones";
  folder_.write("mine.yaml", "my manifest");
  EXPECT_NE(program({"new", "no-such-study", "-o", "mine.yaml", "--force"}).code, 0);
  EXPECT_EQ(folder_.read("mine.yaml"), "my manifest") << "a typing error costs nobody a manifest";
}

TEST_F(Places, AnInputIsNeverReplaced) {
  folder_.write("gate.yaml", "confidence: 0.9\n");
  fs::copy_file(at("all.h5"), at("other.h5"));
  const std::string before = folder_.read("all.h5");
  std::vector<std::vector<std::string>> writing{
      {"trace", "study.yaml", "-o", "study.yaml"},
      {"merge", "part1.h5", "part2.h5", "-o", "part1.h5"},
      {"run", "study.yaml", "-o", "./study.yaml"},
      {"compare", "all.h5", "all.h5", "--json", "r", "--junit", "./r"}};
  for (const char* const output : {"all.h5", "other.h5", "/dev/null"})
    writing.push_back({"report", "all.h5", "--baseline", "other.h5", "-o", output});
  for (const char* const option : {"--json", "--junit", "--markdown"})
    for (const char* const output : {"all.h5", "gate.yaml", "/dev/null"})
      writing.push_back({"compare", "all.h5", "all.h5", "--margins", "gate.yaml", option, output});
  for (std::vector<std::string>& words : writing) {
    words.emplace_back("--force");
    EXPECT_EQ(program(words).code, 2) << ::testing::PrintToString(words);
  }
  EXPECT_TRUE(says(program({"compare", "all.h5", "all.h5", "--json", "all.h5"}).err, "all.h5 is an input"));
  EXPECT_EQ(folder_.read("study.yaml"), small_manifest(40));
  EXPECT_EQ(folder_.read("gate.yaml"), "confidence: 0.9\n");
  EXPECT_EQ(folder_.read("all.h5"), before);
  EXPECT_EQ(folder_.read("other.h5"), before);
}

TEST_F(Places, ADashIsTheStandardInput) {
  EXPECT_EQ(shell("$Z run - -q -o piped.h5 < study.yaml"), 0) << folder_.read("err");
  EXPECT_EQ(stored_datasets(at("piped.h5")), stored_datasets(at("all.h5")));
  EXPECT_EQ(shell("$Z check - < study.yaml > checked && grep -q '80 trials\\|40 trials' checked"), 0)
      << folder_.read("err");
  EXPECT_EQ(
      shell("$Z trace - --trial 3 < study.yaml > piped.csv && $Z trace all.h5 --trial 3 | cmp - piped.csv"),
      0)
      << folder_.read("err");
  EXPECT_EQ(shell("echo 'margins: {success_rate: 0.2}' | $Z compare all.h5 all.h5 --margins - > gate.txt"), 0)
      << folder_.read("err");
  EXPECT_EQ(shell("printf 'zerocount: 1\\nname: broken\\nseeds: 3\\n' | $Z check -"), 2);
  EXPECT_TRUE(says(folder_.read("err"), "<stdin>:3")) << folder_.read("err");
}

TEST_F(Places, ADashIsTheStandardOutput) {
  EXPECT_TRUE(program({"report", "all.h5", "-o", "-"}).out.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(program({"plot", "all.h5", "--figure", "success", "-o", "-"}).out.starts_with("<svg"));
  EXPECT_EQ(program({"trace", "all.h5", "-o", "-"}).out, program({"trace", "all.h5"}).out);
  const std::string json = program({"compare", "all.h5", "all.h5", "--json", "-"}).out;
  EXPECT_TRUE(nlohmann::json::accept(json)) << json;
  EXPECT_EQ(program({"run", "study.yaml", "-o", "-"}).code, 2);
}

// `script` gives the program a terminal. The character turns the direction of the text after it.
TEST_F(Places, DataForATerminalHaveNoControlCharacters) {
  const std::string turned = "\u202e";
  fs::copy_file(at("all.h5"), at("a" + turned + "b.h5"));
  const std::string verify = fmt::format("$Z verify --format json a{}b.h5", turned);
  EXPECT_EQ(shell(verify + " > piped"), 0) << folder_.read("err");
  EXPECT_TRUE(says(folder_.read("piped"), turned));
  EXPECT_EQ(shell(fmt::format("export Z && script -qec '{}' typescript < /dev/null > shown", verify)), 0);
  EXPECT_FALSE(says(folder_.read("shown"), turned));
  EXPECT_TRUE(says(folder_.read("shown"), "a\ufffdb.h5")) << folder_.read("shown");
}

TEST_F(Places, APipeIsReadLikeAFile) {
  for (const char* line :
       {"run <(cat study.yaml) -q -o piped.h5", "trace <(cat study.yaml) --trial 3 -o piped.csv",
        "trace all.h5 --trial 3 -o file.csv", "check <(cat study.yaml)",
        "compare all.h5 all.h5 --margins <(echo margins: {success_rate: 0.2})"}) {
    EXPECT_EQ(shell(fmt::format("export Z && timeout 60 bash -c '$Z {} > out'", line)), 0)
        << line << ": " << folder_.read("err");
  }
  EXPECT_EQ(stored_datasets(at("piped.h5")), stored_datasets(at("all.h5")));
  EXPECT_EQ(folder_.read("piped.csv"), folder_.read("file.csv"));
}

// The system's `timeout` ends a program that waits for the other end with exit code 124.
TEST_F(Places, APipeAsOutputIsRefusedImmediately) {
  ASSERT_EQ(shell("mkfifo pipe.h5 pipe.csv pipe.svg new.h5.part new.h5.lock new.csv.part"), 0);
  for (const char* line :
       {"summary pipe.h5", "merge pipe.h5 -o other.h5", "trace pipe.h5",
        "identify pipe.h5 --column angle=/angle", "compare pipe.h5 all.h5", "history add pipe.h5",
        "trace all.h5 -o pipe.csv --force", "plot all.h5 --figure success -o pipe.svg --force",
        "run study.yaml -o pipe.h5 --force", "verify pipe.h5"}) {
    EXPECT_EQ(shell(fmt::format("timeout 20 $Z {}", line)), 2) << line << ": " << folder_.read("err");
    EXPECT_TRUE(says(folder_.read("err"), "regular file")) << folder_.read("err");
  }
  for (const char* line : {"run study.yaml -q -o new.h5", "trace all.h5 -o new.csv"}) {
    EXPECT_EQ(shell(fmt::format("timeout 20 $Z {}", line)), 5) << line << ": " << folder_.read("err");
    EXPECT_TRUE(says(folder_.read("err"), "regular file")) << folder_.read("err");
  }
  EXPECT_TRUE(fs::is_fifo(at("new.h5.part")) && fs::is_fifo(at("new.h5.lock")) &&
              fs::is_fifo(at("new.csv.part")));
}

// Where a parent ignores the ends of its children, so do they, unless they say otherwise.
TEST_F(Places, AFileIsReadEvenIfSigchldIsIgnored) {
  EXPECT_EQ(shell("env --ignore-signal=CHLD $Z summary all.h5 > summary.txt"), 0) << folder_.read("err");
}

TEST_F(Places, ALinkAtATemporaryNameIsNotFollowed) {
  folder_.write("notes", "my notes");
  for (const char* link : {"new.h5.lock", "merged.h5.part", "new.csv.part"})
    fs::create_symlink(at("notes"), at(link));
  for (const char* line :
       {"run study.yaml -q -o new.h5", "merge part1.h5 part2.h5 -o merged.h5", "trace all.h5 -o new.csv"}) {
    EXPECT_EQ(shell(fmt::format("$Z {}", line)), 5) << line << ": " << folder_.read("err");
    EXPECT_TRUE(says(folder_.read("err"), "regular file")) << folder_.read("err");
  }
  EXPECT_EQ(folder_.read("notes"), "my notes");
  for (const char* link : {"new.h5.lock", "merged.h5.part", "new.csv.part"})
    EXPECT_TRUE(fs::is_symlink(at(link))) << link;
}

TEST_F(Places, ALinkIsRefusedAsOutput) {
  folder_.write("notes", "my notes");
  for (const char* name : {"link.h5", "link.csv", "link.html"}) fs::create_symlink(at("notes"), at(name));
  for (const char* line :
       {"run study.yaml -q -o link.h5 --force", "merge part1.h5 part2.h5 -o link.h5 --force",
        "trace all.h5 -o link.csv --force", "report all.h5 -o link.html --force"}) {
    EXPECT_EQ(shell(fmt::format("$Z {}", line)), 2) << line << ": " << folder_.read("err");
    EXPECT_TRUE(says(folder_.read("err"), "regular file (a link)")) << folder_.read("err");
  }
  EXPECT_EQ(folder_.read("notes"), "my notes");
  for (const char* name : {"link.h5", "link.csv", "link.html"}) EXPECT_TRUE(fs::is_symlink(at(name))) << name;
}

TEST_F(Places, TheExtensionOfAnOutputMustMatchItsContents) {
  for (const char* name : {"report.pdf", "report", "report.svg"}) {
    const ProgramResult result = program({"report", "all.h5", "-o", name});
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_TRUE(says(result.err, ".html"));
    EXPECT_FALSE(fs::exists(at(name)));
  }
  const ProgramResult plotted = program({"plot", "all.h5", "--figure", "success", "-o", "success.pdf"});
  EXPECT_EQ(plotted.code, 2);
  EXPECT_TRUE(says(plotted.err, ".svg"));
}

TEST_F(Places, APointIsNamedByItsLabelOrItsNumber) {
  const std::string by_number = program({"trace", "all.h5", "--point", "1", "--trial", "2"}).out;
  EXPECT_EQ(program({"trace", "all.h5", "--point", "high", "--trial", "2"}).out, by_number);
  EXPECT_EQ(program({"trace", "study.yaml", "--point", "high", "--trial", "2"}).out, by_number);
  EXPECT_NE(program({"trace", "all.h5", "--point", "low", "--trial", "2"}).out, by_number);
  EXPECT_EQ(program({"jerks", "all.h5", "--point", "high"}).out,
            program({"jerks", "all.h5", "--point", "1"}).out);
  const ProgramResult wrong = program({"trace", "all.h5", "--point", "hihg"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(says(wrong.err, "'high'"));
  EXPECT_EQ(program({"trace", "all.h5", "--point", "2"}).code, 2);
}

TEST_F(Places, TheVersionHasAShortOption) {
  const ProgramResult result = program({"-V"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, program({"--version"}).out);
  EXPECT_TRUE(says(result.out, "zerocount"));
}

}  // namespace
}  // namespace zerocount::testing
