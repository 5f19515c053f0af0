#include "core/text/relation.hpp"

#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

struct WrittenSign {
  std::string_view text;
  Relation relation;
  bool below, at, above;  ///< whether the relation holds for a value below, at and above the limit
};

constexpr WrittenSign written_signs[] = {
    {"<", Relation::below, true, false, false},    {"<=", Relation::at_most, true, true, false},
    {"≤", Relation::at_most, true, true, false},   {">", Relation::above, false, false, true},
    {">=", Relation::at_least, false, true, true}, {"≥", Relation::at_least, false, true, true},
    {"=", Relation::equal, false, true, false},    {"==", Relation::equal, false, true, false},
    {"!=", Relation::unequal, true, false, true},  {"≠", Relation::unequal, true, false, true},
};

TEST(Comparison, IsReadWithAnySignAndAnyBlanks) {
  for (const WrittenSign& sign : written_signs) {
    for (const std::string_view blank : {"", " ", "\t  "}) {
      const std::string text = fmt::format("{0}band_exits[0]{0}{1}{0}-2e-3{0}", blank, sign.text);
      const std::optional<Comparison> comparison = parse_comparison(text);
      ASSERT_TRUE(comparison) << text;
      EXPECT_EQ(comparison->name, "band_exits[0]") << text;
      EXPECT_EQ(comparison->relation, sign.relation) << text;
      EXPECT_EQ(comparison->written, sign.text) << text;
      EXPECT_EQ(comparison->limit, "-2e-3") << text;
    }
  }
}

TEST(Relation, SignIsReadAsTheRelation) {
  for (const WrittenSign& sign : written_signs)
    EXPECT_EQ(parse_comparison(fmt::format("a {} 1", sign_of(sign.relation)))->relation, sign.relation);
}

TEST(Comparison, IsSplitAtTheFirstSign) {
  const std::optional<Comparison> comparison = parse_comparison("label = a>=b");
  ASSERT_TRUE(comparison);
  EXPECT_EQ(comparison->name, "label");
  EXPECT_EQ(comparison->limit, "a>=b");
  EXPECT_FALSE(parse_comparison("arrival_time 0.5"));
  EXPECT_FALSE(parse_comparison(""));
  EXPECT_EQ(parse_comparison(">")->name, "");
  EXPECT_EQ(parse_comparison(">")->limit, "");
}

TEST(Comparison, HasALimitIfItIsAFiniteNumber) {
  const std::optional<Limit> limit = limit_of(*parse_comparison("overshoot >= 2.5"));
  ASSERT_TRUE(limit);
  EXPECT_EQ(limit->relation, Relation::at_least);
  EXPECT_EQ(limit->value, 2.5);
  for (const char* const text : {"overshoot >", "overshoot > many", "overshoot > inf", "overshoot > nan"})
    EXPECT_FALSE(limit_of(*parse_comparison(text))) << text;
}

TEST(Relation, NeverHoldsForNaN) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const WrittenSign& sign : written_signs) {
    EXPECT_EQ(holds(sign.relation, 0.1, 0.2), sign.below) << sign.text;
    EXPECT_EQ(holds(sign.relation, 0.2, 0.2), sign.at) << sign.text;
    EXPECT_EQ(holds(sign.relation, infinity, 0.2), sign.above) << sign.text;
    EXPECT_FALSE(holds(sign.relation, std::numeric_limits<double>::quiet_NaN(), 0.2)) << sign.text;
  }
}

TEST(Relation, NegationHoldsExactlyIfTheRelationDoesNot) {
  for (const WrittenSign& sign : written_signs) {
    for (const double value : {0.1, 0.2, 0.3})
      EXPECT_NE(holds(negation(sign.relation), value, 0.2), holds(sign.relation, value, 0.2)) << sign.text;
    EXPECT_EQ(negation(negation(sign.relation)), sign.relation) << sign.text;
  }
}

}  // namespace
}  // namespace zerocount::text
