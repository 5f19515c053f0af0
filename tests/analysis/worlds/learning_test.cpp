// A measurement of the parameter that separates good worlds from bad ones decides most of them.
#include "analysis/worlds/learning.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::worlds {
namespace {

/// Worlds that are bad where the first of three parameters is above 1.2.
struct Worlds {
  std::vector<WorldInput> inputs{
      {"friction.n", "1", {}}, {"friction.alpha", "1/s", {}}, {"friction.x", "1", {}}};
  std::vector<bool> bad;

  Worlds(std::uint64_t seed, int count) {
    testing::Draws draws(seed);
    for (int world = 0; world < count; ++world) {
      for (WorldInput& input : inputs) input.values.push_back(draws.uniform(0.5, 1.5));
      bad.push_back(inputs[0].values.back() > 1.2);
    }
  }
};

std::int64_t all_of(const Learned& learned) {
  return learned.decided() + learned.misjudged() + learned.open;
}

TEST(Learning, NamesTheParameterThatDecides) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Worlds worlds(seed, 100);
    const std::vector<Learned> learned = what_to_learn(worlds.inputs, worlds.bad, 0.05, seed);
    ASSERT_EQ(learned.size(), 3U);
    for (const Learned& one : learned) EXPECT_EQ(all_of(one), 100);
    EXPECT_EQ(learned[0].input, 0U);
    // A world within 5 % of the threshold, 0.06 of a range of 1 on either side, stays open.
    EXPECT_GT(learned[0].decided(), 75);
    EXPECT_GT(learned[0].decided_bad, 10);
    EXPECT_LE(learned[0].misjudged(), 2);  // next to the threshold
    EXPECT_LT(learned[1].decided(), 50);
    EXPECT_LT(learned[0].p_value, 0.02);
  }
}

TEST(Learning, DecidesMoreTheMorePreciseTheMeasurement) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Worlds worlds(seed, 200);
    std::int64_t before = 0;
    for (const double precision : {0.3, 0.1, 0.03, 0.01}) {
      const Learned learned = what_to_learn(worlds.inputs, worlds.bad, precision, seed).front();
      EXPECT_GE(learned.decided(), before) << seed << " " << precision;
      before = learned.decided();
    }
  }
}

// A world that is unlike all others near it is misjudged, and not a decision.
TEST(Learning, DoesNotLetAWorldJudgeItself) {
  WorldInput input{"friction.n", "1", {}};
  std::vector<bool> bad;
  for (int world = 0; world < 21; ++world) {
    input.values.push_back(1.0 + 0.001 * world);
    bad.push_back(world == 10);
  }
  const Learned learned = what_to_learn({input}, bad, 0.5, 1).front();
  EXPECT_EQ(learned.misjudged(), 1);
  EXPECT_EQ(learned.open, 20);
  EXPECT_EQ(learned.decided(), 0);
}

// Few bad worlds that no unknown shows: a measurement "decides" most worlds for good and finds no bad one. To
// call all worlds good does as well.
TEST(Learning, DoesNotAdviseWhatFindsNoBadWorld) {
  WorldInput input{"friction.n", "1", {}};
  std::vector<bool> bad;
  for (int world = 0; world < 40; ++world) {
    input.values.push_back(1.0 + 0.5 * world);
    bad.push_back(world % 20 == 10);
  }
  const Learned learned = what_to_learn({input}, bad, 0.01, 1).front();
  EXPECT_GT(learned.decided(), 25);
  EXPECT_EQ(learned.decided_bad, 0);
  EXPECT_EQ(learned.missed_bad, 2);
  EXPECT_FALSE(learned.does_better_than_no_measurement());
}

// What a measurement says of the worlds, and "all are good" or "all are bad" of those that it leaves open, is
// right more often than the word alone.
TEST(Learning, DoesBetterWhereItIsRightMoreOftenThanAWordForAll) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Worlds worlds(seed, 30);
    for (const Learned& one : what_to_learn(worlds.inputs, worlds.bad, 0.05, seed)) {
      const std::int64_t bad = std::count(worlds.bad.begin(), worlds.bad.end(), true);
      const std::int64_t open_bad = bad - one.decided_bad - one.missed_bad;
      const std::int64_t open_good = 30 - bad - one.decided_good - one.rejected_good;
      EXPECT_EQ(open_bad + open_good, one.open);
      EXPECT_EQ(one.does_better_than_no_measurement(),
                one.decided() + open_good > 30 - bad && one.decided() + open_bad > bad)
          << seed;
    }
  }
}

// Where one world in thirty is bad, an unknown that does not matter decides most worlds too.
TEST(Learning, IsNotTakenInByChance) {
  int shown = 0;
  constexpr int data_sets = 100;
  for (std::uint64_t seed = 1; seed <= data_sets; ++seed) {
    Worlds worlds(seed, 30);
    testing::Draws draws(seed + 1000);
    for (std::size_t world = 0; world < 30; ++world) worlds.bad[world] = draws.chance(0.1);
    shown += what_to_learn(worlds.inputs, worlds.bad, 0.1, seed).front().p_value <= 0.05;
  }
  EXPECT_LE(shown, 12);  // 5 and three standard deviations
}

TEST(Learning, KnowsTheRecordsOfTheFriction) {
  EXPECT_TRUE(record_of("friction.n").starts_with("constant torques"));
  EXPECT_TRUE(record_of("friction.breakaway").starts_with("strokes"));
  EXPECT_TRUE(record_of("encoder.fine").empty());
}

}  // namespace
}  // namespace zerocount::worlds
