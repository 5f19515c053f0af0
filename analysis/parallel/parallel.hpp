#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

namespace zerocount::timeline {
class Timeline;
}

/// Work on all cores, without the headers of the library that does it.
namespace zerocount::parallel {

/// Threads that work in parallel at most.
int threads();

/// Calls `work` for each index below `count`, in parallel. @param name of each call in a timeline, a literal
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work,
                    std::string_view name = "task");

/// Whether `holds` is true of all indices below `count`, of which it may pass over some once one is false.
bool holds_for_all(std::size_t count, const std::function<bool(std::size_t)>& holds, std::string_view name);

/// Puts what this thread does during its lifetime into a timeline: one span of it all, and spans of each loop
/// over indices and of each of its calls, on any thread. What is in no loop is work for one thread.
class Recording {
 public:
  /// @param timeline null: nothing is recorded @param name of the span of it all, a literal
  Recording(timeline::Timeline* timeline, std::string_view name);
  /// A part of what this thread records.
  explicit Recording(std::string_view name);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  Recording(Recording&&) = delete;
  Recording& operator=(Recording&&) = delete;
  ~Recording();

 private:
  struct Whole;
  std::unique_ptr<Whole> whole_;
};

/// The timeline to which the work of this thread is recorded; null: none.
timeline::Timeline* recording();

/// Threads that work in parallel at most, during its lifetime.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ThreadLimit(ThreadLimit&&) = delete;
  ThreadLimit& operator=(ThreadLimit&&) = delete;
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace zerocount::parallel
