// Loops on all cores, and what a timeline shows of them.
#include "analysis/parallel/parallel.hpp"

#include <atomic>
#include <map>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/timeline/timeline.hpp"

namespace zerocount::testing {
namespace {

/// {name and kind of work of a span: how many}
std::map<std::pair<std::string, std::string>, int> spans_of(const timeline::Timeline& timeline) {
  std::map<std::pair<std::string, std::string>, int> counts;
  const nlohmann::json text = nlohmann::json::parse(timeline.trace_events());
  for (const nlohmann::json& event : text.at("traceEvents"))
    if (event.at("ph") == "X") ++counts[{event.at("name"), event.at("cat")}];
  return counts;
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
  EXPECT_EQ(spans_of(timeline),
            (std::map<std::pair<std::string, std::string>, int>{{{"all", "serial"}, 1},
                                                                {{"part", "serial"}, 1},
                                                                {{"outer", "parallel"}, 1 + 20},
                                                                {{"inner", "parallel"}, 20 * (1 + 3)}}));
}

TEST(Parallel, NothingIsRecordedWithoutATimeline) {
  const parallel::Recording recording(nullptr, "all");
  const parallel::Recording part("part");
  EXPECT_EQ(parallel::recording(), nullptr);
}

}  // namespace
}  // namespace zerocount::testing
