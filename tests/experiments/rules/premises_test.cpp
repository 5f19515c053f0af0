// What a study says of each effect that a real axis has: it acts, it is stated to be absent, or it is assumed
// away.
#include "experiments/rules/value_sources.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

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

// Where the values that trials rest on come from: what the manifest gives, by whatever key, and the defaults
// that act.

std::map<std::string_view, ValueSource> sources_of(const study::Study& study) {
  std::map<std::string_view, ValueSource> sources;
  for (const SourcedValue& one : value_sources(*study.plan))
    sources[study.plan->table.rows[one.slot].name] = one.source;
  return sources;
}

// Any mixture of keys that are left out, set, drawn, swept or of a condition.
TEST(ValueSources, AValueIsGivenWhereverTheManifestHasIt) {
  std::mt19937_64 random(5);
  const std::map<std::string, double> keys{{"plant.inertia", 1e-3},   {"friction.k1", 100.0},
                                           {"friction.beta", 9e4},    {"encoder.fine", 8e5},
                                           {"dac.bits", 14.0},        {"amplifier.bandwidth", 800.0},
                                           {"controller.ki", 2.0e-5}, {"verdict.dwell", 0.02}};
  for (int i = 0; i < 40; ++i) {
    std::map<std::string_view, bool> given;
    std::string grid;
    std::string loaded;
    std::vector<std::string> overrides;
    for (const auto& [key, value] : keys) {
      const int how = std::uniform_int_distribution(0, 4)(random);
      given[key] = how > 0;
      if (how == 1) overrides.push_back(fmt::format("{}={}", key, value));
      if (how == 2) overrides.push_back(fmt::format("{}={{choice: [{}]}}", key, value));
      if (how == 3) grid += fmt::format("{}{}: [{}]", grid.empty() ? "" : ", ", key, value);
      if (how == 4) loaded += fmt::format("{}{}: {}", loaded.empty() ? "" : ", ", key, value);
    }
    std::string more;
    if (!grid.empty()) more += "sweep: {grid: {" + grid + "}}\n";
    if (!loaded.empty()) more += "conditions: {plain: {controller.kd: 0}, other: {" + loaded + "}}\n";
    const auto sources = sources_of(study_of(minimal_manifest(more), overrides));
    for (const auto& [key, is_given] : given) {
      // An amplifier without bandwidth is an effect that is absent, not a default that acts.
      if (key == "amplifier.bandwidth" && !is_given) {
        EXPECT_EQ(sources.count(key), 0U);
        continue;
      }
      ASSERT_EQ(sources.count(key), 1U) << key;
      EXPECT_EQ(sources.at(key), is_given ? ValueSource::given : ValueSource::assumed) << key << "\n" << more;
    }
  }
}

TEST(ValueSources, WhatFollowsFromMeasuredValuesIsNotAssumed) {
  const auto sources = sources_of(study_of(
      minimal_manifest("friction: {measured: {initial_stiffness: 900, final_stiffness: 100, breakaway: 0.3, "
                       "breakaway_travel: 1.0e-3}}\n")));
  EXPECT_EQ(sources.at("friction.measured.breakaway"), ValueSource::measured);
  for (const char* const follows : {"friction.k1", "friction.k2", "friction.beta", "friction.breakaway"})
    EXPECT_EQ(sources.count(follows), 0U) << follows;
  EXPECT_EQ(sources.at("friction.alpha"), ValueSource::assumed);
}

TEST(ValueSources, DefaultsWithoutEffectAreNotNamed) {
  const auto spring = sources_of(study_of(minimal_manifest("friction: {model: spring}\n")));
  EXPECT_EQ(spring.count("friction.alpha"), 0U);
  EXPECT_EQ(spring.count("friction.sigma0"), 0U);
  EXPECT_EQ(spring.count("friction.k1"), 1U);
  const auto lugre = sources_of(study_of(minimal_manifest("friction: {model: lugre}\n")));
  EXPECT_EQ(lugre.count("friction.k1"), 0U);
  EXPECT_EQ(lugre.at("friction.sigma0"), ValueSource::assumed);
}

}  // namespace
}  // namespace zerocount::rules
