#include "analysis/sensitivity/given_data_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "analysis/sensitivity/rank_correlation.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/sums/moments.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_trials = 20;

struct Trial {
  double x;
  double y;
};

/// Trials in the order of x.
std::vector<Trial> by_factor(std::span<const double> x, std::span<const double> y) {
  std::vector<Trial> trials;
  trials.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) trials.push_back({x[i], y[i]});
  std::sort(trials.begin(), trials.end(),
            [](const Trial& a, const Trial& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  return trials;
}

/// Neighbours in x. @param lines whether a class has several values of x, and a line in place of a mean
struct Classes {
  std::vector<std::span<const Trial>> parts;
  bool lines{false};
};

Classes classes_of(std::span<const Trial> trials) {
  const auto most = static_cast<std::size_t>(0.5 * std::pow(static_cast<double>(trials.size()), 2.0 / 3.0));
  std::vector<std::size_t> levels;  // starts of equal x
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (i == 0 || trials[i].x != trials[i - 1].x) levels.push_back(i);
  Classes classes{.parts = {}, .lines = levels.size() > most};
  const std::size_t size = classes.lines ? trials.size() / most : 1;
  std::vector<std::size_t> starts;
  for (const std::size_t level : levels) {
    const bool room = starts.empty() || trials.size() - level >= size;
    if (room && (starts.empty() || level - starts.back() >= size)) starts.push_back(level);
  }
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : trials.size();
    classes.parts.push_back(trials.subspan(starts[k], end - starts[k]));
  }
  return classes;
}

/// The squares of the trials about m, by the divisors of their classes, [trial], and the coefficients of m.
struct Noise {
  std::vector<double> squares;
  double mean{0.0};
  double coefficients{0.0};
};

/// Appends the squares of a class. @returns its coefficients
double add_squares(std::span<const Trial> part, bool line, std::vector<double>& squares) {
  const auto n = static_cast<double>(part.size());
  double x = 0.0;
  double y = 0.0;
  for (const Trial& trial : part) {
    x += trial.x / n;
    y += trial.y / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (const Trial& trial : part) {
    xx += (trial.x - x) * (trial.x - x);
    xy += (trial.x - x) * (trial.y - y);
  }
  const bool sloped = line && xx > 0.0;
  const double slope = sloped ? xy / xx : 0.0;
  const double coefficients = sloped ? 2.0 : 1.0;
  const double scale = n > coefficients ? n / (n - coefficients) : std::nan("");
  for (const Trial& trial : part) squares.push_back(std::pow(trial.y - y - slope * (trial.x - x), 2) * scale);
  return coefficients;
}

Noise noise_of(const Classes& classes) {
  Noise noise;
  for (const std::span<const Trial> part : classes.parts)
    noise.coefficients += add_squares(part, classes.lines, noise.squares);
  statistics::Moments known;
  for (const double square : noise.squares) known.add(square);
  noise.mean = known.mean;
  for (double& square : noise.squares)
    if (std::isnan(square)) square = noise.mean;
  return noise;
}

/// ln(E/V), its standard error and the degrees of freedom of that.
struct Logarithm {
  double value{0.0};
  double error{0.0};
  double degrees{0.5};
};

Logarithm logarithm_of(const Noise& noise, std::span<const Trial> trials, const statistics::Moments& y) {
  const auto n = static_cast<double>(trials.size());
  const double variance = y.sd() * y.sd();
  double squares = 0.0;
  double fourths = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    // Both terms have the mean 1, and their difference 0.
    const double of_all = std::pow(trials[i].y - y.mean, 2) / (variance * (n - 1.0) / n);
    const double influence = noise.squares[i] / noise.mean - of_all;
    squares += influence * influence;
    fourths += std::pow(influence, 4);
  }
  const double carrying = fourths > 0.0 ? squares * squares / fourths : n;
  return {std::log(noise.mean / variance), std::sqrt(squares + 2.0 * (noise.coefficients - 1.0)) / n,
          std::max(0.5 * carrying - 1.0, 0.5)};
}

/// The upper bound of an index that is hardly above 0.
double bound_near_zero(double index, double coefficients, double n, double confidence) {
  const double z2 = std::pow(statistics::two_sided_normal_quantile(confidence), 2);
  const double a = 1.0 + 4.0 * z2 / n;
  const double b = index + 2.0 * z2 / n;
  const double c = index * index - 2.0 * z2 * (coefficients - 1.0) / (n * n);
  return (b + std::sqrt(std::max(b * b - a * c, 0.0))) / a;
}

}  // namespace

BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y,
                                     double confidence) {
  if (x.size() < min_trials || is_constant(x) || is_constant(y)) return {};
  const std::vector<Trial> trials = by_factor(x, y);
  const Noise noise = noise_of(classes_of(trials));
  statistics::Moments moments;
  for (const Trial& trial : trials) moments.add(trial.y);
  if (!(noise.mean > 0.0)) return {1.0, 1.0, 1.0};

  const auto n = static_cast<double>(x.size());
  const double extreme = 0.5 + 0.5 * confidence;
  const Logarithm logarithm = logarithm_of(noise, trials, moments);
  const double half = statistics::student_t_quantile(logarithm.degrees, extreme) * logarithm.error;
  const double by_chance =
      (statistics::chi_squared_quantile(noise.coefficients - 1.0, extreme) - (noise.coefficients - 1.0)) / n;
  const double index = 1.0 - std::exp(logarithm.value);
  const double low = 1.0 - std::exp(logarithm.value + std::max(half, by_chance));
  double high = 1.0 - std::exp(logarithm.value - half);
  if (low <= 0.0) high = std::max(high, bound_near_zero(index, noise.coefficients, n, confidence));
  return clamped_index({index, low, high});
}

}  // namespace zerocount::sensitivity
