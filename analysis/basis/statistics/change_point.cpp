#include "analysis/basis/statistics/change_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

/// Siegmund's factor ν(x), which corrects for the overshoot of a random walk over a boundary.
double overshoot_factor(double x) {
  if (x < 1.0e-6) return 1.0;
  const double half = 0.5 * x;
  const double above_half = 0.5 - normal_upper_tail(half);
  const double density = std::exp(-0.5 * half * half) / std::sqrt(2.0 * std::numbers::pi);
  return (2.0 / x) * above_half / (half * (1.0 - normal_upper_tail(half)) + density);
}

double false_alarm_probability(double threshold) {
  constexpr int steps = 100;  // midpoint rule; relative error below 1e-3
  const double step = threshold / steps;
  double integral = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) * step;
    integral += x * std::pow(overshoot_factor(x), 2) * step;
  }
  return threshold * std::exp(-0.5 * threshold * threshold) / std::sqrt(2.0 * std::numbers::pi) * integral;
}

/// The measurements before or after an assumed change, grouped by the random numbers that they were made
/// with. A group counts as one measurement, their average.
class Side {
 public:
  explicit Side(std::size_t draws) : groups_(draws) {}

  void add(const Measurement& one) { change(one, 1.0); }
  void remove(const Measurement& one) { change(one, -1.0); }

  double size() const { return size_; }
  double sum() const { return sum_; }  ///< Sum of size times mean over the groups.
  double mean() const { return sum_ / size_; }

 private:
  struct Group {
    double count{0.0};
    double sizes{0.0};  ///< Sum of the measurements' sizes.
    double sums{0.0};   ///< Sum of size times value over the measurements.

    double size() const { return count > 0.0 ? sizes / count : 0.0; }
    double sum() const { return count > 0.0 ? sums / count : 0.0; }
  };

  void change(const Measurement& one, double sign) {
    Group& group = groups_[one.draws];
    size_ -= group.size();
    sum_ -= group.sum();
    group.count += sign;
    group.sizes += sign * one.size;
    group.sums += sign * one.size * one.value;
    size_ += group.size();
    sum_ += group.sum();
  }

  std::vector<Group> groups_;
  double size_{0.0};
  double sum_{0.0};
};

/// Divergence of a binomial proportion m of n trials from p: n·(m·ln(m/p) + (1 − m)·ln((1 − m)/(1 − p))).
double binomial_divergence(double n, double m, double p) {
  const auto term = [](double x, double y) { return x > 0.0 ? x * std::log(x / y) : 0.0; };
  return n * (term(m, p) + term(1.0 - m, 1.0 - p));
}

/// Likelihood ratio statistic Z² of two different levels, before and after a change, against one common
/// level, for a dispersion of 1.
double likelihood_ratio(MeasurementKind kind, const Side& before, const Side& after) {
  if (kind == MeasurementKind::mean)
    return std::pow(after.mean() - before.mean(), 2) / (1.0 / before.size() + 1.0 / after.size());
  // Rounding in the sums must not leave [0, 1].
  const auto proportion = [](double value) { return std::clamp(value, 0.0, 1.0); };
  const double common = proportion((before.sum() + after.sum()) / (before.size() + after.size()));
  return 2.0 * (binomial_divergence(before.size(), proportion(before.mean()), common) +
                binomial_divergence(after.size(), proportion(after.mean()), common));
}

/// The change that is most significant, with the largest |Z|, among all divisions of the measurements `start`
/// … `last` into earlier and later ones.
/// @param draws number of different Measurement::draws
LevelChange strongest_division(MeasurementKind kind, std::span<const Measurement> all, std::size_t draws,
                               std::size_t start, std::size_t last) {
  Side before(draws);
  Side after(draws);
  double dispersion = 0.0;
  for (std::size_t i = start; i <= last; ++i) {
    before.add(all[i]);
    dispersion += all[i].dispersion / static_cast<double>(last - start + 1);
  }
  LevelChange best;
  double largest = 0.0;
  for (std::size_t first = last; first > start; --first) {
    before.remove(all[first]);
    after.add(all[first]);
    const double ratio = likelihood_ratio(kind, before, after);
    if (ratio <= largest) continue;
    largest = ratio;
    const double sign = after.mean() > before.mean() ? 1.0 : -1.0;
    best = {first, last, before.mean(), after.mean(), sign * std::sqrt(ratio / dispersion)};
  }
  return best;
}

double width_of(const ConfidenceInterval& bounds) {
  return bounds.high - bounds.low;
}

}  // namespace

std::optional<Measurement> measured_mean(double value, double n, const ConfidenceInterval& bounds,
                                         double confidence) {
  if (!std::isfinite(value) || !std::isfinite(width_of(bounds)) || !(bounds.low < bounds.high) || !(n > 0.0))
    return std::nullopt;
  const double standard_error = width_of(bounds) / (2.0 * two_sided_normal_quantile(confidence));
  return Measurement{value, n, n * standard_error * standard_error};
}

std::optional<Measurement> measured_proportion(double value, double n, const ConfidenceInterval& bounds,
                                               double confidence) {
  if (!(value >= 0.0 && value <= 1.0) || !(n > 0.0)) return std::nullopt;
  const auto trials = static_cast<std::int64_t>(std::llround(n));
  const double independent = width_of(clopper_pearson(std::llround(value * n), trials, confidence));
  const double effect = std::pow(width_of(bounds) / independent, 2);
  return Measurement{value, n, std::isfinite(effect) ? std::max(1.0, effect) : 1.0};
}

double change_threshold(double probability) {
  constexpr double low = 1.5;  // from here on the probability falls
  constexpr double high = 30.0;
  const auto keeps = [&](double threshold) { return !(false_alarm_probability(threshold) > probability); };
  return numerics::bisect({high, low}, keeps, numerics::after_halvings(50)).holds;
}

std::vector<LevelChange> level_changes(MeasurementKind kind, std::span<const Measurement> measurements,
                                       double threshold) {
  if (measurements.empty()) return {};
  const bool of_means = kind == MeasurementKind::mean;
  const double origin = of_means ? measurements.front().value : 0.0;
  std::vector<Measurement> shifted(measurements.begin(), measurements.end());
  std::size_t draws = 0;
  for (Measurement& one : shifted) {
    one.value -= origin;  // so that the sums of means do not cancel
    draws = std::max(draws, one.draws + 1);
  }
  std::vector<LevelChange> changes;
  std::size_t start = 0;
  for (std::size_t last = 1; last < shifted.size(); ++last) {
    LevelChange change = strongest_division(kind, shifted, draws, start, last);
    if (std::abs(change.z) < threshold) continue;
    change.before += origin;
    change.after += origin;
    changes.push_back(change);
    start = change.first;
  }
  return changes;
}

}  // namespace zerocount::statistics
