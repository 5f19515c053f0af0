#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "analysis/statistics/change_point.hpp"

/// Simulated histories, to see how often their changes are found, and changes that are none.
namespace zerocount::testing {

using Generator = std::mt19937_64;

/// A series of measurements of what the generator draws.
using SeriesMaker = std::function<std::vector<statistics::Measurement>(Generator&)>;

/// A kind of series, of `nights` measurements.
struct SimulatedSeries {
  std::string name;
  statistics::MeasurementKind kind{statistics::MeasurementKind::mean};
  SeriesMaker make;
};

/// Means with normal errors of standard deviation 1 around `level(night)`. Every `same_draws` nights in
/// succession have the same random numbers and the same error.
SimulatedSeries normal_series(int nights, const std::function<double(int)>& level, int same_draws = 1);

/// Proportions of `trials` trials with the probability `level(night)`, with Clopper–Pearson bounds.
SimulatedSeries binomial_series(int nights, int trials, const std::function<double(int)>& level);

/// Means of `values` exponential numbers, with bounds from their standard deviation.
SimulatedSeries exponential_series(int nights, int values);

/// How many of `histories` histories, each of `count` independent series, have an alarm.
int alarms(const SimulatedSeries& series, int count, int histories, std::uint64_t seed);

/// Of `histories` histories of one series that changes at `change`, watched as one of `count`.
struct FoundChanges {
  double found{0.0};         ///< proportion with an alarm at or after the change, and none before
  double median_delay{0.0};  ///< nights from the change to that alarm, of all; infinite where most have none
};
FoundChanges found_changes(const SimulatedSeries& series, int change, int count, int histories,
                           std::uint64_t seed);

}  // namespace zerocount::testing
