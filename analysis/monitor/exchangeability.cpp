#include "analysis/monitor/exchangeability.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random/number_source.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::size_t min_values = 8;
constexpr std::size_t max_values = 100'000;
constexpr std::size_t max_orders = 999;
constexpr std::size_t min_orders = 199;
constexpr std::size_t max_work = 20'000'000;  // values times orders times windows, beyond min_orders

std::vector<std::vector<std::size_t>> places_of(std::span<const std::size_t> classes) {
  std::vector<std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] >= places.size()) places.resize(classes[i] + 1);
    places[classes[i]].push_back(i);
  }
  return places;
}

/// T_b of each window.
void add_windows(const std::vector<double>& x, std::span<const std::size_t> windows,
                 std::vector<double>& sums_of_squares) {
  std::vector<double> sums(x.size() + 1, 0.0);
  std::partial_sum(x.begin(), x.end(), sums.begin() + 1);
  for (const std::size_t window : windows) {
    double total = 0.0;
    for (std::size_t i = window; i < sums.size(); ++i) {
      const double sum = sums[i] - sums[i - window];
      total += sum * sum;
    }
    sums_of_squares.push_back(total);
  }
}

/// @param t [order][window] T_b, the order observed first
Dependence judged(std::vector<double> t, std::span<const std::size_t> windows) {
  const std::size_t width = windows.size();
  const std::size_t orders = t.size() / width;
  for (std::size_t w = 0; w < width; ++w) {
    double mean = 0.0;
    for (std::size_t i = 0; i < orders; ++i) mean += t[i * width + w] / static_cast<double>(orders);
    double variance = 0.0;
    for (std::size_t i = 0; i < orders; ++i)
      variance += std::pow(t[i * width + w] - mean, 2) / static_cast<double>(orders);
    const double scale = variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
    for (std::size_t i = 0; i < orders; ++i) t[i * width + w] = (t[i * width + w] - mean) * scale;
  }
  const auto largest = [&](std::size_t order) {
    const auto row = std::span(t).subspan(order * width, width);
    return std::ranges::max_element(row, {}, [](double z) { return std::abs(z); }) - row.begin();
  };
  const auto size = [&](std::size_t order) {
    return std::abs(t[order * width + static_cast<std::size_t>(largest(order))]);
  };
  const double observed = size(0);
  std::size_t as_large = 0;
  for (std::size_t i = 0; i < orders; ++i) as_large += size(i) >= observed ? 1 : 0;
  const auto window = static_cast<std::size_t>(largest(0));
  return {.p = static_cast<double>(as_large) / static_cast<double>(orders),
          .over = static_cast<std::int64_t>(windows[window]),
          .alternates = t[window] < 0.0};
}

}  // namespace

std::vector<double> ranks_within(std::span<const double> values, std::span<const std::size_t> classes) {
  std::vector<double> ranks(values.size());
  for (const std::vector<std::size_t>& places : places_of(classes)) {
    std::vector<double> sorted;
    for (const std::size_t place : places) sorted.push_back(values[place]);
    std::ranges::sort(sorted);
    for (const std::size_t place : places) {
      const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), values[place]);
      ranks[place] = 0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin())) /
                     static_cast<double>(sorted.size());
    }
  }
  return ranks;
}

double part_between(std::span<const double> values, std::span<const std::size_t> classes) {
  const std::vector<double> ranks = ranks_within(values, std::vector<std::size_t>(values.size(), 0));
  double total = 0.0;
  for (const double rank : ranks) total += (rank - 0.5) * (rank - 0.5);
  double between = 0.0;
  for (const std::vector<std::size_t>& places : places_of(classes)) {
    double sum = 0.0;
    for (const std::size_t place : places) sum += ranks[place] - 0.5;
    if (!places.empty()) between += sum * sum / static_cast<double>(places.size());
  }
  return total > 0.0 ? between / total : 0.0;
}

Dependence dependence_of(std::span<const double> values, std::span<const std::size_t> classes,
                         const random::RandomKey& key) {
  const std::size_t count = std::min(values.size(), max_values);
  if (count < min_values) return {};
  const std::vector<std::vector<std::size_t>> places = places_of(classes.first(count));
  std::vector<double> x = ranks_within(values.first(count), classes.first(count));
  for (double& rank : x) rank -= 0.5;
  if (std::ranges::all_of(x, [](double rank) { return rank == 0.0; })) return {};
  std::vector<std::size_t> windows;
  for (std::size_t window = 2; 3 * window <= count; window *= 2) windows.push_back(window);
  const std::size_t orders = std::clamp(max_work / (count * windows.size()), min_orders, max_orders);
  std::vector<double> t;
  add_windows(x, windows, t);
  random::NumberSource numbers(key);
  for (std::size_t order = 0; order < orders; ++order) {
    for (const std::vector<std::size_t>& alike : places)
      for (std::size_t left = alike.size(); left > 1; --left) {
        const auto other = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(left));
        std::swap(x[alike[left - 1]], x[alike[std::min(other, left - 1)]]);
      }
    add_windows(x, windows, t);
  }
  return judged(std::move(t), windows);
}

}  // namespace zerocount::monitor
