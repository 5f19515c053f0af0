#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace zerocount::timeline {

/// Whether only one thread at a time can do the work of a span (serial), or several can (parallel).
enum class Work { serial, parallel };

/// Record of the work of the program's threads over time. Any thread may add to it.
class Timeline {
 public:
  using Clock = std::chrono::steady_clock;

  /// A time span, from `begin` to `end`, in which one thread did one kind of work.
  struct Span {
    std::string_view name;
    Work work{Work::serial};
    std::int64_t trials{0};  ///< Number of trials of the study that the work concerned; 0 for other work
    Clock::time_point begin{};
    Clock::time_point end{};
    double processor_seconds{0.0};  ///< Processor time of the thread, s; less than the duration if it waited
  };
  void add(const Span& span);

  /// The recorded spans as text in the Trace Event Format ("X" events), which Perfetto and chrome://tracing
  /// show: a row for each thread, times in µs (`tdur` is processor time), and the kind of work as the
  /// category.
  std::string trace_events() const;

 private:
  struct Event {
    Span span;
    int thread;  ///< Number of the thread, in the order in which threads first added a span
  };

  mutable std::mutex mutex_;
  Clock::time_point start_{Clock::now()};
  std::map<std::thread::id, int> threads_;
  std::vector<Event> events_;
};

/// Whether a text begins like the text of a timeline, as trace_events() makes it.
bool is_timeline(std::string_view text);

/// Processor time of the calling thread so far, s.
double processor_seconds();

/// Measures the time between its construction and destruction, and adds it to a timeline as a span.
class TimeSpan {
 public:
  /// @param timeline may be null; then nothing is done.
  /// @param name must live as long as the timeline.
  TimeSpan(Timeline* timeline, std::string_view name, Work work, std::int64_t trials = 0)
      : timeline_(timeline), span_{name, work, trials} {
    if (timeline_ == nullptr) return;
    span_.processor_seconds = -processor_seconds();
    span_.begin = Timeline::Clock::now();
  }
  TimeSpan(const TimeSpan&) = delete;
  TimeSpan& operator=(const TimeSpan&) = delete;
  ~TimeSpan() {
    if (timeline_ == nullptr) return;
    span_.end = Timeline::Clock::now();
    span_.processor_seconds += processor_seconds();
    timeline_->add(span_);
  }

 private:
  Timeline* timeline_;
  Timeline::Span span_;
};

}  // namespace zerocount::timeline
