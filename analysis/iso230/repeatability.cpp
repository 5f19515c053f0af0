#include "analysis/iso230/repeatability.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::iso230 {
namespace {

constexpr double coverage = 2.0;  // of the standard's bands x̄ ± 2·s

/// Smallest and largest of the values added; one that is NaN makes both NaN.
class Extremes {
 public:
  void add(double value) {
    if (std::isnan(value) || value < smallest_) smallest_ = value;
    if (std::isnan(value) || value > largest_) largest_ = value;
  }
  double largest() const { return largest_; }
  double range() const { return largest_ - smallest_; }

 private:
  double smallest_{std::numeric_limits<double>::infinity()};
  double largest_{-std::numeric_limits<double>::infinity()};
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? statistics::unknown : sum / static_cast<double>(values.size());
}

double standard_uncertainty(const std::vector<double>& values, double mean) {
  if (values.size() < 2) return statistics::unknown;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

TargetRepeatability of_target(const TargetDeviations& target) {
  TargetRepeatability t;
  t.mean_positive = mean_of(target.positive);
  t.mean_negative = mean_of(target.negative);
  t.mean = (t.mean_positive + t.mean_negative) / 2.0;
  t.reversal = t.mean_positive - t.mean_negative;
  t.uncertainty_positive = standard_uncertainty(target.positive, t.mean_positive);
  t.uncertainty_negative = standard_uncertainty(target.negative, t.mean_negative);
  t.repeatability_positive = 2.0 * coverage * t.uncertainty_positive;
  t.repeatability_negative = 2.0 * coverage * t.uncertainty_negative;
  Extremes bidirectional;
  bidirectional.add(coverage * t.uncertainty_positive + coverage * t.uncertainty_negative +
                    std::abs(t.reversal));
  bidirectional.add(t.repeatability_positive);
  bidirectional.add(t.repeatability_negative);
  t.repeatability = bidirectional.largest();
  return t;
}

void add_band(Extremes& extremes, double mean, double uncertainty) {
  extremes.add(mean + coverage * uncertainty);
  extremes.add(mean - coverage * uncertainty);
}

AxisRepeatability of_axis(const std::vector<TargetRepeatability>& targets) {
  if (targets.empty()) return {};
  Extremes reversal, repeatability_positive, repeatability_negative, repeatability;
  Extremes systematic_positive, systematic_negative, systematic, mean;
  Extremes accuracy_positive, accuracy_negative, accuracy;
  double reversals = 0.0;
  for (const TargetRepeatability& t : targets) {
    reversal.add(std::abs(t.reversal));
    reversals += t.reversal;
    repeatability_positive.add(t.repeatability_positive);
    repeatability_negative.add(t.repeatability_negative);
    repeatability.add(t.repeatability);
    systematic_positive.add(t.mean_positive);
    systematic_negative.add(t.mean_negative);
    systematic.add(t.mean_positive);
    systematic.add(t.mean_negative);
    mean.add(t.mean);
    add_band(accuracy_positive, t.mean_positive, t.uncertainty_positive);
    add_band(accuracy_negative, t.mean_negative, t.uncertainty_negative);
    add_band(accuracy, t.mean_positive, t.uncertainty_positive);
    add_band(accuracy, t.mean_negative, t.uncertainty_negative);
  }
  return {.reversal = reversal.largest(),
          .mean_reversal = reversals / static_cast<double>(targets.size()),
          .repeatability_positive = repeatability_positive.largest(),
          .repeatability_negative = repeatability_negative.largest(),
          .repeatability = repeatability.largest(),
          .systematic_positive = systematic_positive.range(),
          .systematic_negative = systematic_negative.range(),
          .systematic = systematic.range(),
          .mean_bidirectional = mean.range(),
          .accuracy_positive = accuracy_positive.range(),
          .accuracy_negative = accuracy_negative.range(),
          .accuracy = accuracy.range()};
}

}  // namespace

Repeatability repeatability_of(std::span<const TargetDeviations> targets) {
  Repeatability result;
  std::transform(targets.begin(), targets.end(), std::back_inserter(result.targets), of_target);
  result.axis = of_axis(result.targets);
  return result;
}

}  // namespace zerocount::iso230
