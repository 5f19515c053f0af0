// The controller written as C: built as a plugin it decides as the built-in chain, bit for bit.
#include "runners/controller_code/c_code.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/random_trials.hpp"

namespace zerocount::testing {
namespace {

using Plugin = std::shared_ptr<const plugin::ControllerPlugin>;

/// A trial in which the loop does something, with these blocks.
trial::TrialParameters trial_with(const loop::ControllerParameters& controller, RandomBlocks& draw) {
  trial::TrialParameters p = random_trial(TrialKind::calm, 41000 + draw.integer() % 1000);
  p.encoder = {};
  p.dac = {};
  p.controller = controller;
  p.command.targets = {static_cast<std::int64_t>(draw.uniform(-60.0, 60.0)),
                       static_cast<std::int64_t>(draw.uniform(-60.0, 60.0))};
  p.command.hold = 0.15;
  if (controller.blocks.feedforward.velocity != 0.0 || draw.chance(0.3)) {
    p.command.profile = {.shape = loop::ReferenceShape::s_curve,
                         .velocity_limit = draw.log_uniform(2e-3, 5e-2),
                         .acceleration_limit = draw.log_uniform(0.1, 10.0),
                         .jerk_limit = 500.0};
  }
  p.initial.integral = 0.01;
  return p;
}

loop::ControllerParameters random_controller(BlockKind kind, RandomBlocks& draw) {
  loop::ControllerParameters c;
  c.kp = draw.some(draw.log_uniform(1e-5, 4e-4));
  c.ki = draw.log_uniform(1e-5, 1e-4);
  c.kd = draw.some(draw.log_uniform(1e-5, 1e-3));
  c.delay = draw.some(1.0);
  if (draw.chance(0.3)) c.anti_windup = loop::AntiWindup::none;
  c.blocks = draw.blocks(kind, c.sample_rate);
  if (draw.chance(0.2)) c.dither = {draw.log_uniform(1e-5, 1e-3), draw.log_uniform(50.0, 1000.0)};
  return c;
}

class ExportedController : public ::testing::Test {
 protected:
  /// The code as a plugin; every warning of the compiler is an error.
  Plugin built(const std::string& code, const std::string& name) {
    const std::filesystem::path source = folder_.path() / (name + ".c");
    const std::filesystem::path library = folder_.path() / (name + ".so");
    std::ofstream(source) << code;
    const std::string command =
        "cc -std=c99 -O2 -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -fPIC "
        "-shared -DZEROCOUNT_PLUGIN -I " ZEROCOUNT_PLUGIN_HEADERS " " +
        source.string() + " -o " + library.string();
    EXPECT_EQ(std::system(command.c_str()), 0) << code;
    return std::get<Plugin>(plugins::load_plugin(library));
  }

  TemporaryFolder folder_;
};

std::vector<trial::SampleRecord> samples_of(const trial::TrialParameters& p) {
  std::vector<trial::SampleRecord> samples;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) { samples.push_back(sample); };
  trial::run_trial(p, observers);
  return samples;
}

TEST_F(ExportedController, DecidesAsTheBuiltInChain) {
  RandomBlocks draw(314);
  int trials = 0;
  for (int kind = 0; kind < block_kinds; ++kind) {
    for (int i = 0; i < 4; ++i) {
      const loop::ControllerParameters controller = random_controller(static_cast<BlockKind>(kind), draw);
      const loop::EncoderParameters encoder;
      const std::string code =
          controller_code::c_code({controller, loop::fine_resolution(encoder), {}, 0.01, "test"});
      loop::ControllerParameters exported;
      exported.delay = controller.delay;
      exported.user.plugin = built(code, "controller" + std::to_string(block_kinds * i + kind));
      for (int j = 0; j < 4; ++j) {
        trial::TrialParameters p = trial_with(controller, draw);
        const std::vector<trial::SampleRecord> built_in = samples_of(p);
        p.controller = exported;
        const std::vector<trial::SampleRecord> written = samples_of(p);
        ASSERT_EQ(built_in.size(), written.size());
        for (std::size_t k = 0; k < written.size(); ++k) {
          ASSERT_EQ(built_in[k].code, written[k].code) << block_kind_names[kind] << " sample " << k << code;
          ASSERT_EQ(built_in[k].theta, written[k].theta);
        }
        ++trials;
      }
    }
  }
  EXPECT_GE(trials, 200);
}

TEST_F(ExportedController, IsWrittenByTheProgramForItsPoint) {
  folder_.write("axis.yaml",
                "zerocount: 1\nname: axis\nseed: 1\ntrials: 4\ncommand: {targets: [20], hold: 0.3}\n"
                "controller: {ki: 3.0e-5, hold: {enter: 0, dwell: 0.01}}\n"
                "sweep: {grid: {controller.ki: [2.0e-5, 3.0e-5]}}\n");
  const ProgramResult result =
      zerocount_program({"controller", "axis.yaml", "--point", "1", "-o", "controller.c"}, folder_.path());
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(folder_.read("controller.c").find("controller.ki=3e-05"), std::string::npos);
  const auto refused = [&](const std::string& set) {
    const ProgramResult answer = zerocount_program({"controller", "axis.yaml", "--set", set}, folder_.path());
    EXPECT_EQ(answer.code, 2) << set;
    return answer.err;
  };
  EXPECT_NE(refused("controller.kp={uniform: [0, 1.0e-4]}").find("controller.kp is drawn"),
            std::string::npos);
  EXPECT_NE(refused("controller.coarse.coarse_beyond=100").find("two phases"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
