#include "analysis/trials/theory/lasting_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace zerocount::theory {
namespace {

constexpr std::size_t quarters = 4;
constexpr double alike = 0.05;              // relative difference of two amplitudes of one cycle
constexpr double max_change_to_come = 0.1;  // of the amplitude, by its trend
constexpr double negligible_trend = 1e-3;   // of the amplitude, from quarter to quarter by the samples alone
constexpr std::size_t min_periods = 4;      // in the last octave
constexpr int octaves_to_come = 20;
constexpr double max_ratio_of_drifts = 2.0;   // that of a constant rate
constexpr double min_width_of_quarter = 0.5;  // of a torque that oscillates quickly, part of its whole range

using Series = std::span<const float>;

struct Extent {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high - low; }
  double amplitude() const { return 0.5 * width(); }
  double middle() const { return 0.5 * (low + high); }
};

Extent extent_of(Series values) {
  const auto [low, high] = std::ranges::minmax(values);
  return {low, high};
}

double mean_of(Series values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Octave of a record of samples: the last half of it, or of its beginning.
/// @param before number of octaves between this one and the last one; 0: the last half of the record
Series octave(Series values, int before) {
  const std::size_t end = values.size() >> before;
  return values.subspan(end / 2, end - end / 2);
}

Series quarter_of(Series values, std::size_t quarter) {
  const std::size_t size = values.size() / quarters;
  return values.subspan(quarter * size, size);
}

/// Expected change of an amplitude after the last quarter of a record, if its changes between the quarters
/// continue as a geometric series; 0 if they have different signs or are negligible, infinite if they grow.
double change_to_come(const std::array<double, quarters>& amplitudes) {
  const double first = amplitudes[1] - amplitudes[0];
  const double second = amplitudes[2] - amplitudes[1];
  const double third = amplitudes[3] - amplitudes[2];
  if (!(first * second > 0.0) || !(second * third > 0.0)) return 0.0;
  if (std::abs(first + second + third) <= negligible_trend * amplitudes[3]) return 0.0;
  const double ratio = std::sqrt(third / first);
  return ratio < 1.0 ? third * ratio / (1.0 - ratio) : std::numeric_limits<double>::infinity();
}

/// Mean amplitude and period over the periods of a position, each from one rise through `band` to the next;
/// nothing with too few rises.
std::optional<Cycle> mean_cycle(Series positions, const Extent& band) {
  bool was_below = false;
  std::size_t rises = 0, first = 0, last = 0;
  double sum = 0.0;  // of the amplitudes of the periods
  Extent of_period;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    of_period.add(positions[k]);
    if (positions[k] <= band.low) was_below = true;
    if (positions[k] < band.high || !was_below) continue;
    was_below = false;
    if (rises++ == 0) {
      first = k;
    } else {
      sum += of_period.amplitude();
    }
    of_period = {};
    last = k;
  }
  if (rises <= min_periods) return std::nullopt;
  const auto periods = static_cast<double>(rises - 1);
  return Cycle{sum / periods, static_cast<double>(last - first) / periods};
}

/// Change of the mean torque that is expected in the octaves to come (each twice as long as the one before),
/// N m.
double drift_to_come(Series torques) {
  const double last = mean_of(octave(torques, 0)) - mean_of(octave(torques, 1));
  const double before = mean_of(octave(torques, 1)) - mean_of(octave(torques, 2));
  if (last == 0.0) return 0.0;
  const double ratio = std::min(std::abs(last / before), max_ratio_of_drifts);
  double drift = std::abs(last);
  double sum = 0.0;
  for (int i = 0; i < octaves_to_come; ++i) sum += drift *= ratio;
  return sum;
}

/// Whether the torque oscillates quickly between the same extremes, so that its mean does not change.
bool oscillates_quickly(Series torques) {
  const Series last = octave(torques, 0);
  const Extent before = extent_of(octave(torques, 1));
  const Extent now = extent_of(last);
  const double beyond = std::max({now.high - before.high, before.low - now.low, 0.0});
  if (beyond > min_width_of_quarter * before.width()) return false;
  for (std::size_t i = 0; i < quarters; ++i) {
    if (extent_of(quarter_of(last, i)).width() < min_width_of_quarter * now.width()) return false;
  }
  return true;
}

}  // namespace

bool stands(Series positions) {
  return extent_of(positions.last(positions.size() - positions.size() / 4)).amplitude() <=
         max_standing_amplitude;
}

std::optional<Cycle> lasting_cycle(Series positions) {
  const Series last = octave(positions, 0);
  const Extent range = extent_of(last);
  const double amplitude = range.amplitude();
  if (amplitude <= max_standing_amplitude) return std::nullopt;
  const auto is_alike = [&](double other) { return std::abs(other - amplitude) <= alike * amplitude; };
  std::array<double, quarters> amplitudes{};
  for (std::size_t i = 0; i < quarters; ++i) amplitudes[i] = extent_of(quarter_of(last, i)).amplitude();
  if (!is_alike(extent_of(octave(positions, 1)).amplitude()) || !std::ranges::all_of(amplitudes, is_alike) ||
      std::abs(change_to_come(amplitudes)) > max_change_to_come * amplitude)
    return std::nullopt;
  return mean_cycle(last, {range.middle() - 0.5 * amplitude, range.middle() + 0.5 * amplitude});
}

bool torque_has_settled(Series torques, double tolerance) {
  return drift_to_come(torques) <= tolerance || oscillates_quickly(torques);
}

}  // namespace zerocount::theory
