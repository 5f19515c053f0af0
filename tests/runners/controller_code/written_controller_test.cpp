// The written controller in each language and precision: it decides as the built-in chain, or, in single
// precision, as the law of which the program says what single precision changes, bit for bit.
#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "runners/controller_code/program.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/random_trials.hpp"

namespace zerocount::testing {
namespace {

using Plugin = std::shared_ptr<const plugin::ControllerPlugin>;

/// The parameters of a random trial with this controller, in which the loop has something to do.
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
  draw.add_drive(c.blocks);
  if (draw.chance(0.2)) c.dither = {draw.log_uniform(1e-5, 1e-3), draw.log_uniform(50.0, 1000.0)};
  return c;
}

using controller_code::Precision;

class WrittenController : public ::testing::Test {
 protected:
  /// The generated code built as a plugin; every warning of the compiler is an error.
  Plugin built(const std::string& code, const std::string& name) {
    const std::filesystem::path source = folder_.path() / (name + ".c");
    const std::filesystem::path library = folder_.path() / (name + ".so");
    std::ofstream(source) << code;
    const std::string command =
        "cc -std=c99 -O2 -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Werror -ffp-contract=off "
        "-fPIC -shared -DZEROCOUNT_PLUGIN -I " ZEROCOUNT_PLUGIN_HEADERS " " +
        source.string() + " -o " + library.string();
    EXPECT_EQ(std::system(command.c_str()), 0) << code;
    return std::get<Plugin>(plugins::load_plugin(library));
  }

  /// Writes the controller as a function block in structured text, with the inputs and the torque of every
  /// sample of the trial.
  void write_structured_text(const controller_code::ControllerToWrite& chain,
                             const controller_code::Program& program, trial::TrialParameters p) {
    const std::string name = fmt::format("block{}", ++blocks_);
    folder_.write(name, controller_code::structured_text(chain, program, name));
    std::string samples;
    plugin::ControllerPlugin recording = *controller_code::law_of(program);
    recording.start = [&samples, two_encoders = chain.controller.velocity_by_other,
                       start = recording.start](const zerocount_setup& setup) {
      return [&samples, two_encoders, step = start(setup)](const zerocount_sample& now) {
        const double wanted = step(now);
        samples += fmt::format("{:a} {:a} {:a} {:a} {:a} {:a} ", now.error, now.count, now.velocity,
                               now.acceleration, now.torque, static_cast<double>(now.new_target));
        if (two_encoders) samples += fmt::format("{:a} ", now.other_count);
        samples += fmt::format("{:a}\n", wanted);
        return wanted;
      };
    };
    p.controller = with_law(p.controller, std::make_shared<const plugin::ControllerPlugin>(recording));
    trial::run_trial(p);
    folder_.write(name + ".samples", samples);
    files_ += " " + (folder_.path() / name).string();
  }

  static loop::ControllerParameters with_law(const loop::ControllerParameters& controller,
                                             const Plugin& law) {
    loop::ControllerParameters written;
    written.delay = controller.delay;
    written.user.plugin = law;
    return written;
  }

  TemporaryFolder folder_;
  int blocks_{0};
  std::string files_;  ///< folder with the written function blocks
};

std::vector<trial::SampleRecord> samples_of(const trial::TrialParameters& p) {
  std::vector<trial::SampleRecord> samples;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) { samples.push_back(sample); };
  trial::run_trial(p, observers);
  return samples;
}

TEST_F(WrittenController, EqualsTheSimulatedController) {
  RandomBlocks draw(314);
  int trials = 0;
  for (int kind = 0; kind < block_kinds; ++kind) {
    for (int i = 0; i < 4; ++i) {
      loop::ControllerParameters controller = random_controller(static_cast<BlockKind>(kind), draw);
      loop::EncoderParameters encoder;
      if (controller.blocks.structure == loop::ControlStructure::cascade && draw.chance(0.5)) {
        encoder.other = {50000.0, 2.0 * std::numbers::pi};
        controller.velocity_by_other = true;
      }
      loop::DacParameters dac;
      if (i % 2 == 1) dac.limit = draw.log_uniform(1e-2, 1.0);
      const controller_code::ControllerToWrite chain{controller,
                                                     loop::fine_resolution(encoder),
                                                     loop::velocity_resolution(encoder, controller),
                                                     dac,
                                                     0.01,
                                                     "test"};
      for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        const bool single = precision == Precision::single_precision;
        if (single && i >= 2) continue;
        const controller_code::Program program = controller_code::chain_program(chain, precision);
        const std::string code = controller_code::c_code(chain, program);
        const Plugin library = built(code, fmt::format("controller{}_{}_{}", kind, i, single));
        trial::TrialParameters p;
        for (int j = 0; j < 3; ++j) {
          p = trial_with(controller, draw);
          p.dac = dac;
          p.encoder = encoder;
          if (controller.velocity_by_other) p.plant.load = {1e-4, 2000.0, 0.05};
          if (single) p.controller = with_law(controller, controller_code::law_of(program));
          const std::vector<trial::SampleRecord> simulated = samples_of(p);
          p.controller = with_law(controller, library);
          const std::vector<trial::SampleRecord> written = samples_of(p);
          ASSERT_EQ(simulated.size(), written.size());
          for (std::size_t k = 0; k < written.size(); ++k) {
            ASSERT_EQ(simulated[k].code, written[k].code)
                << block_kind_names[kind] << " sample " << k << code;
            ASSERT_EQ(simulated[k].theta, written[k].theta);
          }
          ++trials;
        }
        write_structured_text(chain, program, p);
      }
    }
  }
  EXPECT_GE(trials, 200);
  EXPECT_EQ(std::system((ZEROCOUNT_PYTHON " -B " ZEROCOUNT_ST_INTERPRETER + files_).c_str()), 0);
}

