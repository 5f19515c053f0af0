#include "experiments/parameters/parameter_table.hpp"

#include "core/hash/sha256.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "tests/support/test.hpp"

namespace zerocount::parameters {
namespace {

// A results file has its manifest, but not the defaults: a default that changes needs a higher version of the
// results files (layout::format_version); then put the new digest here.
TEST(ParameterTable, DefaultsMatchTheVersionOfTheResultsFormat) {
  std::string defaults;
  for (const Parameter& parameter : parameter_table()) {
    if (!exists_on(parameter, AxisKind::rotary)) continue;
    defaults += std::string(parameter.name) + "=" + default_text(parameter) + "\n";
  }
  EXPECT_EQ(hash::sha256_hex(defaults), "39b90a32a9c47809671941cd9fe14d9db15a05db1429a22fa88fc30979129ae5")
      << defaults;
}

TEST(ParameterTable, DefaultsAreTheMachineOfThePaper) {
  const std::map<std::string_view, double> paper{{"plant.inertia", 5.54e-4},
                                                 {"plant.presliding_damping", 0.2},
                                                 {"friction.k1", 110},
                                                 {"friction.k2", 750},
                                                 {"encoder.fine", 1620000},
                                                 {"encoder.coarse", 86400},
                                                 {"dac.bits", 12},
                                                 {"dac.resolution", 2.4e-4},
                                                 {"controller.sample_rate", 2000},
                                                 {"controller.kp", 0},
                                                 {"controller.ki", 3.85e-5},
                                                 {"controller.kd", 0},
                                                 {"controller.encoder", 0},
                                                 {"controller.observer.inertia", 5.54e-4},
                                                 {"controller.coarse.observer.inertia", 5.54e-4}};
  for (const Parameter& parameter : parameter_table()) {
    if (!parameter.source.starts_with("paper")) continue;
    ASSERT_TRUE(paper.contains(parameter.name)) << parameter.name;
    EXPECT_EQ(default_value(parameter), paper.at(parameter.name)) << parameter.name;
  }
}

TEST(ParameterTable, DefaultsAreInsideTheirRanges) {
  for (const Parameter& parameter : parameter_table()) {
    if (!has_default(parameter)) continue;
    const double value = default_value(parameter);
    EXPECT_TRUE(parameter.none == value || numerics::contains(parameter.range, value)) << parameter.name;
  }
}

TEST(ParameterTable, OnlyListsLinearEncodersAndMeasuredValuesHaveNoDefault) {
  std::set<std::string_view> without;
  for (const Parameter& parameter : parameter_table()) {
    if (has_default(parameter)) continue;
    EXPECT_EQ(default_text(parameter), "none");
    if (has_value(parameter) && !is_measured(parameter.name)) without.insert(parameter.name);
  }
  EXPECT_EQ(without, (std::set<std::string_view>{"command.sequence.overrun", "encoder.resolution",
                                                 "encoder.coarse_resolution"}));
}

TEST(ParameterTable, EachRowSetsOnlyItsOwnField) {
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (!has_default(table[row]) || !has_value(table[row])) continue;
    if (table[row].name == "dac.range") {  // a trial has the resolution that follows
      EXPECT_EQ(table[row].set, nullptr);
      continue;
    }
    trial::TrialParameters changed;
    const double value = table[row].kind == ParameterKind::real ? 0.75 : 1.0;
    table[row].set(changed, value);
    for (std::size_t other = 0; other < table.size(); ++other) {
      if (!has_default(table[other]) || !has_value(table[other])) continue;
      EXPECT_EQ(table[other].get(changed), other == row ? value : default_value(table[other]))
          << table[other].name;
    }
  }
}

TEST(ParameterTable, OnlyFrictionNumbersMayVaryAlongTheRotor) {
  for (const Parameter& parameter : parameter_table()) {
    const bool friction = parameter.name.rfind("friction.", 0) == 0 && !has_labels(parameter) &&
                          has_value(parameter) && !is_measured(parameter.name);
    ASSERT_EQ(parameter.profiled != nullptr, friction) << parameter.name;
    if (!friction) continue;
    trial::TrialParameters changed;
    changed.friction.uniform.*parameter.profiled = 0.6;
    EXPECT_EQ(parameter.get(changed), 0.6) << parameter.name;
  }
}

TEST(ParameterTable, NamesAreUniqueAndGroupedBySection) {
  std::set<std::string_view> names;
  for (const Parameter& parameter : parameter_table()) EXPECT_TRUE(names.insert(parameter.name).second);
  std::set<std::string_view> sections;
  std::string_view last;
  for (const Parameter& parameter : parameter_table()) {
    const std::string_view section = parameter.name.substr(0, parameter.name.rfind('.'));
    // A section goes on after those inside it.
    const bool same = section == last || last.rfind(std::string(section) + ".", 0) == 0;
    EXPECT_TRUE(same || sections.insert(section).second) << parameter.name;
    last = section;
  }
}

TEST(ParameterTable, NoNameIsAlsoASection) {
  for (const Parameter& parameter : parameter_table()) EXPECT_FALSE(keys::is_section(parameter.name));
  EXPECT_TRUE(keys::is_section("controller"));
  EXPECT_TRUE(keys::is_section("controller.coarse"));
  EXPECT_FALSE(keys::is_section("controller.coars"));
}

TEST(ParameterTable, ASectionContainsTheKeysBelowItsName) {
  EXPECT_TRUE(keys::is_within("controller.coarse.kp", "controller.coarse"));
  EXPECT_TRUE(keys::is_within("controller.coarse.kp", "controller"));
  EXPECT_TRUE(keys::is_within("controller.coarse", "controller.coarse"));
  EXPECT_FALSE(keys::is_within("encoder.coarse_errors.noise", "encoder.coarse"));
  EXPECT_FALSE(keys::is_within("controller.coarse", "controller.coarse.kp"));
}

TEST(ParameterTable, SectionsHaveTheKeysOfTheirRowsAndSections) {
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys::keys_below("command"),
            (Keys{"targets", "torque", "sequence", "hold", "profile", "reference", "units"}));
  EXPECT_EQ(keys::keys_below("command.sequence"), (Keys{"targets", "overrun", "cycles", "approach"}));
  EXPECT_EQ(keys::keys_below("encoder"), (Keys{"fine", "coarse", "resolution", "coarse_resolution", "load",
                                               "fine_errors", "coarse_errors"}));
  EXPECT_EQ(keys::keys_below("initial.history"), (Keys{"reversals", "torque"}));
  EXPECT_TRUE(keys::keys_below("friction.k1").empty());
}

TEST(ParameterTable, EveryRowIsDocumented) {
  for (const Parameter& parameter : parameter_table()) {
    EXPECT_FALSE(parameter.unit.empty() || parameter.meaning.empty() || parameter.source.empty())
        << parameter.name;
    const bool numbers =
        parameter.kind == ParameterKind::real || parameter.kind == ParameterKind::whole_number;
    EXPECT_EQ(has_labels(parameter), !numbers) << parameter.name;
  }
}

TEST(ParameterTable, ListingsNameEveryParameter) {
  for (const AxisKind axis : {AxisKind::rotary, AxisKind::linear}) {
    std::map<std::string, manifest::ListedParameter> rows;
    for (const manifest::ListedParameter& row : manifest::listed_parameters({axis})) rows[row.name] = row;
    for (const Parameter& parameter : parameter_table())
      EXPECT_EQ(rows.contains(std::string(parameter.name)), exists_on(parameter, axis)) << parameter.name;
    EXPECT_EQ(rows["controller.anti_windup"].allowed, "clamp | none");
    EXPECT_EQ(rows["verdict.stop"].allowed, "false | true");
    EXPECT_EQ(rows["verdict.stop"].default_value, "false");
  }
}

}  // namespace
}  // namespace zerocount::parameters
