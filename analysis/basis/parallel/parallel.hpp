#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

namespace zerocount::timeline {
class Timeline;
}

/// Parallel loops on all processor cores, behind an interface that does not include the headers of the
/// library (oneTBB).
namespace zerocount::parallel {

/// Largest number of threads that may work in parallel here: a limit by ThreadLimit, or the cores.
int threads();

/// Calls `work` for each index from 0 to count − 1, in parallel, and returns when all calls have ended.
/// @param name name of each call in a timeline; a string literal, because it is not copied
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work,
                    std::string_view name = "task");

/// Whether `holds` is true for all indices from 0 to count − 1, tested in parallel. Once it is false for one,
/// further indices may be skipped.
bool holds_for_all(std::size_t count, const std::function<bool(std::size_t)>& holds, std::string_view name);

/// Records the work of this thread during the lifetime of the object in a timeline: one span for the whole, a
/// span for each loop over indices, and a span for each call in a loop, on any thread. Work outside loops is
/// work for one thread.
class Recording {
 public:
  /// @param timeline records the work; null: nothing is recorded
  /// @param name name of the span for the whole work; a string literal
  Recording(timeline::Timeline* timeline, std::string_view name);
  /// Records a part of the work as a span of its own, in the timeline to which this thread already records.
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

/// Limits the number of threads that work in parallel during the lifetime of the object.
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
