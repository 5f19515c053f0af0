#include "analysis/record_fit/parallel.hpp"

#include <oneapi/tbb/parallel_for.h>

namespace zerocount::record_fit {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  oneapi::tbb::parallel_for(std::size_t{0}, count, work);
}

}  // namespace zerocount::record_fit
