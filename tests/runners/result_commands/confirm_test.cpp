// `summary --confirm`: the best point again, with new trials.
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class Confirm : public ProgramTest {
 protected:
  nlohmann::json summary_of(const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"summary", file};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(words, 0);
  }
};

TEST_F(Confirm, IsTheRunOfThatPointWithTheStatedSeed) {
  for (const char* rigs : {"", "rigs: 5\n"}) {
    SCOPED_TRACE(rigs);
    folder_.write("study.yaml", small_manifest(20, std::string(rigs) + "retain: {trials: [7]}\n"));
    ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5", "--force"}).code, 0);
    const std::string before = folder_.read("out.h5");
    const nlohmann::json confirmed = summary_of("out.h5", {"--confirm", "300"})["confirmation"];
    EXPECT_EQ(folder_.read("out.h5"), before);
    EXPECT_NE(confirmed["seed"], 1);

    std::vector<std::string> words{
        "run",   "study.yaml", "-o", "new.h5", "--force", "--set", "seed=" + confirmed["seed"].dump(),
        "--set", "trials=300"};
    if (*rigs != '\0') words.insert(words.end(), {"--set", "rigs=300"});
    ASSERT_EQ(program(words).code, 0);
    const nlohmann::json point = summary_of("new.h5")["points"][confirmed["point"].get<std::size_t>()];
    EXPECT_EQ(confirmed["zero_count"], point["zero_count"]);
    EXPECT_EQ(confirmed["success_rate"], point["success_rate"]);
    EXPECT_NEAR(confirmed["success_rate_low"].get<double>(), point["success_rate_low"].get<double>(), 1e-12);
    EXPECT_NEAR(confirmed["success_rate_high"].get<double>(), point["success_rate_high"].get<double>(),
                1e-12);
    EXPECT_EQ(confirmed["one_trial_per_rig"], *rigs != '\0');
  }
}

TEST_F(Confirm, SaysThatTheBoundOfTheFileAllowsForTheChoice) {
  folder_.write("study.yaml", small_manifest(20));
  ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  const ProgramResult result = program({"summary", "out.h5", "--confirm", "100"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out,
                   "best of 2 points: ", "the bound allows for the choice of the point by these trials",
                   "trials:                100\n"));
}

TEST_F(Confirm, IsRefusedWhereItMeansNothing) {
  folder_.write("study.yaml", small_manifest(20));
  ASSERT_EQ(program({"run", "study.yaml", "-o", "out.h5"}).code, 0);
  EXPECT_EQ(program({"summary", "out.h5", "--confirm", "1"}).code, 2);
  EXPECT_EQ(program({"summary", "out.h5", "--confirm", "100", "--format", "csv"}).code, 2);
  EXPECT_EQ(program({"summary", "out.h5", "--plugin", "own.so"}).code, 2);
}

}  // namespace
}  // namespace zerocount::testing
