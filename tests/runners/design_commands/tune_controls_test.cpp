// The simpler controls beside a tuned one.
#include <nlohmann/json.hpp>

#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class TuneControls : public Tune {};

/// A control of an answer of 1000 machines at least.
struct ControlInAnswer {
  std::set<std::string> blocks;  ///< free parameters that are not fixed at 0
  double rate;

  bool has_all_blocks_of(const ControlInAnswer& other) const {
    return std::ranges::includes(blocks, other.blocks);
  }
};

std::vector<ControlInAnswer> controls_in(const Json& answer) {
  std::set<std::string> free;
  for (const auto& [name, value] : answer["gains"].items()) free.insert(name);
  std::vector<ControlInAnswer> controls;
  const auto add = [&](const Json& fixed, const Json& gains, double rate) {
    std::set<std::string> blocks = free;
    for (const auto& [name, value] : gains.items()) blocks.insert(name);
    for (const auto& [name, value] : fixed.items()) blocks.erase(name);
    controls.push_back({blocks, rate});
  };
  add(Json::object(), answer["gains"], answer["proof"]["rate"]);
  for (const Json& one : answer["alternatives"]) {
    if (!one["gains"].empty()) add(one["fixed"], one["gains"], one["rate"]);
  }
  return controls;
}

// Every pair of controls of which one has all blocks of the other: the rates are of 500 machines at least.
TEST_F(TuneControls, AControlWithMoreBlocksIsWorseOnlyByChance) {
  int pairs = 0;
  for (const std::string goal :
       {"{band: 1, within: 0.05, moves: 0.95}", "{band: 0, within: 0.1, moves: 0.9}"}) {
    write_axis("goal: " + goal + "\n" + std::string(two_gains));
    const std::vector<ControlInAnswer> controls =
        controls_in(Json::parse(tune({"--extras", "controls"}, "9000").out));
    for (const ControlInAnswer& more : controls) {
      for (const ControlInAnswer& fewer : controls) {
        if (more.blocks == fewer.blocks || !more.has_all_blocks_of(fewer)) continue;
        ++pairs;
        const double wanted = std::min(fewer.rate, 0.95);
        EXPECT_GE(more.rate, wanted - 3.0 * std::sqrt(wanted * (1.0 - wanted) / 250.0)) << goal;
      }
    }
  }
  EXPECT_EQ(pairs, 6);
}

// The ranges of kp and kd are so wide that only their low ends keep the margins: the integral alone does.
TEST_F(TuneControls, IsNotUnreachableWhereASimplerControlMeetsTheGoal) {
  write_axis(
      "goal: {band: 1, within: 0.2, moves: 0.9}\ntune: {free: {controller.ki: {log: [2.0e-6, 1.0e-4]}, "
      "controller.kp: [0, 2.0e-2], controller.kd: [0, 1.5e-1]}}\n");
  const Json answer = Json::parse(tune({"--set", "controller.delay=3"}, "6000").out);
  EXPECT_EQ(answer["status"], "met") << answer.dump(1);
  EXPECT_GE(answer["margins"]["gain"], 6.0);
}

}  // namespace
}  // namespace zerocount::testing
