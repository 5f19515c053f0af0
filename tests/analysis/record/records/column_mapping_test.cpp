// QUANTITY=COLUMN[UNIT]FACTORS: what each text means, and why others are refused.
#include "analysis/record/records/column_mapping.hpp"

#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

using records::ColumnMapping;
using records::Quantity;

ColumnMapping mapping(const std::string& text) {
  const records::ParsedMapping parsed = records::parse_mapping(text);
  EXPECT_EQ(parsed.fault, "") << text;
  return parsed.mapping;
}

std::string fault(const std::string& text) {
  return records::parse_mapping(text).fault;
}

TEST(ColumnMappings, AreParsedFromTheEnd) {
  EXPECT_EQ(mapping("time=t").column, "t");
  EXPECT_FALSE(mapping("time=t").unit);
  EXPECT_EQ(mapping("torque=current[A]*0.87").quantity, Quantity::torque);
  EXPECT_EQ(mapping("torque=current[A]*0.87").column, "current");
  EXPECT_EQ(mapping("torque=current[A]*0.87").factor, 0.87);
  EXPECT_DOUBLE_EQ(*mapping("angle = pos [mm] / 10 * -2").factor, -0.2);
  EXPECT_FALSE(mapping("angle=pos[mrad]").factor);
  // Without a unit everything is the name; with one, the last brackets are it.
  EXPECT_EQ(mapping("angle=/group/x/2").column, "/group/x/2");
  EXPECT_EQ(mapping("angle=a*b").column, "a*b");
  EXPECT_EQ(mapping("torque=Ch1[raw][mN m]").column, "Ch1[raw]");
  EXPECT_EQ(mapping("repetition=#4").column, "#4");
}

TEST(ColumnMappings, UnitsHaveTheirSiFactors) {
  const std::pair<const char*, double> values[] = {{"s", 1},
                                                   {"ms", 1e-3},
                                                   {"us", 1e-6},
                                                   {"µs", 1e-6},
                                                   {"μs", 1e-6},
                                                   {"N m", 1},
                                                   {"Nm", 1},
                                                   {"N·m", 1},
                                                   {"N*m", 1},
                                                   {"mN m", 1e-3},
                                                   {"mNm", 1e-3},
                                                   {"rad", 1},
                                                   {"mrad", 1e-3},
                                                   {"urad", 1e-6},
                                                   {"deg", std::numbers::pi / 180},
                                                   {"°", std::numbers::pi / 180},
                                                   {"arcsec", std::numbers::pi / 648000},
                                                   {"rev", 2 * std::numbers::pi},
                                                   {"m", 1},
                                                   {"mm", 1e-3},
                                                   {"um", 1e-6},
                                                   {"nm", 1e-9},
                                                   {"A", 1},
                                                   {"mA", 1e-3},
                                                   {"V", 1},
                                                   {"count", 1},
                                                   {"N", 1},
                                                   {"kN", 1e3}};
  for (const auto& [name, si] : values) {
    ASSERT_TRUE(text::unit_named(name)) << name;
    EXPECT_DOUBLE_EQ(text::unit_named(name)->si, si) << name;
  }
  for (const char* name : {"", "furlong", "S", "nM", "seconds?"})
    EXPECT_FALSE(text::unit_named(name)) << name;
}

TEST(ColumnMappings, ACountHasManyNamesInAnyCase) {
  for (const char* name : {"count", "Counts", "CTS", "ct", "cnts", "inc", "Inc.", "INCR", "increments",
                           "Inkr", "ticks", "LSB", "lsbs", "pulses", "Enc Counts", "qc", "digits", "1"}) {
    ASSERT_TRUE(text::unit_named(name)) << name;
    EXPECT_EQ(text::unit_named(name)->dimension, text::Dimension::count) << name;
  }
  // Case tells milli from mega, and N m from nm: other units keep theirs.
  for (const char* name : {"MM", "NM", "RAD", "incs/s", "s", "countss"}) {
    const std::optional<text::Unit> unit = text::unit_named(name);
    EXPECT_TRUE(!unit || unit->dimension != text::Dimension::count) << name;
  }
}

TEST(ColumnMappings, MistakesAreNamed) {
  EXPECT_EQ(
      fault("speed=v"),
      "'speed=v': expected QUANTITY=COLUMN, with QUANTITY one of time, torque, drive_torque, angle, force, "
      "drive_force, position, repetition");
  EXPECT_NE(fault("torque").find("expected QUANTITY=COLUMN"), std::string::npos);
  EXPECT_EQ(fault("torque="), "'torque=': the column is missing after '='");
  EXPECT_EQ(fault("torque=[A]"), "'torque=[A]': the column is missing after '='");
  EXPECT_NE(fault("time=t[fortnight]").find("'fortnight' is not a known unit; expected one of s, ms"),
            std::string::npos);
  for (const char* text : {"torque=i[A]0.87", "torque=i[A]*", "torque=i[A]*x", "torque=i[A]/0",
                           "torque=i[A]*nan", "torque=i[A]*2+1"}) {
    EXPECT_NE(fault(text).find("expected factors *NUMBER or /NUMBER other than 0"), std::string::npos)
        << text;
  }
  EXPECT_EQ(fault("repetition=n[s]"), "'repetition=n[s]': a repetition has no unit");
}

}  // namespace
}  // namespace zerocount::testing
