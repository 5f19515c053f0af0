#include "runners/cluster/array_job.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace zerocount::cluster {

ArrayJob array_job(std::int64_t parts, std::int64_t max_array_size) {
  return {parts, std::clamp<std::int64_t>(max_array_size, 1, parts)};
}

std::vector<std::int64_t> elements_of(const ArrayJob& job, std::span<const std::int64_t> parts) {
  std::vector<std::int64_t> elements;
  elements.reserve(parts.size());
  for (const std::int64_t part : parts) elements.push_back((part - 1) % job.elements);
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

std::string index_list(std::span<const std::int64_t> indices) {
  std::string list;
  for (std::size_t first = 0; first < indices.size();) {
    std::size_t last = first;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    list += fmt::format("{}{}", list.empty() ? "" : ",", indices[first]);
    if (last > first) list += fmt::format("-{}", indices[last]);
    first = last + 1;
  }
  return list;
}

}  // namespace zerocount::cluster
