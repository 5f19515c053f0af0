// Joint draws of several parameters: what the program does with the table that a manifest names.
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

const std::string table_text = "friction.k1,friction.k2\n100,700\n110,650\n120,720\n";

class Samples : public ProgramTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "studies");
    folder_.write("studies/study.yaml",
                  "zerocount: 1\nname: sampled\nseed: 4\ntrials: 60\nrigs: 6\n"
                  "command: {targets: [20], hold: 0.05}\nsamples: posterior.csv\n");
    folder_.write("studies/posterior.csv", table_text);
  }
  ProgramResult run(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", "studies/study.yaml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
};

TEST_F(Samples, AreFoundBesideTheManifest) {
  const ProgramResult check = program({"check", "studies/study.yaml"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_TRUE(says(check.out, "friction.k1, friction.k2: a row of posterior.csv (3 draws) for each rig"));
}

TEST_F(Samples, AreRecordedSoThatTheFileStandsAlone) {
  ASSERT_EQ(run("out.h5").code, 0);
  std::filesystem::remove(folder_ / "studies/posterior.csv");
  EXPECT_EQ(reading::AllTrialsFile(folder_ / "out.h5").header().samples, table_text);
  for (const std::string command : {"summary", "trace"}) {
    const ProgramResult result = program({command, "out.h5"});
    EXPECT_EQ(result.code, 0) << command << result.err;
  }
  const ProgramResult report = program({"report", "out.h5", "-o", "out.html"});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_TRUE(says(folder_.read("out.html"), "a row of posterior.csv (3 draws) for each rig"));
}

TEST_F(Samples, OfAChangedTableAreAnotherStudy) {
  ASSERT_EQ(run("out.h5").code, 0);
  folder_.write("studies/posterior.csv", table_text + "130,710\n");
  ASSERT_EQ(run("other.h5").code, 0);
  EXPECT_NE(run("out.h5").code, 0) << "would replace the results of another study";
  const ProgramResult compare = program({"compare", "out.h5", "other.h5"});
  EXPECT_TRUE(says(compare.out, "samples, SHA-256 of the table"));
}

TEST_F(Samples, GoWithAStudyThatStopsByItself) {
  const ProgramResult stopped =
      run("out.h5", {"--set", "stop={success_rate_halfwidth: 0.3, max_trials: 6000}"});
  EXPECT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_EQ(program({"summary", "out.h5"}).code, 0);
}

TEST_F(Samples, NameTheFileThatIsNotThere) {
  std::filesystem::remove(folder_ / "studies/posterior.csv");
  EXPECT_TRUE(says(refusal({"check", "studies/study.yaml"}),
                   "studies/posterior.csv: no such file; expected a table of samples"));
}

TEST_F(Samples, AreNeverReplacedByAnOutput) {
  EXPECT_EQ(run("studies/posterior.csv", {"--force"}).code, 2);
  EXPECT_EQ(program({"trace", "studies/study.yaml", "-o", "studies/posterior.csv", "--force"}).code, 2);
  EXPECT_EQ(folder_.read("studies/posterior.csv"), table_text);
}

}  // namespace
}  // namespace zerocount::testing
