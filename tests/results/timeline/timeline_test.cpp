// A timeline is a text that viewers of the Trace Event Format open.
#include "results/timeline/timeline.hpp"

#include <nlohmann/json.hpp>
#include <oneapi/tbb/parallel_for.h>

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using timeline::Timeline;
using timeline::TimeSpan;
using timeline::Work;

void work_in_spans(Timeline* timeline) {
  oneapi::tbb::parallel_for(std::size_t{0}, std::size_t{50}, [timeline](std::size_t index) {
    const TimeSpan outer(timeline, "outer", Work::parallel, static_cast<std::int64_t>(index));
    for (int i = 0; i < 3; ++i) const TimeSpan inner(timeline, "inner", Work::serial);
  });
}

/// The spans (pieces of work with begin and end) of a timeline, in its JSON form.
nlohmann::json spans_of(const Timeline& timeline) {
  nlohmann::json spans = nlohmann::json::array();
  const nlohmann::json text = nlohmann::json::parse(timeline.trace_events());
  for (const nlohmann::json& event : text.at("traceEvents"))
    if (event.at("ph") == "X") spans.push_back(event);
  return spans;
}

TEST(Timeline, HasASpanForEveryStage) {
  Timeline timeline;
  work_in_spans(&timeline);
  std::map<std::string, std::int64_t> counts;
  std::int64_t trials = 0;
  for (const nlohmann::json& span : spans_of(timeline)) {
    ++counts[span.at("name").get<std::string>()];
    EXPECT_EQ(span.at("cat"), span.at("name") == "outer" ? "parallel" : "serial");
    EXPECT_GE(span.at("ts").get<std::int64_t>(), 0);
    EXPECT_GE(span.at("dur").get<std::int64_t>(), 0);
    trials += span.at("args").at("trials").get<std::int64_t>();
  }
  EXPECT_EQ(counts, (std::map<std::string, std::int64_t>{{"inner", 150}, {"outer", 50}}));
  EXPECT_EQ(trials, 50 * 49 / 2);
}

// Viewers draw the spans of a thread in one another: two that overlap by a part would be drawn wrong.
TEST(Timeline, SpansOfAThreadAreNestedOrDisjoint) {
  Timeline timeline;
  work_in_spans(&timeline);
  std::map<int, std::vector<std::pair<std::int64_t, std::int64_t>>> of_threads;
  for (const nlohmann::json& span : spans_of(timeline)) {
    const auto begin = span.at("ts").get<std::int64_t>();
    of_threads[span.at("tid")].emplace_back(begin, begin + span.at("dur").get<std::int64_t>());
  }
  for (const auto& [thread, spans] : of_threads) {
    for (const auto& one : spans) {
      for (const auto& other : spans) {
        const bool overlap_by_a_part =
            one.first < other.first && other.first < one.second && one.second < other.second;
        EXPECT_FALSE(overlap_by_a_part) << thread;
      }
    }
  }
}

TEST(Timeline, IsRecognisedByItsFirstBytes) {
  EXPECT_TRUE(timeline::is_timeline(Timeline().trace_events()));
  EXPECT_FALSE(timeline::is_timeline("{}"));
  EXPECT_FALSE(timeline::is_timeline(""));
}

TEST(TimeSpan, IsNotRecordedWithoutATimeline) {
  Timeline timeline;
  {
    const TimeSpan recorded(&timeline, "recorded", Work::serial, 1);
    const TimeSpan dropped(nullptr, "dropped", Work::serial, 2);
    work_in_spans(nullptr);
  }
  const nlohmann::json spans = spans_of(timeline);
  ASSERT_EQ(spans.size(), 1U) << spans;
  EXPECT_EQ(spans[0].at("name"), "recorded");
  EXPECT_EQ(spans[0].at("args").at("trials"), 1);
}

}  // namespace
}  // namespace zerocount::testing
