// Names of earlier versions are refused with what they are called now, wherever a user may write them.
#include "tests/runners/program.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount::testing {
namespace {

class OldNames : public ProgramTest {
 protected:
  void SetUp() override {
    folder_.write("a.yaml", small_manifest(30));
    ASSERT_EQ(program({"run", "a.yaml", "-o", "a.h5", "--quiet"}).code, 0);
  }

  /// Expects that the command ends with exit code 2, and that its message contains each of these parts.
  void expect_refused(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 2) << words[0] << result.err;
    for (const std::string& part : parts) EXPECT_TRUE(says(result.err, part)) << words[0] << result.err;
  }
};

const std::vector<std::string> both_meanings{"arrival_time", "final_settling_time"};

TEST_F(OldNames, TheOldKeyForMachinesIsRefusedWithTheNewName) {
  const MarkedText old = marked_text(small_manifest(30, "«rigs»: 10\n"));
  folder_.write("old.yaml", old.text);
  EXPECT_TRUE(says(with_marks(refusal({"check", "old.yaml"}), "old.yaml", old),
                   "old.yaml:«»: rigs: it is called machines since 0.2"));
  expect_refused({"check", "a.yaml", "--set", "rigs=10"}, {"rigs: it is called machines since 0.2"});
  folder_.write(
      "old.yaml",
      small_manifest(30, "machines: 10\nplant: {inertia: {uniform: [5.0e-4, 6.0e-4], per: rig}}\n"));
  expect_refused({"check", "old.yaml"},
                 {"plant.inertia.per: it is called machine since 0.2; expected machine"});
}

// The bare name would be taken for the measure of another meaning.
TEST_F(OldNames, SettlingTimeIsRefusedWithBothMeanings) {
  expect_refused({"rare", "a.yaml", "-o", "rare.h5", "--point", "0", "--event", "settling_time > 0.1"},
                 both_meanings);
  expect_refused({"sensitivity", "a.h5", "--output", "settling_time"}, both_meanings);
  expect_refused({"summary", "a.h5", "--sort", "settling_time.p95"}, both_meanings);
  expect_refused({"summary", "a.h5", "--where", "settling_time_median < 1"}, both_meanings);
  expect_refused({"plan", "--margin", "settling_time=5%", "a.yaml"}, both_meanings);
  expect_refused(
      {"check", "a.yaml", "--set", "goal={band: 1, within: 0.1, moves: 0.9, limits: {settling_time: 1}}"},
      both_meanings);
  for (const char* const rules : {"measures: [settling_time]", "margins: {settling_time: 1.0e-3}",
                                  "require: settling_time.p95 ≤ 0.1"}) {
    folder_.write("margins.yaml", std::string(rules) + "\n");
    expect_refused({"compare", "a.h5", "a.h5", "--margins", "margins.yaml"}, both_meanings);
  }
  folder_.write("log.csv", "settling_time [ms]\n" + std::string("40\n41\n"));
  expect_refused({"monitor", "a.h5", "log.csv", "--point", "0"}, both_meanings);
  folder_.write(
      "tune.yaml",
      small_manifest(30,
                     "goal: {band: 1, within: 0.1, moves: 0.9}\n"
                     "tune: {free: {controller.kp: [0, 1.0e-3]}, minimise: settling_time.median}\n"));
  expect_refused(
      {"tune", "tune.yaml", "-o", "tuned.h5", "--set", "sweep={cases: {low: {controller.ki: 3.85e-5}}}"},
      both_meanings);
}

}  // namespace
}  // namespace zerocount::testing
