#include "analysis/text/text.hpp"
#include "core/text/text.hpp"
#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

struct WrittenSign {
  std::string_view text;
  Sign sign;
  bool below, at, above;  ///< whether the relation holds for a value below, at and above the limit
};

constexpr WrittenSign written_signs[] = {
    {"<", Sign::below, true, false, false},    {"<=", Sign::at_most, true, true, false},
    {"≤", Sign::at_most, true, true, false},   {">", Sign::above, false, false, true},
    {">=", Sign::at_least, false, true, true}, {"≥", Sign::at_least, false, true, true},
    {"=", Sign::equal, false, true, false},    {"==", Sign::equal, false, true, false},
    {"!=", Sign::unequal, true, false, true},  {"≠", Sign::unequal, true, false, true},
};

TEST(Relation, IsReadWithAnySignAndAnyBlanks) {
  for (const WrittenSign& sign : written_signs) {
    for (const std::string_view blank : {"", " ", "\t  "}) {
      const std::string text = fmt::format("{0}band_exits[0]{0}{1}{0}-2e-3{0}", blank, sign.text);
      const std::optional<Relation> relation = parse_relation(text);
      ASSERT_TRUE(relation) << text;
      EXPECT_EQ(relation->name, "band_exits[0]") << text;
      EXPECT_EQ(relation->sign, sign.sign) << text;
      EXPECT_EQ(relation->written, sign.text) << text;
      EXPECT_EQ(relation->limit, "-2e-3") << text;
    }
  }
}

TEST(Relation, IsSplitAtTheFirstSign) {
  const std::optional<Relation> relation = parse_relation("label = a>=b");
  ASSERT_TRUE(relation);
  EXPECT_EQ(relation->name, "label");
  EXPECT_EQ(relation->limit, "a>=b");
  EXPECT_FALSE(parse_relation("arrival_time 0.5"));
  EXPECT_FALSE(parse_relation(""));
  EXPECT_EQ(parse_relation(">")->name, "");
  EXPECT_EQ(parse_relation(">")->limit, "");
}

TEST(Relation, NeverHoldsForNaN) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const WrittenSign& sign : written_signs) {
    EXPECT_EQ(holds(sign.sign, 0.1, 0.2), sign.below) << sign.text;
    EXPECT_EQ(holds(sign.sign, 0.2, 0.2), sign.at) << sign.text;
    EXPECT_EQ(holds(sign.sign, infinity, 0.2), sign.above) << sign.text;
    EXPECT_FALSE(holds(sign.sign, std::numeric_limits<double>::quiet_NaN(), 0.2)) << sign.text;
  }
}

TEST(Trimmed, LosesBlanksAtBothEndsOnly) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(" \"a\" ", " \""), "a");
}

}  // namespace
}  // namespace zerocount::text
