// What a task may spend: trials and time, counted in one place.
#include "runners/trials/effort.hpp"

#include "tests/support/test.hpp"

namespace zerocount::trials {
namespace {

using std::chrono::milliseconds;

TEST(Effort, WithoutLimitsIsNeverSpent) {
  const Effort effort;
  effort.spend(std::int64_t{1} << 40);
  EXPECT_FALSE(effort.is_spent());
  EXPECT_EQ(effort.seconds_left(), std::numeric_limits<double>::infinity());
}

// However the whole is divided, its trials are not exceeded, and what a share leaves stays with the whole.
TEST(Effort, NeverSpendsMoreTrialsThanItHas) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> number(1, 400);
  for (int round = 0; round < 200; ++round) {
    const std::int64_t limit = number(random);
    const Effort whole = Effort().share(limit, {});
    std::vector<Effort> efforts{whole};
    std::int64_t counted = 0;
    for (int i = 0; i < 30; ++i) {
      const Effort one = efforts[static_cast<std::size_t>(number(random)) % efforts.size()];
      if (i % 3 == 0) efforts.push_back(one.share(number(random), {}));
      const std::int64_t trials = number(random) / 8;
      const std::int64_t left = one.trials_left();
      const bool enough = within(one, [&] { one.spend(trials); });
      EXPECT_EQ(enough, trials <= left);
      counted += enough ? trials : 0;
    }
    EXPECT_LE(counted, limit);
    EXPECT_EQ(whole.spent_trials(), counted);
    EXPECT_EQ(whole.trials_left(), limit - counted);
  }
}

// Equal parts, taken one after the other, are all that there is; what one of them leaves goes to the later
// ones.
TEST(Effort, IsDividedIntoEqualParts) {
  const Effort whole = Effort().share(1000, 60.0);
  for (std::int64_t left = 4; left > 0; --left) {
    const Effort part = whole.part(left);
    EXPECT_EQ(part.trials_left(), whole.trials_left() / left);
    EXPECT_NEAR(part.seconds_left(), 60.0 / static_cast<double>(left), 1.0);
    part.spend(left == 3 ? 10 : part.trials_left());
  }
  EXPECT_EQ(whole.trials_left(), 0);
  EXPECT_EQ(Effort().part(3).trials_left(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(Effort().part(3).seconds_left(), std::numeric_limits<double>::infinity());
}

TEST(Effort, StopsWhatRunsWhenItsTimeIsOver) {
  const Effort whole = Effort().share({}, 60.0);
  const auto start = std::chrono::steady_clock::now();
  const Effort part = whole.share({}, 0.05);
  const bool ended = within(part, [&] {
    while (!part.stop().stop_requested()) std::this_thread::sleep_for(milliseconds(1));
    throw trial::Interrupted{};
  });
  EXPECT_FALSE(ended);
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(50));
  EXPECT_TRUE(part.is_spent());
  EXPECT_FALSE(part.is_interrupted());
  EXPECT_FALSE(whole.is_spent());
}

TEST(Effort, TellsARequestToStopFromTheEndOfItsTime) {
  std::stop_source user;
  const Effort part = Effort(user.get_token()).share(1000, 60.0).share({}, 30.0);
  user.request_stop();
  EXPECT_TRUE(part.stop().stop_requested());
  EXPECT_TRUE(part.is_interrupted());
  EXPECT_THROW(within(part, [] { throw trial::Interrupted{}; }), trial::Interrupted);
}

}  // namespace
}  // namespace zerocount::trials
