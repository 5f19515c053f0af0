#include "runners/tuning/race/dropping.hpp"

#include <algorithm>
#include <utility>

#include "analysis/parallel/parallel.hpp"

namespace zerocount::tuning {
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
