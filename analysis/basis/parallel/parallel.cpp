#include "analysis/basis/parallel/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "results/timeline/timeline.hpp"

namespace zerocount::parallel {
namespace {

/// The timeline that records what this thread does; null: nothing is recorded. A parallel loop passes it on
/// to the threads on which its calls run.
thread_local timeline::Timeline* recorded = nullptr;

/// Makes this thread record into the given timeline during the lifetime of the object; afterwards into the
/// one before.
class RecordedThere {
 public:
  explicit RecordedThere(timeline::Timeline* there) : before_(std::exchange(recorded, there)) {}
  RecordedThere(const RecordedThere&) = delete;
  RecordedThere& operator=(const RecordedThere&) = delete;
  ~RecordedThere() { recorded = before_; }

 private:
  timeline::Timeline* before_;
};

}  // namespace

int threads() {
  using oneapi::tbb::global_control;
  const auto limit = global_control::active_value(global_control::max_allowed_parallelism);
  return std::min(static_cast<int>(limit), oneapi::tbb::this_task_arena::max_concurrency());
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work, std::string_view name) {
  timeline::Timeline* const there = recorded;
  if (there == nullptr) {
    oneapi::tbb::parallel_for(std::size_t{0}, count, work);
    return;
  }
  const timeline::TimeSpan loop(there, name, timeline::Work::parallel);
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const RecordedThere on_this_thread(there);
    const timeline::TimeSpan call(there, name, timeline::Work::parallel);
    work(i);
  });
}

bool holds_for_all(std::size_t count, const std::function<bool(std::size_t)>& holds, std::string_view name) {
  std::atomic<bool> all = true;
  for_each_index(
      count,
      [&](std::size_t i) {
        if (all && !holds(i)) all = false;
      },
      name);
  return all;
}

struct Recording::Whole {
  timeline::Timeline* before;
  timeline::TimeSpan span;
};

Recording::Recording(timeline::Timeline* timeline, std::string_view name)
    : whole_(new Whole{std::exchange(recorded, timeline),
                       timeline::TimeSpan(timeline, name, timeline::Work::serial)}) {}

Recording::Recording(std::string_view name) : Recording(recorded, name) {}

Recording::~Recording() {
  recorded = whole_->before;
}

timeline::Timeline* recording() {
  return recorded;
}

struct ThreadLimit::Control {
  oneapi::tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          {oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)}}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace zerocount::parallel
