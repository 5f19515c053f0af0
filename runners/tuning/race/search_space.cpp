#include "runners/tuning/race/search_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace zerocount::tuning {
namespace {

/// Rounds a value to four significant digits.
double shortened(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(value))));
  return std::round(value * unit) / unit;
}

}  // namespace

Values values_at(std::span<const study::FreeParameter> free, const UnitCubePoint& place) {
  Values values;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const study::FreeParameter& one = free[i];
    const double fraction = std::clamp(place[i], 0.0, 1.0);
    const double value = one.logarithmic ? one.low * std::pow(one.high / one.low, fraction)
                                         : one.low + (one.high - one.low) * fraction;
    values.push_back(std::clamp(one.whole ? std::round(value) : shortened(value), one.low, one.high));
  }
  return values;
}

double to_three_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit) : std::round(value / unit) * unit;
}

UnitCubePoint place_of(std::span<const study::FreeParameter> free, const Values& values) {
  UnitCubePoint place;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const study::FreeParameter& one = free[i];
    const double value = std::clamp(values[i], one.low, one.high);
    place.push_back(one.logarithmic ? std::log(value / one.low) / std::log(one.high / one.low)
                                    : (value - one.low) / (one.high - one.low));
  }
  return place;
}

SpreadPlaces::SpreadPlaces(std::vector<double> start) : start_(std::move(start)) {
  double g = 2.0;
  for (int step = 0; step < 60; ++step) g = std::pow(1.0 + g, 1.0 / static_cast<double>(start_.size() + 1));
  for (std::size_t d = 0; d < start_.size(); ++d) ratios_.push_back((d == 0 ? 1.0 : ratios_.back()) / g);
}

UnitCubePoint SpreadPlaces::at(std::int64_t i) const {
  UnitCubePoint place;
  for (std::size_t d = 0; d < start_.size(); ++d) {
    const double value = start_[d] + static_cast<double>(i) * ratios_[d];
    place.push_back(value - std::floor(value));
  }
  return place;
}

}  // namespace zerocount::tuning
