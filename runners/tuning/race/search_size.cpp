#include "runners/tuning/race/search_size.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/parallel/parallel.hpp"

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

namespace {

constexpr double error_of_dropping = 0.01;

/// [place] the index of the candidate with so many larger margins.
std::vector<std::size_t> by_margin(const Aim& aim, const std::vector<Candidate>& candidates,
                                   std::int64_t units) {
  std::vector<std::size_t> order(candidates.size());
  std::vector<double> margins;
  for (const Estimate& one : estimates_of(aim, candidates, units)) {
    order[margins.size()] = margins.size();
    margins.push_back(one.margin);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return margins[a] > margins[b]; });
  return order;
}

}  // namespace

std::vector<Candidate> dropped(const Aim& aim, const SearchSize& size, std::vector<Candidate> candidates,
                               std::int64_t units) {
  const std::vector<std::size_t> reliable = by_margin(aim, candidates, units);
  const Candidate& most_reliable = candidates[reliable.front()];
  const auto sure = std::ranges::find_if(
      candidates, [&](const Candidate& one) { return surely_meets(aim, one, error_of_dropping); });
  std::vector<char> stays(candidates.size());
  parallel::for_each_index(
      candidates.size(),
      [&](std::size_t i) {
        const Candidate& one = candidates[i];
        const bool stays_in = !surely_misses(aim, one, most_reliable, error_of_dropping) &&
                              (sure == candidates.end() || &one == &*sure ||
                               !is_significantly_later(aim, one, *sure, error_of_dropping));
        stays[i] = stays_in ? 1 : 0;
      },
      "compare");
  const auto most = static_cast<std::size_t>(max_after(size, units));
  std::vector<char> chosen;
  chosen.reserve(candidates.size());
  for (const Candidate& one : candidates) chosen.push_back(std::ssize(one.units) > units ? 1 : 0);
  std::size_t count = 0;
  const auto choose = [&](std::size_t i) {
    if (count == most || chosen[i] != 0 || stays[i] == 0) return;
    chosen[i] = 1;
    ++count;
  };
  for (std::size_t place = 0; place < candidates.size(); ++place) {
    choose(place);
    choose(reliable[place]);
  }
  std::vector<Candidate> left;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (chosen[i] != 0) left.push_back(std::move(candidates[i]));
  }
  return left;
}

}  // namespace zerocount::tuning
