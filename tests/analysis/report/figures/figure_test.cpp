#include "analysis/report/figures/figure.hpp"

#include <regex>

#include "tests/results/failures.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

TEST(Datum, KeepsTheDigitsAskedFor) {
  EXPECT_EQ(datum(0.123456789).dump(), "0.123457");
  EXPECT_EQ(datum(0.123456789, 3).dump(), "0.123");
  EXPECT_EQ(datum(3.0).dump(), "3");
  EXPECT_EQ(datum(-2.0e-5).dump(), "-2e-05");
  EXPECT_TRUE(datum(std::nan("")).is_null());
  EXPECT_TRUE(datum(std::numeric_limits<double>::infinity()).is_null());
}

TEST(SpacedByRatio, TellsTheTwoSpacingsApart) {
  EXPECT_TRUE(spaced_by_ratio({1e-5, 1e-4, 1e-3}));
  EXPECT_TRUE(spaced_by_ratio({2.0e-5, 2.44211e-5, 2.98195e-5, 3.64113e-5}));
  EXPECT_FALSE(spaced_by_ratio({1.0, 2.0, 3.0, 4.0}));
  EXPECT_FALSE(spaced_by_ratio({0.0, 1.0, 10.0}));
  EXPECT_FALSE(spaced_by_ratio({1.0, 10.0}));
}

TEST(Specifications, AreVegaLiteOfDataByName) {
  int specifications = 0;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".vl.json")) continue;
    ++specifications;
    const auto json = nlohmann::ordered_json::parse(file.bytes);
    EXPECT_EQ(json["$schema"], "https://vega.github.io/schema/vega-lite/v6.json") << file.name;
    EXPECT_EQ(std::string(file.bytes).find("\"url\""), std::string::npos) << file.name;
    EXPECT_NE(std::string(file.bytes).find("\"tooltip\""), std::string::npos) << file.name;
  }
  EXPECT_GE(specifications, 13);
}

/// Both sets of colours have every colour that a figure names.
TEST(Specifications, NameColoursThatThereAre) {
  const auto colours = nlohmann::ordered_json::parse(embedded_file("colours.json"));
  const std::regex name("var\\((--[a-z0-9-]+)\\)");
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".json") && !file.name.ends_with(".css")) continue;
    const std::string text(file.bytes);
    for (auto match = std::sregex_iterator(text.begin(), text.end(), name); match != std::sregex_iterator();
         ++match) {
      EXPECT_TRUE(colours["light"].contains((*match)[1].str())) << file.name << ": " << (*match)[1];
      EXPECT_TRUE(colours["dark"].contains((*match)[1].str())) << file.name << ": " << (*match)[1];
    }
  }
}

TEST(EmbeddedFiles, WhatIsMissingIsSaidWithWhatToDo) {
  testing::expect_failure(ExitCode::machine_failed, "npm ci", [] { embedded_file("vega.max.js"); });
}

}  // namespace
}  // namespace zerocount::report
