#include "analysis/sensitivity/given_data_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <vector>

#include "analysis/sensitivity/rank_correlation.hpp"
#include "analysis/statistics/distributions.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_trials = 20;
constexpr std::size_t max_parts = 32;

// The class of each trial, 0 … M − 1, some of which may be empty.
std::vector<std::size_t> classes_by(std::span<const double> x) {
  const std::vector<double> f = mid_distribution(x);
  const std::size_t parts =
      std::min(max_parts, static_cast<std::size_t>(std::sqrt(static_cast<double>(x.size()))));
  std::set<double> levels;
  for (std::size_t i = 0; i < f.size() && levels.size() <= parts; ++i) levels.insert(f[i]);
  std::vector<std::size_t> classes;
  classes.reserve(f.size());
  for (const double value : f) {
    classes.push_back(levels.size() > parts
                          ? static_cast<std::size_t>(value * static_cast<double>(parts))
                          : static_cast<std::size_t>(std::distance(levels.begin(), levels.find(value))));
  }
  return classes;
}

struct ClassMean {
  double n{0.0};
  double sum{0.0};

  double mean() const { return sum / n; }
};

std::vector<ClassMean> means_of(const std::vector<std::size_t>& classes, std::span<const double> y) {
  std::vector<ClassMean> means(1 + *std::max_element(classes.begin(), classes.end()));
  for (std::size_t i = 0; i < y.size(); ++i) {
    means[classes[i]].n += 1.0;
    means[classes[i]].sum += y[i];
  }
  return means;
}

// How far below S the chi-squared distribution of the classes' part puts its lower bound.
double null_reach(double index, double classes, double n, double confidence) {
  const double extreme = statistics::chi_squared_quantile(classes - 1.0, 0.5 + 0.5 * confidence);
  return (1.0 - index) * (extreme - (classes - 1.0)) / n;
}

}  // namespace

BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y,
                                     double confidence) {
  if (x.size() < min_trials) return {};
  const std::vector<std::size_t> classes = classes_by(x);
  const std::vector<ClassMean> means = means_of(classes, y);
  const double n = static_cast<double>(x.size());
  const auto filled = static_cast<double>(
      std::count_if(means.begin(), means.end(), [](const ClassMean& m) { return m.n > 0.0; }));
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double within = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    within += std::pow(y[i] - means[classes[i]].mean(), 2);
    total += std::pow(y[i] - mean, 2);
  }
  const bool constant = std::all_of(y.begin(), y.end(), [&](double value) { return value == y.front(); });
  if (constant || filled < 2.0 || n < 2.0 * filled) return {};

  const double index = 1.0 - (n - 1.0) / (n - filled) * within / total;
  const double variance = total / n;
  double squares = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double between = means[classes[i]].mean() - mean;
    const double influence = 2.0 * between * (y[i] - means[classes[i]].mean()) + between * between -
                             index * std::pow(y[i] - mean, 2);
    squares += std::pow(influence / variance, 2) * n / (n - filled);
  }
  const double at_zero = 2.0 * (filled - 1.0) * std::pow(1.0 - index, 2);
  const double half =
      statistics::two_sided_normal_quantile(confidence) * std::sqrt(std::max(squares - at_zero, at_zero)) / n;
  return {index, std::max(index - std::max(half, null_reach(index, filled, n, confidence)), -1.0),
          std::min(index + half, 1.0)};
}

}  // namespace zerocount::sensitivity
