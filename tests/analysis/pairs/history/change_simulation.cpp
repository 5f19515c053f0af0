#include "tests/analysis/pairs/history/change_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/pairs/history/series.hpp"

namespace zerocount::testing {
namespace {

double threshold_of(int count) {
  return statistics::change_threshold(history::false_alarm_probability /
                                      (history::false_alarm_runs * static_cast<double>(count)));
}

}  // namespace

SimulatedSeries normal_series(int nights, const std::function<double(int)>& level, int same_draws) {
  return {
      "means, normal", statistics::MeasurementKind::mean, [=](Generator& generator) {
        std::normal_distribution<double> error;
        std::vector<statistics::Measurement> series;
        double shared = 0.0;
        for (int night = 0; night < nights; ++night) {
          if (night % same_draws == 0) shared = error(generator);
          series.push_back({level(night) + shared, 1.0, 1.0, static_cast<std::size_t>(night / same_draws)});
        }
        return series;
      }};
}

SimulatedSeries binomial_series(int nights, int trials, const std::function<double(int)>& level) {
  const auto measured = std::make_shared<std::vector<statistics::Measurement>>();
  for (int successes = 0; successes <= trials; ++successes) {
    measured->push_back(*statistics::measured_proportion(
        statistics::rate(successes, trials), trials, statistics::clopper_pearson(successes, trials), 0.95));
  }
  return {"proportions", statistics::MeasurementKind::proportion, [=](Generator& generator) {
            std::vector<statistics::Measurement> series;
            for (int night = 0; night < nights; ++night) {
              std::binomial_distribution<int> successes(trials, level(night));
              series.push_back((*measured)[static_cast<std::size_t>(successes(generator))]);
              series.back().draws = static_cast<std::size_t>(night);
            }
            return series;
          }};
}

SimulatedSeries exponential_series(int nights, int values) {
  return {"means, exponential", statistics::MeasurementKind::mean, [=](Generator& generator) {
            std::exponential_distribution<double> draw;
            std::vector<statistics::Measurement> series;
            std::vector<double> sample(static_cast<std::size_t>(values));
            for (int night = 0; night < nights; ++night) {
              for (double& value : sample) value = draw(generator);
              const double mean = std::accumulate(sample.begin(), sample.end(), 0.0) / values;
              double squares = 0.0;
              for (const double value : sample) squares += (value - mean) * (value - mean);
              const double half = 1.959964 * std::sqrt(squares / (values - 1.0) / values);
              series.push_back(*statistics::measured_mean(mean, values, {mean - half, mean + half}, 0.95));
              series.back().draws = static_cast<std::size_t>(night);
            }
            return series;
          }};
}

int alarms(const SimulatedSeries& series, int count, int histories, std::uint64_t seed) {
  Generator generator(seed);
  const double threshold = threshold_of(count);
  int found = 0;
  for (int history = 0; history < histories; ++history) {
    bool alarm = false;
    for (int one = 0; one < count; ++one)
      alarm = !statistics::level_changes(series.kind, series.make(generator), threshold).empty() || alarm;
    found += alarm ? 1 : 0;
  }
  return found;
}

FoundChanges found_changes(const SimulatedSeries& series, int change, int count, int histories,
                           std::uint64_t seed) {
  Generator generator(seed);
  const double threshold = threshold_of(count);
  std::vector<double> delays;
  int found = 0;
  for (int history = 0; history < histories; ++history) {
    const auto changes = statistics::level_changes(series.kind, series.make(generator), threshold);
    const bool right = !changes.empty() && changes.front().detected >= static_cast<std::size_t>(change);
    found += right ? 1 : 0;
    delays.push_back(right ? static_cast<double>(changes.front().detected) - change
                           : std::numeric_limits<double>::infinity());
  }
  std::nth_element(delays.begin(), delays.begin() + histories / 2, delays.end());
  return {static_cast<double>(found) / histories, delays[static_cast<std::size_t>(histories / 2)]};
}

}  // namespace zerocount::testing
