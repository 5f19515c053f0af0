// A written controller is one controller: of conditions with different ones it is that of the one named.
#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"
#include "runners/program/commands.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* manifest = R"(
zerocount: 1
name: joint
seed: 1
machines: 2
trials: 8
plant: {inertia: 5.0e-4}
controller: {ki: 3.0e-5, feedforward: {acceleration: 7.0e-4}}
command: {targets: [30], hold: 0.2, profile: {shape: s_curve, velocity_limit: 0.01, acceleration_limit: 1, jerk_limit: 500}}
)";

class ControllerOfConditions : public ::testing::Test {
 protected:
  /// The code of the controller that the program writes with these options.
  /// @throws Failure like the program
  std::string written(std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"controller", folder_.path() / "joint.yaml", "-o", folder_.path() / "c.c", "--force"});
    program::run_command_line(options);
    return folder_.read("c.c");
  }

  TemporaryFolder folder_;
};

TEST_F(ControllerOfConditions, IsThatOfTheNamedCondition) {
  folder_.write("joint.yaml", std::string(manifest) +
                                  "conditions: {empty: {}, loaded: {plant.inertia: 2.2e-3, "
                                  "controller.feedforward.acceleration: 2.7e-3}}\n");
  EXPECT_TRUE(says(refusal_by([&] { written({}); }),
                   "controller.feedforward.acceleration is 0.0007 under condition empty, 0.0027 under "
                   "condition loaded; expected the one to write with --condition"))
      << "which of two controllers was written?";
  const std::string loaded = written({"--condition", "loaded"});
  EXPECT_TRUE(says(loaded, "feedforward_acceleration = 0.0027", "joint, loaded"));
  EXPECT_FALSE(says(loaded, "condition empty")) << "margins of another controller";
  EXPECT_TRUE(says(written({"--condition", "empty"}), "feedforward_acceleration = 0.0007"));
  EXPECT_THROW(written({"--condition", "full"}), Failure);
}

// A plant that differs has the same controller, with margins under each condition.
TEST_F(ControllerOfConditions, NeedsNoConditionIfOnlyThePlantDiffers) {
  folder_.write("joint.yaml",
                std::string(manifest) + "conditions: {empty: {}, loaded: {plant.inertia: 2.2e-3}}\n");
  const std::string both = written({});
  EXPECT_TRUE(says(both, "under condition empty", "under condition loaded"));
}

// The help is written by hand; the columns are those of the layout.
TEST(TraceHelp, NamesEveryColumn) {
  study::StudyFeatures features;
  features.travel = features.phases = features.load = features.drive_torque = true;
  features.load_count = features.motor_count = true;
  for (const commands::Command& command : program::commands()) {
    if (command.spec.name != "trace") continue;
    for (const auto& field : layout::trace_fields(features)) {
      const std::string name(field.column.name);
      EXPECT_TRUE(name == "trial" || command.help.find(name) != std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
