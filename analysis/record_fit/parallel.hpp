#pragma once

#include <cstddef>
#include <functional>

namespace zerocount::record_fit {

/// Calls `work` for each index below `count`, in parallel.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace zerocount::record_fit
