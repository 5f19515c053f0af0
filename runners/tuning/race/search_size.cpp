#include "runners/tuning/race/search_size.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::tuning {
namespace {

constexpr int smallest = 10;  // number of the last size
constexpr std::int64_t candidates_each = 48;
constexpr std::int64_t units_of_world = 4;
constexpr std::int64_t climbing_part = 8;  // of the units

/// Size number `step`: each has 0.75 of the candidates of the one before, every second one half of the units.
SearchSize size_at(const SearchScope& scope, int step) {
  const SearchSize largest;
  const double fewer = std::pow(0.75, step);
  const auto part = [fewer](std::int64_t of, std::int64_t least) {
    return std::max(std::llround(fewer * static_cast<double>(of)), static_cast<long long>(least));
  };
  SearchSize size;
  size.first_candidates = part(candidates_each * (1 + static_cast<std::int64_t>(scope.free)), 8);
  size.face_candidates =
      scope.faces == 0 ? 0 : part(candidates_each / 6 * (1 + static_cast<std::int64_t>(scope.free)), 2);
  size.candidates = part(largest.candidates, 6);
  size.elites = part(largest.elites, 3);
  const int halvings = step / 2;
  const std::int64_t worlds = std::max<std::int64_t>(scope.worlds, 1);
  const std::int64_t least = units_of_world * scope.worlds;
  const std::int64_t units = std::max(scope.max_units >> halvings, least);
  size.max_units = (units + worlds - 1) / worlds * worlds;
  size.first_units = std::min(std::max<std::int64_t>(largest.first_units >> halvings, 8), size.max_units);
  size.climbing_units = std::max({size.max_units / climbing_part, size.first_units, least});
  return size;
}

}  // namespace

std::int64_t max_after(const SearchSize& size, std::int64_t units) {
  return std::max(size.elites, 4 * size.candidates * size.first_units / units);
}

std::int64_t first_race_units(const SearchSize& size, std::size_t faces) {
  std::int64_t candidates = size.first_candidates + static_cast<std::int64_t>(faces) * size.face_candidates;
  std::int64_t total = candidates * size.first_units;
  for (std::int64_t units = size.first_units; units < size.max_units;) {
    candidates = std::min(candidates, max_after(size, units));
    const std::int64_t next = std::min(2 * units, size.max_units);
    total += candidates * (next - units);
    units = next;
  }
  return total;
}

SearchSize search_size(const SearchScope& scope, std::int64_t units) {
  for (int step = 0; step < smallest; ++step) {
    const SearchSize size = size_at(scope, step);
    if (first_race_units(size, scope.faces) <= units / 2) return size;
  }
  return size_at(scope, smallest);
}

SearchSize smallest_search(const SearchScope& scope) {
  return size_at(scope, smallest);
}

}  // namespace zerocount::tuning
