#include "runners/rare/tried_values.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace zerocount::rare {

void TriedValue::take(std::span<const PointResult> results) {
  value.trials = std::ssize(results);
  value.failures = std::ranges::count_if(results, [](const PointResult& one) { return one.failed > 0.0; });
  scores.assign(results.front().scores.size(), -std::numeric_limits<double>::infinity());
  for (const PointResult& one : results) {
    for (std::size_t i = 0; i < scores.size(); ++i) scores[i] = std::fmax(scores[i], one.scores[i]);
  }
}

std::vector<TriedValue> most_suspicious(const std::vector<TriedValue>& tried, std::size_t count,
                                        std::size_t scores) {
  if (tried.size() <= count) return tried;
  std::vector<std::size_t> order(tried.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<bool> chosen(tried.size(), false);
  std::vector<TriedValue> found;
  const auto take_first = [&](std::size_t most, const auto& is_wanted) {
    for (std::size_t i = 0; i < order.size() && most > 0 && found.size() < count; ++i) {
      if (chosen[order[i]] || !is_wanted(tried[order[i]])) continue;
      chosen[order[i]] = true;
      found.push_back(tried[order[i]]);
      --most;
    }
  };
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return tried[i].value.failures; });
  take_first(count, [](const TriedValue& one) { return one.value.failures > 0; });
  const std::size_t of_each = (count - found.size() + scores - 1) / scores;
  for (std::size_t score = 0; score < scores; ++score) {
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return tried[i].scores[score]; });
    take_first(of_each, [](const TriedValue&) { return true; });
  }
  return found;
}

}  // namespace zerocount::rare
