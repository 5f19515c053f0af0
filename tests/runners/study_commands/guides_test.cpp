// From the name of a guide to the results of a study of it.
#include <nlohmann/json.hpp>

#include "experiments/guides/guide_table.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class NewGuide : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder.path());
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& message) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 2) << message;
    EXPECT_TRUE(says(result.err, message));
  }

  TemporaryFolder folder;
};

TEST_F(NewGuide, EachIsAStudyThatChecksAndRunsAndStaysWithinOneCount) {
  for (const guides::Guide& guide : guides::guide_table()) {
    const std::string name(guide.name);
    ASSERT_EQ(run({"new", "--guide", name}).code, 0) << name;
    const ProgramResult check = run({"check", name + ".yaml"});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(check.err, "");
    ASSERT_EQ(run({"run", name + ".yaml", "-o", name + ".h5", "--set", "trials=100"}).code, 0) << name;
    const auto point =
        nlohmann::json::parse(run({"summary", name + ".h5", "--format", "json"}).out)["points"][0];
    EXPECT_EQ(point["nonfinite"], 0) << name;
    // The air bearing hunts by one count.
    EXPECT_EQ(point["bands"][1]["band"], 1) << point.dump(2);
    EXPECT_TRUE(point["bands"][1]["settling_time"]["p95"].is_number()) << name << "\n" << point.dump(2);
  }
}

TEST_F(NewGuide, ScalesItWithTheLoad) {
  const ProgramResult usual = run({"new", "--guide", "ball-rail", "-o", "-"});
  const ProgramResult more = run(
      {"new", "--guide", "ball-rail", "--preload", "800", "--mass", "12", "--resolution", "1e-9", "-o", "-"});
  EXPECT_NE(usual.out, more.out);
  for (const char* part : {"preload of 800 N", "inertia: 12 ", "resolution: 1e-09"})
    EXPECT_TRUE(says(more.out, part)) << part << "\n" << more.out;
}

TEST_F(NewGuide, StartsFromAMeasuredSpring) {
  const std::vector<std::string> words{"new",        "--guide",  "crossed-roller", "--breakaway",
                                       "4",          "--travel", "10e-6",          "--secant",
                                       "1.5e6@2e-6", "-o",       "axis.yaml"};
  ASSERT_EQ(run(words).code, 0);
  const ProgramResult check = run({"check", "axis.yaml"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(run({"run", "axis.yaml", "-o", "axis.h5", "--set", "trials=50"}).code, 0);
  expect_refused({"new", "--guide", "crossed-roller", "--breakaway", "4"},
                 "'--travel' is missing; a measured spring has --breakaway, --travel and --secant");
  const auto with_secant = [&](const std::string& secant, const std::string& guide = "crossed-roller") {
    return std::vector<std::string>{"new",      "--guide", guide,      "--breakaway", "4",
                                    "--travel", "10e-6",   "--secant", secant};
  };
  expect_refused(with_secant("1.5e6"), "expected N/m@m");
  expect_refused(with_secant("1.5e6@2e-5"), "travel of 2e-05 is not below the travel up to breakaway, 1e-05");
  expect_refused(with_secant("2.5e6@2e-6"), "carries 5, which is not below the breakaway of 4");
  expect_refused(with_secant("3e5@2e-6"), "300000 is not above breakaway over travel, 4/1e-05 = 400000");
  expect_refused(with_secant("1.5e6@2e-6", "air-bearing"), "'--breakaway' has no effect on air-bearing");
}

TEST_F(NewGuide, IsListed) {
  const std::string list = run({"new", "--list"}).out;
  for (const guides::Guide& guide : guides::guide_table())
    EXPECT_TRUE(says(list, "\n" + std::string(guide.name) + " "));
}

TEST_F(NewGuide, RefusesWhatItDoesNotKnow) {
  std::string names;
  for (const guides::Guide& guide : guides::guide_table())
    names += (names.empty() ? "" : ", ") + std::string(guide.name);
  expect_refused({"new", "--guide", "bal-rail"}, "'bal-rail' is not one of " + names);
  expect_refused({"new", "--guide"}, "option '--guide' needs a value, one of " + names);
  expect_refused({"new", "paper-gains", "--guide", "plain"}, "expected either the name of a manifest");
  expect_refused({"new", "paper-gains", "--mass", "5"}, "option '--mass' needs '--guide'");
  expect_refused({"new", "--guide", "air-bearing", "--preload", "5"}, "has no effect on air-bearing");
  expect_refused({"new", "--guide", "rotary-ball", "--mass", "5"}, "has no effect on rotary-ball");
  expect_refused({"new", "--guide", "plain", "--mass", "-5"}, "expected a number above 0");
  expect_refused({"parameters", "--guides", "--axis", "linear"},
                 "options '--axis' and '--guides' exclude each other");
}

}  // namespace
}  // namespace zerocount::testing
