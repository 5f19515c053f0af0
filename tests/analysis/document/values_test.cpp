// Values of answers that read back to the same number.
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

template <class Number>
struct Holder {
  Number number;
};

template <class Number>
Answer answer_with(Number number) {
  AnswerDescription<Holder<Number>> description{{.name = "holder", .meaning = "a number"}, {}};
  description.items.value({.key = "number", .heading = "number"}, &Holder<Number>::number);
  return description.of({number});
}

template <class Number>
void expect_kept(Number number) {
  const Answer answer = answer_with(number);
  EXPECT_EQ(json(answer)["number"].get<Number>(), number);
  EXPECT_NE(text(answer).find(std::to_string(number)), std::string::npos) << text(answer);
}

// A seed is any of 64 bits.
TEST(Values, WholeNumbersKeepAllTheirBits) {
  expect_kept(std::numeric_limits<std::uint64_t>::max());
  expect_kept(std::numeric_limits<std::int64_t>::min());
}

TEST(Values, WithoutBoundsAreShownWithoutThem) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(text(answer_with(Bounded{0.5, unknown, unknown})), "number: 0.5\n");
  EXPECT_EQ(text(answer_with(Bounded{0.5, unknown, 1.0})), "number: 0.5 [–, 1]\n");
  EXPECT_EQ(text(answer_with(Bounded{unknown, unknown, unknown})), "");
}

// An answer without a table in CSV has one line there: its values, and those of its objects.
TEST(Values, AreALineOfCsvWhereNoTableIs) {
  using Inner = Holder<double>;
  AnswerDescription<Inner> description{{.name = "holder", .meaning = "a number"}, {}};
  description.items.value({.key = "number", .heading = "number"}, &Inner::number)
      .object({.key = "part", .heading = "part"},
              Description<Inner>().value({.key = "twice", .heading = "twice"},
                                         [](const Inner& inner) { return 2.0 * inner.number; }),
              [](const Inner& inner) { return inner; });
  EXPECT_EQ(csv(description.of({0.1})), "number,part_twice\n0.1,0.2\n");
}

// The schema lets be null what may be missing, and nothing else.
TEST(Values, OfAPartAreNullableWhereThePartMayBeMissing) {
  using Part = Holder<double>;
  const auto part = Description<Part>().value({.key = "number", .heading = "number"}, &Part::number);
  const auto there = Description<Part>().include(part, [](const Part& whole) { return whole; });
  EXPECT_FALSE(there.items()[0].nullable);
  const auto missing = Description<Part>().include(part, [](const Part&) { return std::optional<Part>(); });
  EXPECT_TRUE(missing.items()[0].nullable);
  EXPECT_TRUE(missing.members_of({1.0}).contents[0].is_empty());
}

}  // namespace
}  // namespace zerocount::document
