#include "analysis/parallel/parallel.hpp"

#include <algorithm>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace zerocount::parallel {

int threads() {
  using oneapi::tbb::global_control;
  const auto limit = global_control::active_value(global_control::max_allowed_parallelism);
  return std::min(static_cast<int>(limit), oneapi::tbb::this_task_arena::max_concurrency());
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  oneapi::tbb::parallel_for(std::size_t{0}, count, work);
}

struct ThreadLimit::Control {
  oneapi::tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          {oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)}}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace zerocount::parallel
