#pragma once

#include <cstddef>
#include <functional>
#include <memory>

/// Work on all cores, without the headers of the library that does it.
namespace zerocount::parallel {

/// Threads that work in parallel at most.
int threads();

/// Calls `work` for each index below `count`, in parallel.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

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
