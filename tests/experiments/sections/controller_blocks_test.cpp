// The blocks of the controller in manifests: limits that are off, the short form of the deadband, sweeps.
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

loop::ControllerParameters controller_of(const std::string& keys, std::int64_t point = 0) {
  return study::study_trial(study_of(minimal_manifest(keys)), point, 0).parameters.controller;
}

TEST(ControllerBlocks, AreOffByDefault) {
  const loop::ControllerParameters controller = controller_of("");
  for (const loop::ControlBlocks* blocks : {&controller.blocks, &controller.coarse.blocks}) {
    EXPECT_EQ(blocks->structure, loop::ControlStructure::pid);
    EXPECT_LT(blocks->deadband.enter, 0.0);
    EXPECT_LT(blocks->deadband.leave, 0.0);
    EXPECT_EQ(blocks->integrator_zone, unlimited);
    EXPECT_EQ(blocks->integrator_leak, unlimited);
    EXPECT_EQ(blocks->derivative_cutoff, unlimited);
    EXPECT_EQ(blocks->observer.bandwidth, 0.0);
  }
}

TEST(ControllerBlocks, OfEachPhaseAreItsOwn) {
  const loop::ControllerParameters controller = controller_of(
      "controller: {deadband: 1, observer: {bandwidth: 20, inertia: 5.0e-4}, coarse: {coarse_beyond: 300,\n"
      "  structure: cascade, cascade: {kv: 20, kp: 0.5, ki: 3}, deadband: {enter: 2, leave: 3}, "
      "integrator_leak: 0.5}}");
  EXPECT_EQ(controller.blocks.deadband.enter, 1.0);
  EXPECT_LT(controller.blocks.deadband.leave, 0.0);
  EXPECT_EQ(controller.blocks.observer.bandwidth, 20.0);
  EXPECT_EQ(controller.blocks.observer.inertia, 5e-4);
  EXPECT_EQ(controller.blocks.structure, loop::ControlStructure::pid);
  EXPECT_EQ(controller.coarse.blocks.structure, loop::ControlStructure::cascade);
  EXPECT_EQ(controller.coarse.blocks.cascade.kv, 20.0);
  EXPECT_EQ(controller.coarse.blocks.deadband.enter, 2.0);
  EXPECT_EQ(controller.coarse.blocks.deadband.leave, 3.0);
  EXPECT_EQ(controller.coarse.blocks.integrator_leak, 0.5);
}

TEST(ControllerBlocks, LimitsThatAreOffAreWrittenNone) {
  const loop::ControllerParameters controller = controller_of(
      "controller: {deadband: none, integrator_zone: none, integrator_leak: none, derivative_cutoff: none, "
      "coarse: {coarse_beyond: none}}");
  EXPECT_LT(controller.blocks.deadband.enter, 0.0);
  EXPECT_EQ(controller.blocks.integrator_zone, unlimited);
  EXPECT_EQ(controller.blocks.integrator_leak, unlimited);
  EXPECT_EQ(controller.blocks.derivative_cutoff, unlimited);
  EXPECT_EQ(controller.coarse.coarse_beyond, unlimited);
  EXPECT_EQ(controller_of("controller: {deadband: {enter: 1, leave: none}}").blocks.deadband.enter, 1.0);
  EXPECT_EQ(controller_of("controller: {integrator_zone: 1.0e+12}").blocks.integrator_zone, unlimited);
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {kp: none}")),
                         "6:18: controller.kp | is not a number"));
}

TEST(ControllerBlocks, DeadbandIsSweptAndDrawnInItsShortForm) {
  const study::Study study =
      study_of(minimal_manifest("sweep: {grid: {controller.deadband: [none, 0, 1.5]}}"));
  ASSERT_EQ(study::point_count(study), 3);
  EXPECT_EQ(study.points.labels[0], "controller.deadband=none");
  EXPECT_EQ(study.points.labels[2], "controller.deadband=1.5");
  EXPECT_EQ(study.points.axes.front().name, "controller.deadband.enter");
  const auto enter = [&](std::int64_t point) {
    return study::study_trial(study, point, 0).parameters.controller.blocks.deadband.enter;
  };
  EXPECT_LT(enter(0), 0.0);
  EXPECT_EQ(enter(1), 0.0);
  EXPECT_EQ(enter(2), 1.5);
  EXPECT_EQ(study_of(minimal_manifest("controller: {deadband: {uniform: [0, 2]}}")).columns.inputs[0].name,
            "controller.deadband.enter");
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {deadband: 1}\n"
                                                     "sweep: {grid: {controller.deadband: [1, 2], "
                                                     "controller.deadband.enter: [3]}}")),
                         "7:45: sweep.grid.controller.deadband.enter | is swept twice"));
}

TEST(ControllerBlocks, AWrongKeyOfTheDeadbandIsToldItsKeys) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {deadband: {entr: 1}}")),
                         "6:25: controller.deadband.entr | enter"));
}

}  // namespace
}  // namespace zerocount::sections
