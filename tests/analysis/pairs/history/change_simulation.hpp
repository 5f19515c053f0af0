#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "analysis/basis/statistics/change_point.hpp"

/// Simulated histories of nightly results, to measure how often changes are found, and how often there are
/// false alarms.
namespace zerocount::testing {

using Generator = std::mt19937_64;

/// Function that makes a random series of measurements with this generator.
using SeriesMaker = std::function<std::vector<statistics::Measurement>(Generator&)>;

/// A kind of simulated series of measurements with `nights` measurements, one per night.
struct SimulatedSeries {
  std::string name;
  statistics::MeasurementKind kind{statistics::MeasurementKind::mean};
  SeriesMaker make;
};

/// A series of means with normal errors of standard deviation 1 around the true value `level(night)`. Every
/// `same_draws` nights in succession have the same random numbers and so the same error.
SimulatedSeries normal_series(int nights, const std::function<double(int)>& level, int same_draws = 1);

/// A series of success rates of `trials` trials, each with the probability `level(night)`, with
/// Clopper–Pearson bounds.
SimulatedSeries binomial_series(int nights, int trials, const std::function<double(int)>& level);

/// A series of means of `values` exponentially distributed numbers, with bounds from their standard
/// deviation.
SimulatedSeries exponential_series(int nights, int values);

/// Number of histories with an alarm, out of `histories` histories with `count` independent series each.
int alarms(const SimulatedSeries& series, int count, int histories, std::uint64_t seed);

/// Detection of a change in simulated histories of one series that changes at night `change`. The series is
/// watched as one of `count` series.
struct FoundChanges {
  double found{0.0};  ///< proportion of the histories with an alarm at or after the change, and none before
  double median_delay{0.0};  ///< median over all histories, nights from change to alarm; can be infinite
};
FoundChanges found_changes(const SimulatedSeries& series, int change, int count, int histories,
                           std::uint64_t seed);

}  // namespace zerocount::testing
