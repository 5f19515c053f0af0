// The examples are the built-in PI with a conditional integrator, bit for bit.
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/plugins/plugin_manifest.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

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

TEST(BuiltInLaw, TracesAreEqualToTheBit) {
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

TEST(BuiltInLaw, WholeRunsAreEqualToTheBit) {
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
       {"outcome", "settling_time", "final_position", "holding_torque", "jerk_count", "creep"}) {
    const std::vector<double> one = a.measure(measure, a.rows());
    const std::vector<double> other = b.measure(measure, b.rows());
    ASSERT_EQ(one.size(), 48u);
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_TRUE(one[i] == other[i] || (std::isnan(one[i]) && std::isnan(other[i]))) << measure << " " << i;
  }
}

}  // namespace
}  // namespace zerocount::testing
