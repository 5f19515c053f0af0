#include "core/loop/controller/user_law.hpp"

#include "core/plugin/controller_plugin.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

ControllerParameters parameters_with(std::function<plugin::StepFunction(const zerocount_setup&)> start) {
  plugin::ControllerPlugin plugin{.description = {"law", "1", "", {}}};
  plugin.start = std::move(start);
  ControllerParameters parameters;
  parameters.sample_rate = 4000.0;
  parameters.user.plugin = std::make_shared<const plugin::ControllerPlugin>(std::move(plugin));
  return parameters;
}

TEST(UserLaw, ALawOfThisProcessIsStartedWithTheSetupAndStepsWithTheSamples) {
  std::vector<std::int64_t> samples;
  const ControllerParameters parameters = parameters_with([&](const zerocount_setup& setup) {
    EXPECT_EQ(setup.sample_time, 1.0 / 4000.0);
    EXPECT_EQ(setup.resolution, 1e-6);
    EXPECT_EQ(setup.torque_resolution, 1e-4);
    EXPECT_EQ(setup.lowest_torque, -2.0);
    EXPECT_EQ(setup.highest_torque, 3.0);
    EXPECT_EQ(setup.initial_integral, 0.25);
    return [&, gain = setup.resolution](const zerocount_sample& sample) {
      samples.push_back(sample.k);
      EXPECT_EQ(sample.time, static_cast<double>(sample.k) / 4000.0);
      return gain * sample.error;
    };
  });
  const ControlStart start{.integral = 0.25, .resolution = 1e-6, .dac = {{-2.0, 3.0}, 1e-4}};
  UserLaw law(parameters, start);
  UserLaw moved = std::move(law);
  EXPECT_EQ(moved.step({.error = 3.0}, 0.0), 3e-6);
  EXPECT_EQ(moved.step({.error = -2.0}, 0.0), -2e-6);
  EXPECT_EQ(samples, (std::vector<std::int64_t>{0, 1}));
}

TEST(UserLaw, AnExceptionOfALawOfThisProcessIsPassedOn) {
  const ControllerParameters parameters = parameters_with([](const zerocount_setup&) {
    return [](const zerocount_sample&) -> double { throw std::runtime_error("mine"); };
  });
  UserLaw law(parameters, {});
  EXPECT_THROW(law.step({}, 0.0), std::runtime_error);
}

}  // namespace
}  // namespace zerocount::loop
