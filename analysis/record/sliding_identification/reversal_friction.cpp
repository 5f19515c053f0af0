#include "analysis/record/sliding_identification/reversal_friction.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/sliding_identification/sliding_fit.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr std::size_t half = 3;         // samples to both sides of a parabola
constexpr std::size_t near_level = 20;  // samples from the reversal
constexpr std::size_t far_level = 40;
constexpr std::size_t max_gap = 64;  // samples between strokes about a reversal
constexpr double turned = 0.9;

/// Friction torque near sample k, N m or N, as the remainder u − u0 − p(x) − J·a − cs·v of the torque
/// balance.
double friction_near(const SlidingRecord& record, const SlidingPoint& point, std::size_t k) {
  double of_position = 0.0;
  for (std::size_t j = 0; j < position_terms && record.waves > 0; ++j)
    of_position += record.shape[k][j] * point[static_cast<Eigen::Index>(position_amplitudes + j)];
  const double interval = (record.time[k + half] - record.time[k - half]) / (2.0 * half);
  double slope = 0.0;
  double weighted_sum = 0.0;
  double squares = 0.0;
  double quartics = 0.0;
  double torque = 0.0;
  for (std::size_t i = 0; i <= 2 * half; ++i) {
    const double at = static_cast<double>(i) - static_cast<double>(half);
    const double moved = record.position[k - half + i] - record.position[k];
    slope += at * moved;
    squares += at * at;
    quartics += at * at * at * at;
    weighted_sum += at * at * moved;
    if (i < 2 * half) torque += record.torque[k - half + i].now / (2.0 * half);
  }
  const double count = 2.0 * half + 1.0;
  double sum = 0.0;
  for (std::size_t i = 0; i <= 2 * half; ++i) sum += record.position[k - half + i] - record.position[k];
  const double acceleration =
      2.0 * (count * weighted_sum - squares * sum) / (count * quartics - squares * squares);
  const double velocity = slope / squares;
  return torque - point[offset_torque] - of_position -
         std::exp(point[log_inertia]) * acceleration / (interval * interval) -
         point[viscous_damping] * velocity / interval;
}

double median_friction(const SlidingRecord& record, const SlidingPoint& point, std::size_t from,
                       std::size_t to) {
  std::vector<double> values;
  for (std::size_t k = from; k <= to; ++k) values.push_back(friction_near(record, point, k));
  return statistics::upper_median(std::move(values));
}

/// Whether the axis rests at the reversal about sample k: it has more samples near there than a motion that
/// only reverses.
bool rests_at(const SlidingRecord& record, std::size_t k) {
  constexpr std::size_t reach = 5;
  const double about = std::abs(record.position[k + reach] - record.position[k]) +
                       std::abs(record.position[k - reach] - record.position[k]);
  return about < 6.0 * record.resolution;
}

std::optional<Reversal> reversal_between(const SlidingRecord& record, const SlidingPoint& point,
                                         const Window& before, const Window& after) {
  if (before.direction == after.direction || after.first > before.last + max_gap) return std::nullopt;
  std::size_t extreme = before.last;
  for (std::size_t k = before.last; k <= after.first; ++k)
    if (before.direction * record.position[k] > before.direction * record.position[extreme]) extreme = k;
  if (extreme < before.first + far_level + half || extreme + far_level > after.last) return std::nullopt;
  if (extreme < far_level + half || extreme + far_level + half >= record.time.size()) return std::nullopt;
  if (rests_at(record, extreme)) return std::nullopt;
  const double start = median_friction(record, point, extreme - far_level, extreme - near_level);
  const double end = median_friction(record, point, extreme + near_level, extreme + far_level);
  Reversal reversal{.time = record.time[extreme], .swing = after.direction * (end - start)};
  if (!(reversal.swing > 0.0)) return std::nullopt;
  for (std::size_t k = extreme; k <= extreme + far_level; ++k) {
    const double part = after.direction * (friction_near(record, point, k) - start) / reversal.swing;
    reversal.travel = std::abs(record.position[k] - record.position[extreme]);
    reversal.samples = k - extreme;
    if (part >= turned) return reversal;
  }
  return std::nullopt;
}

template <class Get>
double median_of(const std::vector<Reversal>& reversals, const Get& get) {
  std::vector<double> values;
  for (const Reversal& one : reversals) values.push_back(get(one));
  return statistics::upper_median(std::move(values));
}

}  // namespace

std::optional<ReversalFriction> reversal_friction(const SlidingFit& fit) {
  ReversalFriction found;
  const SlidingRecord* last = nullptr;
  for (const FittedWindow& fitted : fit.windows) {
    if (fitted.record == last) continue;
    last = fitted.record;
    for (std::size_t i = 0; i + 1 < last->strokes.size(); ++i) {
      const auto reversal = reversal_between(*last, fit.point, last->strokes[i], last->strokes[i + 1]);
      if (reversal) found.reversals.push_back(*reversal);
    }
  }
  if (found.reversals.empty()) return std::nullopt;
  found.swing = median_of(found.reversals, [](const Reversal& one) { return one.swing; });
  found.travel = median_of(found.reversals, [](const Reversal& one) { return one.travel; });
  found.samples = static_cast<std::size_t>(
      median_of(found.reversals, [](const Reversal& one) { return static_cast<double>(one.samples); }));
  const auto [shortest, longest] = std::ranges::minmax_element(found.reversals, {}, &Reversal::travel);
  found.min_travel = shortest->travel;
  found.max_travel = longest->travel;
  found.stiffness = turned * found.swing / found.travel;
  return found;
}

}  // namespace zerocount::sliding_identification
