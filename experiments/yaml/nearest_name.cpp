#include "experiments/yaml/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace zerocount::yaml {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

constexpr std::size_t longest = 80;

}  // namespace

bool is_near(std::string_view name, std::string_view candidate) {
  return name.size() <= longest &&
         3 * edit_distance(name, candidate) <= std::max(name.size(), candidate.size());
}

std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates) {
  if (name.size() > longest || candidates.empty()) return {};
  const auto nearest = std::min_element(
      candidates.begin(), candidates.end(),
      [&](const auto& a, const auto& b) { return edit_distance(name, a) < edit_distance(name, b); });
  return *nearest;
}

}  // namespace zerocount::yaml
