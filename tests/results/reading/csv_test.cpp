#include "results/reading/csv.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

TEST(NumberText, ReadsBackToTheSameDouble) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::strtod(reading::number_text(value).c_str(), nullptr), value);
  }
}

TEST(NumberText, IsShortAndNamesWhatIsNotANumber) {
  EXPECT_EQ(reading::number_text(0.1), "0.1");
  EXPECT_EQ(reading::number_text(-0.0), "-0");
  EXPECT_EQ(reading::number_text(3.85e-5), "3.85e-05");
  EXPECT_EQ(reading::number_text(0.0005), "0.0005");
  EXPECT_EQ(reading::number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(reading::number_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(reading::number_text(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(CsvFile, QuotesWhatNeedsQuotes) {
  const TemporaryFolder directory;
  reading::CsvFile csv(directory / "a.csv");
  csv.add("plain text");
  csv.add("a,b");
  csv.add("say \"no\"");
  csv.add("two\nlines");
  csv.add("");
  csv.end_row();
  csv.add(0.5);
  csv.add(std::int64_t{-7});
  csv.end_row();
  csv.finish();
  EXPECT_FALSE(std::filesystem::exists(directory / "a.csv")) << "it should have its name only when published";
  csv.publish();
  EXPECT_EQ(read_bytes(directory / "a.csv"),
            "plain text,\"a,b\",\"say \"\"no\"\"\",\"two\nlines\",\n0.5,-7\n");
}

TEST(Csv, AColumnHasItsUnitInBrackets) {
  EXPECT_EQ(reading::head_with_unit("settling_time", "s"), "settling_time [s]");
  EXPECT_EQ(reading::head_with_unit("friction.k1", "N m/rad"), "friction.k1 [N m/rad]");
  EXPECT_EQ(reading::head_with_unit("success_rate", "1"), "success_rate");
  EXPECT_EQ(reading::head_with_unit("case", ""), "case");
}

}  // namespace
}  // namespace zerocount::testing
