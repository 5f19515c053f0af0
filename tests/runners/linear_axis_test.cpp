// A linear axis from the manifest to every place in which its user sees a unit.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* stage =
    "zerocount: 1\nname: stage\naxis: linear\ntravel: 0.1\nseed: 1\ntrials: 8\n"
    "plant: {inertia: 5, presliding_damping: 1500, sliding_damping: 50}\n"
    "friction: {k1: {profile: {mean: 1.0e+5, cv: 0.1, correlation_length: 0.01}}, k2: 2.0e+7, beta: 2.0e+6,\n"
    "           lambda: 1.0e+8, breakaway: 12, stribeck_velocity: 1.0e-3}\n"
    "encoder: {resolution: 1.0e-9}\n"
    "dac: {bits: 20, resolution: 5.0e-5}\n"
    "controller: {units: si, sample_rate: 10000, kp: 1.0e+7, ki: 1.5e+9}\n"
    "initial: {position: {uniform: [0, 0.1]}}\n"
    "command: {targets: [10], hold: 0.2}\n"
    "retain: {trials: [0]}\n"
    "sweep: {grid: {controller.ki: [1.5e+9, 3.0e+9]}}\n";

class LinearAxis : public ::testing::Test {
 protected:
  LinearAxis() { folder.write("stage.yaml", stage); }
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder.path());
  }
  std::string first_line(const std::string& file) const {
    std::ifstream in(folder / file);
    std::string line;
    std::getline(in, line);
    return line;
  }

  TemporaryFolder folder;
};

void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(LinearAxis, IsCheckedInItsOwnUnits) {
  const ProgramResult result = run({"check", "stage.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  expect_parts(result.out, {"1.5e+09 N/(m s)", "N, must be below k1·Δx = ", "the lowest along the profiles"});
  EXPECT_EQ(result.out.find("N m"), std::string::npos) << result.out;
}

TEST_F(LinearAxis, HasItsUnitsInFilesTablesAndReports) {
  ASSERT_EQ(run({"run", "stage.yaml", "-o", "stage.h5"}).code, 0);
  ASSERT_EQ(run({"export", "stage.h5", "-o", "csv"}).code, 0);
  expect_parts(first_line("csv/outcomes.csv"), {"holding_torque [N]", "peak_torque [N]", "creep [m]",
                                                "final_position [m]", "overshoot [count]"});
  expect_parts(first_line("csv/trace.csv"), {"torque [N]", "theta [m]", "omega [m/s]", "xp [m]"});
  expect_parts(first_line("csv/points.csv"),
               {"controller.ki [N/(m s)]", "holding_torque_mean [N]", "creep_max [m]"});
  expect_parts(first_line("csv/trials.csv"), {"friction.k1 [N/m]", "initial.position [m]"});
  expect_parts(first_line("csv/profiles.csv"), {"theta [m]"});
  ASSERT_EQ(run({"report", "stage.h5", "-o", "stage.html"}).code, 0);
  std::stringstream html;
  html << std::ifstream(folder / "stage.html").rdbuf();
  expect_parts(html.str(), {"Along the travel", "friction.k1 along the travel", "force (N)"});
  for (const char* word :
       {"rotor angle", "along the rotor", "torque (N m)", "(rad)", "$torque", "$rotor", "$angle"}) {
    EXPECT_EQ(html.str().find(word), std::string::npos) << word;
  }
}

TEST_F(LinearAxis, ItsParametersAreListed) {
  const std::string linear = run({"parameters", "--axis", "linear", "--units", "si"}).out;
  expect_parts(linear, {"encoder.resolution", "N/(m s)", "mass J of the slide"});
  EXPECT_EQ(linear.find("N m"), linear.find("N m, kg m^2")) << "in the meaning of the key `axis` alone";
}

TEST_F(LinearAxis, IsRefusedByIdentifyWhichKnowsNoOtherUnitsThanRotaryOnes) {
  ASSERT_EQ(run({"run", "stage.yaml", "-o", "stage.h5"}).code, 0);
  const ProgramResult result = run({"identify", "stage.h5"});
  EXPECT_EQ(result.code, 2);
  expect_parts(result.err, {"it is of a linear axis; expected a rotary one"});
}

}  // namespace
}  // namespace zerocount::testing
