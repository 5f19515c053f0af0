// What a study says of each effect that a real axis has: it acts, it is stated to be absent, or it is assumed
// away.
#include <array>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::rules {
namespace {

using study::PremiseState;

/// The state of each premise that is not assumed.
std::map<std::string_view, PremiseState> stated_by(const std::string& more,
                                                   const std::vector<std::string>& overrides = {}) {
  std::map<std::string_view, PremiseState> stated;
  for (const study::Premise& premise : study_of(minimal_manifest(more), overrides).premises) {
    if (premise.state != PremiseState::assumed) stated[premise.assumption] = premise.state;
  }
  return stated;
}

struct Effect {
  const char* assumption;
  const char* key;
  double value;
};

constexpr std::array<Effect, 8> effects{
    {{"no encoder noise", "encoder.fine_errors.noise", 0.2},
     {"no other encoder errors", "encoder.fine_errors.eccentricity", 1e-4},
     {"no delay", "controller.delay", 1},
     {"no jitter", "controller.jitter", 1e-5},
     {"ideal amplifier", "amplifier.bandwidth", 500},
     {"ideal converter", "dac.gain_error", 0.01},
     {"rigid", "plant.load.inertia", 1e-4},
     {"no disturbance", "disturbance.torque", 0.01}}};

// Any mixture of keys that are left out, 0, a number, drawn, swept or of a condition.
TEST(Premises, AKeyStatesItsEffectWhateverGivesIt) {
  std::mt19937_64 random(9);
  std::map<int, int> seen;
  for (int i = 0; i < 60; ++i) {
    std::map<std::string_view, PremiseState> expected;
    std::string grid;
    std::string loaded;
    std::string flat;
    std::vector<std::string> overrides;
    for (const Effect& effect : effects) {
      const int how = std::uniform_int_distribution(0, 5)(random);
      ++seen[how];
      if (how == 0) continue;
      expected[effect.assumption] = how == 1 ? PremiseState::stated_none : PremiseState::considered;
      if (how == 1) overrides.push_back(fmt::format("{}=0", effect.key));
      if (how == 2) overrides.push_back(fmt::format("{}={}", effect.key, effect.value));
      if (how == 3) overrides.push_back(fmt::format("{}={{uniform: [0, {}]}}", effect.key, effect.value));
      if (how == 4) grid += fmt::format("{}{}: [0, {}]", grid.empty() ? "" : ", ", effect.key, effect.value);
      if (how == 5) loaded += fmt::format("{}{}: {}", loaded.empty() ? "" : ", ", effect.key, effect.value);
    }
    std::string more;
    if (!grid.empty()) more += "sweep: {grid: {" + grid + "}}\n";
    if (!loaded.empty()) more += "conditions: {plain: {controller.ki: 2.0e-5}, other: {" + loaded + "}}\n";
    EXPECT_EQ(stated_by(more, overrides), expected) << more << fmt::format("{}", fmt::join(overrides, "\n"));
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(Premises, ListsAndSpectraAreEffectsToo) {
  using Stated = std::map<std::string_view, PremiseState>;
  const Stated acts{{"no disturbance", PremiseState::considered}};
  EXPECT_EQ(stated_by("disturbance: {ripple: [{amplitude: 0.01, periods: 100}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{amplitude: 0.01, frequency: 100}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{spectrum: [[1, 1.0e-8], [100, 1.0e-8]]}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{amplitude: 0, frequency: 100}]}\n"),
            (Stated{{"no disturbance", PremiseState::stated_none}}));
}

TEST(Premises, AnOpenLoopAssumesNothingOfItsControl) {
  for (const study::Premise& premise :
       study_of("zerocount: 1\nname: open\nseed: 1\ntrials: 1\ncommand: {torque: {levels: [0.1]}}\n")
           .premises) {
    EXPECT_NE(premise.assumption, "no delay");
    EXPECT_NE(premise.assumption, "no encoder noise");
  }
}

}  // namespace
}  // namespace zerocount::rules