// What does not act has no constant, no term and no state.
TEST_F(WrittenController, HasNoTermWithoutAGain) {
  loop::ControllerParameters controller;
  controller.ki = 3.0e-5;
  const controller_code::ControllerToWrite chain{
      controller, 1.0e-7, 1.0e-7, {}, 0.0, "test", parameters::AxisKind::linear};
  const std::string code =
      controller_code::c_code(chain, controller_code::chain_program(chain, Precision::double_precision));
  for (const char* const absent : {"kp", "kd", "last_count", "0x", "N m", "rad", "torque *", "feedforward"})
    EXPECT_FALSE(says(code.substr(0, code.find("#ifdef")), absent)) << absent << "\n" << code;
  EXPECT_TRUE(says(code, "static const double ki = 3.0e-05; /* ", "N/count (1.2e+06 N/(m s) in SI units)"));
}

// A constant reads back to the same number in its precision.
TEST_F(WrittenController, NamesNumbersThatReadBack) {
  RandomBlocks draw(2718);
  for (int i = 0; i < 10000; ++i) {
    const double value = draw.log_uniform(1e-300, 1e300) * (draw.chance(0.5) ? 1.0 : -1.0);
    ASSERT_EQ(std::stod(controller_code::decimal(value, {})), value);
    const double small = draw.log_uniform(1e-30, 1e30);
    const std::string text =
        controller_code::decimal(small, {.precision = Precision::single_precision, .number_suffix = "F"});
    ASSERT_EQ(std::stof(text), static_cast<float>(small));
    ASSERT_NE(text.find('.'), std::string::npos) << text;
  }
}

// Beside an integral of 0.4 N m, of which single precision has steps of 3e-8 N m, increments of 6e-9 N m a
// count vanish before the error does.
TEST_F(WrittenController, ReportsTheTrialsThatSinglePrecisionLoses) {
  folder_.write("fine.yaml",
                "zerocount: 1\nname: fine\nseed: 1\ntrials: 5\n"
                "friction: {model: spring, k1: 110, breakaway: 2}\nplant: {presliding_damping: 0.05}\n"
                "encoder: {fine: 162000000}\ndac: {bits: 28, resolution: 4.0e-9}\n"
                "controller: {sample_rate: 20000, ki: 3.0e-9}\n"
                "command: {targets: [{integers: [90000, 100000]}], hold: 1}\n"
                "goal: {band: 1, within: 0.9, moves: 0.9}\n");
  const ProgramResult result =
      zerocount_program({"controller", "fine.yaml", "--precision", "single", "-o", "fine.c"}, folder_.path());
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(
      says(result.err, "0 trials meet the goal (5); 5 are judged otherwise\n", "settled: median never (0.3"));
}

TEST_F(WrittenController, CommandWritesTheControllerOfAPoint) {
  folder_.write("axis.yaml",
                "zerocount: 1\nname: axis\nseed: 1\ntrials: 4\ncommand: {targets: [20], hold: 0.3}\n"
                "controller: {ki: 3.0e-5, hold: {enter: 0, dwell: 0.01}}\n"
                "sweep: {grid: {controller.ki: [2.0e-5, 3.0e-5]}}\n");
  const ProgramResult result =
      zerocount_program({"controller", "axis.yaml", "--point", "1", "-o", "controller.c"}, folder_.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string code = folder_.read("controller.c");
  EXPECT_TRUE(says(code, "controller.ki=3e-05", "at k1: stable; gain margin "));
  EXPECT_FALSE(says(code, "single precision"));

  const ProgramResult single = zerocount_program({"controller", "axis.yaml", "--point", "1", "--precision",
                                                  "single", "--language", "st", "-o", "axis_x.st"},
                                                 folder_.path());
  EXPECT_EQ(single.code, 0) << single.err;
  const std::string changes = "trials end at zero counts (";
  EXPECT_TRUE(says(single.err, changes));
  const std::string block = folder_.read("axis_x.st");
  EXPECT_TRUE(says(block, changes, "FUNCTION_BLOCK axis_x_controller\n"));
  const auto refused = [&](const std::string& set, const std::string& precision = "double") {
    const ProgramResult answer = zerocount_program(
        {"controller", "axis.yaml", "--precision", precision, "--set", set}, folder_.path());
    EXPECT_EQ(answer.code, 2) << set;
    return answer.err;
  };
  EXPECT_TRUE(says(refused("controller.kp={uniform: [0, 1.0e-4]}"), "controller.kp is drawn"));
  EXPECT_TRUE(says(refused("controller.coarse.coarse_beyond=100"), "two phases"));
  EXPECT_TRUE(says(refused("controller.encoder=coarse", "single"), "single precision"));
}

}  // namespace
}  // namespace zerocount::testing
