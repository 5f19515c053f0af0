#include "experiments/parameters/parameter_table.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "experiments/language/manifest_keys.hpp"
#include "experiments/parameters/parameter_listing.hpp"

namespace zerocount {
namespace {

// The paper's rig and what is assumed beside it.
const std::map<std::string, double> expected_defaults{
    {"plant.inertia", 5.54e-4},
    {"plant.presliding_damping", 0.2},
    {"plant.sliding_damping", 1e-3},
    {"friction.k1", 110},
    {"friction.k2", 750},
    {"friction.beta", 2e5},
    {"friction.alpha", 0.5},
    {"friction.lambda", 10},
    {"friction.n", 2},
    {"friction.breakaway", 0.3},
    {"friction.coulomb_ratio", 0.8},
    {"friction.stribeck_velocity", 0.01},
    {"encoder.fine", 1620000},
    {"encoder.coarse", 86400},
    {"dac.bits", 12},
    {"dac.resolution", 2.4e-4},
    {"controller.sample_rate", 2000},
    {"controller.kp", 0},
    {"controller.ki", 3.85e-5},
    {"controller.kd", 0},
    {"controller.delay", 0},
    {"controller.anti_windup", 0},
    {"command.hold", 1},
    {"initial.encoder_phase", 0.5},
    {"initial.position", 0},
    {"initial.hardening", 0},
    {"initial.preload", 0},
    {"verdict.dwell", 0.05},
    {"verdict.window", 0.05},
};

TEST(ParameterTable, DefaultsAreTheRigOfThePaper) {
  std::size_t with_default = 0;
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.per_move) continue;
    ++with_default;
    const auto expected = expected_defaults.find(std::string(parameter.name));
    ASSERT_NE(expected, expected_defaults.end()) << parameter.name;
    EXPECT_EQ(default_value(parameter), expected->second) << parameter.name;
  }
  EXPECT_EQ(with_default, expected_defaults.size());
}

TEST(ParameterTable, DefaultsAreInsideTheirRanges) {
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.per_move) continue;
    EXPECT_TRUE(contains(parameter.range, default_value(parameter))) << parameter.name;
  }
}

TEST(ParameterTable, EachRowWritesItsOwnFieldAndNoOther) {
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table[row].per_move) continue;
    TrialParameters changed;
    const double value = table[row].kind == ParameterKind::real ? 0.75 : 1.0;
    table[row].set(changed, value);
    for (std::size_t other = 0; other < table.size(); ++other) {
      if (table[other].per_move) continue;
      EXPECT_EQ(table[other].get(changed), other == row ? value : default_value(table[other]))
          << table[other].name;
    }
  }
}

TEST(ParameterTable, OnlyFrictionMayVaryAlongTheRotorAndGoesToTheSameField) {
  for (const Parameter& parameter : parameter_table()) {
    const bool friction = parameter.name.rfind("friction.", 0) == 0;
    ASSERT_EQ(parameter.profiled != nullptr, friction) << parameter.name;
    if (!friction) continue;
    TrialParameters changed;
    changed.friction.uniform.*parameter.profiled = 0.6;
    EXPECT_EQ(parameter.get(changed), 0.6) << parameter.name;
  }
}

TEST(ParameterTable, NamesAreUniqueAndGroupedBySection) {
  std::set<std::string_view> names;
  for (const Parameter& parameter : parameter_table()) EXPECT_TRUE(names.insert(parameter.name).second);
  const std::vector<std::string> sections = section_names();
  EXPECT_EQ(std::set<std::string>(sections.begin(), sections.end()).size(), sections.size());
}

TEST(ParameterTable, EveryRowIsDocumented) {
  for (const Parameter& parameter : parameter_table()) {
    EXPECT_FALSE(parameter.unit.empty() || parameter.meaning.empty() || parameter.source.empty())
        << parameter.name;
    EXPECT_EQ(parameter.words.empty(), parameter.kind != ParameterKind::enumeration) << parameter.name;
  }
}

TEST(ParameterTable, ListingsNameEveryParameter) {
  const std::string text = parameters_as_text();
  const std::string markdown = parameters_as_markdown();
  for (const Parameter& parameter : parameter_table()) {
    EXPECT_NE(text.find(parameter.name), std::string::npos);
    EXPECT_NE(markdown.find("| " + std::string(parameter.name) + " |"), std::string::npos);
  }
  EXPECT_NE(markdown.find("clamp \\| none"), std::string::npos);
}

}  // namespace
}  // namespace zerocount
