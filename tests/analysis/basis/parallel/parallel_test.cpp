// Loops on all cores, and what a timeline shows of them.
#include "analysis/basis/parallel/parallel.hpp"

#include "results/timeline/timeline.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Number of spans (pieces of work with begin and end) in the timeline that have this name and this kind of
/// work.
int spans(const timeline::Timeline& timeline, const std::string& name, const std::string& work) {
  const std::string wanted = R"({"name": ")" + name + R"(", "cat": ")" + work + '"';
  const std::string text = timeline.trace_events();
  int count = 0;
  for (auto at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at + 1)) ++count;
  return count;
}

TEST(Parallel, AConditionHoldsForAllIndicesOrIsFalseForOne) {
  std::mt19937_64 random(31);
  for (int round = 0; round < 200; ++round) {
    const auto count = std::uniform_int_distribution<std::size_t>(0, 40)(random);
    const auto broken = std::uniform_int_distribution<std::size_t>(0, 80)(random);
    std::atomic<std::size_t> asked = 0;
    const bool holds = parallel::holds_for_all(
        count,
        [&](std::size_t i) {
          ++asked;
          return i != broken;
        },
        "task");
    EXPECT_EQ(holds, broken >= count);
    EXPECT_TRUE(!holds || asked == count);
  }
}

// Loops in loops run on other threads too: they are recorded as well.
TEST(Parallel, ARecordingHasALoopAndItsCallsOnAllThreads) {
  timeline::Timeline timeline;
  const auto work = [] {
    parallel::for_each_index(
        20,
        [](std::size_t) {
          parallel::for_each_index(
              3, [](std::size_t) {}, "inner");
        },
        "outer");
  };
  work();
  {
    const parallel::Recording recording(&timeline, "all");
    EXPECT_EQ(parallel::recording(), &timeline);
    const parallel::Recording part("part");
    work();
  }
  work();
  EXPECT_EQ(parallel::recording(), nullptr);
  EXPECT_EQ(spans(timeline, "all", "serial"), 1);
  EXPECT_EQ(spans(timeline, "part", "serial"), 1);
  EXPECT_EQ(spans(timeline, "outer", "parallel"), 1 + 20);
  EXPECT_EQ(spans(timeline, "inner", "parallel"), 20 * (1 + 3));
}

TEST(Parallel, NothingIsRecordedWithoutATimeline) {
  const parallel::Recording recording(nullptr, "all");
  const parallel::Recording part("part");
  EXPECT_EQ(parallel::recording(), nullptr);
}

}  // namespace
}  // namespace zerocount::testing
