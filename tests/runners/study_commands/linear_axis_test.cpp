// A linear axis from the manifest to every place in which its user sees a unit.

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
  for (const std::string& part : parts) EXPECT_TRUE(says(text, part)) << part << "\n" << text;
}

TEST_F(LinearAxis, CheckUsesLinearUnits) {
  const ProgramResult result = run({"check", "stage.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  expect_parts(result.out, {"1.5e+09", "N/(m s)", "k1·Δx", "the lowest along the profiles"});
  EXPECT_FALSE(says(result.out, "N m"));
}

TEST_F(LinearAxis, FilesTablesAndReportsUseLinearUnits) {
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
  expect_parts(html.str(), {"Along the travel", "friction.k1 along the travel", "\"force\",\"N\"]"});
  for (const char* word :
       {"rotor angle", "along the rotor", "\"N m\"]", "\"rad\"]", "$torque", "$rotor", "$angle"}) {
    EXPECT_FALSE(says(html.str(), word)) << word;
  }
}

TEST_F(LinearAxis, ItsParametersAreListed) {
  const std::string linear = run({"parameters", "--axis", "linear", "--units", "si"}).out;
  expect_parts(linear, {"encoder.resolution", "N/(m s)", "mass J of the slide"});
  EXPECT_EQ(linear.find("N m"), linear.find("N m, kg m^2")) << "in the meaning of the key `axis` alone";
}

/// Material tests of random linear axes: steps, loops and holds.
constexpr const char* linear_material_tests =
    "zerocount: 1\nname: tests\naxis: linear\nseed: 39\ntrials: 10\n"
    "plant: {inertia: {log_uniform: [1, 20]}, presliding_damping: {log_uniform: [500, 5000]}, "
    "sliding_damping: 10}\n"
    "friction: {k1: {log_uniform: [5.0e+5, 1.0e+7]}, k2: {log_uniform: [3.0e+6, 5.0e+7]},\n"
    "           beta: {log_uniform: [1.0e+6, 1.0e+7]}, alpha: {log_uniform: [0.5, 2]}, n: {uniform: [1.5, "
    "2.5]},\n"
    "           lambda: {lognormal: {median: 1.0e+7, cv: 0.5}}, breakaway: 50, stribeck_velocity: 1.0e-3}\n"
    "encoder: {resolution: 1.0e-9}\n"
    "dac: {bits: 16, resolution: 1.0e-3}\n"
    "controller: {sample_rate: 2000}\n"
    "command: {torque: {levels: [10, -10, 10, 0], rate: 40, through: dac}, hold: 5.0e-4}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}}\n"
    "sweep: {cases: {ramps: {}, steps: {command.torque.levels: [5, 0, 5, 0], command.torque.rate: 1.0e+5,\n"
    "                command.hold: 0.1}, holds: {command.torque.levels: [5, 5, 10, 10], command.hold: "
    "0.4}}}\n"
    "retain: {trials: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]}\n";

/// For each trial the true parameters, by key, from the rows of trials.csv.
std::vector<std::map<std::string, double>> true_parameters(const std::filesystem::path& table) {
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::ifstream in(table);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> heads = cells_of(line);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    for (std::size_t i = 0; i < std::min(heads.size(), cells.size()); ++i) {
      if (i == 0) rows.emplace_back();
      const std::string key = heads[i].substr(0, heads[i].find(" ["));
      if (key.starts_with("plant.") || key.starts_with("friction.")) rows.back()[key] = std::stod(cells[i]);
    }
  }
  return rows;
}

/// Counts the 95 % intervals of the first axes that contain the true value. All points of the file belong to
/// one axis.
struct HeldIntervals {
  int held{0};
  int estimated{0};
};

HeldIntervals identified_axes(const std::filesystem::path& folder, int axes) {
  const auto run = [&](const std::vector<std::string>& words) { return zerocount_program(words, folder); };
  EXPECT_EQ(run({"run", "tests.yaml", "-o", "tests.h5"}).code, 0);
  EXPECT_EQ(run({"export", "tests.h5", "-o", "csv"}).code, 0);
  const auto truth = true_parameters(folder / "csv" / "trials.csv");
  HeldIntervals intervals;
  for (int axis = 0; axis < axes; ++axis) {
    const std::string trial = std::to_string(axis);
    const ProgramResult result = run({"identify", "tests.h5", "--trial", trial, "--format", "json"});
    EXPECT_EQ(result.code, 0) << axis << result.err;
    const auto found = nlohmann::json::parse(result.out);
    EXPECT_EQ(found["axis"], "linear");
    for (const auto& parameter : found["parameters"]) {
      if (parameter["status"] != "estimated" || parameter["key"].is_null()) continue;
      const auto& of_axis = truth.at(static_cast<std::size_t>(axis));
      const auto value_at = of_axis.find(parameter["key"].get<std::string>());
      if (value_at == of_axis.end()) continue;
      const double value = value_at->second;
      ++intervals.estimated;
      if (parameter["low"] <= value && value <= parameter["high"]) ++intervals.held;
    }
  }
  return intervals;
}

void expect_intervals_hold(const TemporaryFolder& folder, int axes) {
  folder.write("tests.yaml", linear_material_tests);
  const HeldIntervals intervals = identified_axes(folder.path(), axes);
  EXPECT_GE(intervals.estimated, 7 * axes);
  EXPECT_GE(intervals.held, 0.9 * intervals.estimated) << intervals.estimated;
  std::cout << intervals.held << " of " << intervals.estimated << " intervals hold the truth\n";
}

TEST_F(LinearAxis, IsIdentifiedFromTheTracesOfItsMaterialTests) {
  expect_intervals_hold(folder, 2);
}

TEST_F(LinearAxis, DISABLED_IdentifiedIntervalsCoverTheTrueValues) {
  expect_intervals_hold(folder, 10);
}

// A closed loop that moves ten counts shows the inertia and the initial stiffness; it is not taken for
// sliding.
TEST_F(LinearAxis, ItsClosedLoopIdentifiesTheInertia) {
  ASSERT_EQ(run({"run", "stage.yaml", "-o", "stage.h5"}).code, 0);
  const auto found =
      nlohmann::json::parse(run({"identify", "stage.h5", "--point", "0", "--format", "json", "--quiet"}).out);
  for (const auto& parameter : found["parameters"]) {
    if (parameter["name"] != "inertia") continue;
    EXPECT_EQ(parameter["unit"], "kg");
    EXPECT_LT(parameter["low"], 5.0);
    EXPECT_GT(parameter["high"], 5.0);
  }
}

}  // namespace
}  // namespace zerocount::testing
