#include "results/timeline/timeline.hpp"

#include <ctime>

#include <fmt/format.h>

namespace zerocount::timeline {
namespace {

constexpr std::string_view text_start = R"({"displayTimeUnit": "ms", "traceEvents": [)";

std::int64_t microseconds(Timeline::Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::microseconds>(duration).count();
}

}  // namespace

void Timeline::add(const Span& span) {
  const std::lock_guard lock(mutex_);
  const int thread =
      threads_.try_emplace(std::this_thread::get_id(), static_cast<int>(threads_.size())).first->second;
  events_.push_back({span, thread});
}

std::string Timeline::trace_events() const {
  const std::lock_guard lock(mutex_);
  std::string text = fmt::format("{}\n", text_start);
  for (std::size_t thread = 0; thread < threads_.size(); ++thread) {
    text += fmt::format(
        R"({{"name": "thread_name", "ph": "M", "pid": 1, "tid": {0}, "args": {{"name": "thread {0}"}}}},)",
        thread);
    text += '\n';
  }
  for (const auto& [span, thread] : events_) {
    // Both ends are rounded, not the duration, so that spans in spans stay there.
    const std::int64_t begin = microseconds(span.begin - start_);
    const std::int64_t end = microseconds(span.end - start_);
    text += fmt::format(R"({{"name": "{}", "cat": "{}", "ph": "X", "pid": 1, "tid": {}, )", span.name,
                        span.work == Work::serial ? "serial" : "parallel", thread);
    text += fmt::format(R"("ts": {}, "dur": {}, "tdur": {:.0f}, "args": {{"trials": {}}}}},)", begin,
                        end - begin, 1e6 * span.processor_seconds, span.trials);
    text += '\n';
  }
  text += R"({"name": "process_name", "ph": "M", "pid": 1, "args": {"name": "zerocount"}}]})";
  return text + '\n';
}

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool is_timeline(std::string_view text) {
  return text.starts_with(text_start);
}

}  // namespace zerocount::timeline
