#include "analysis/monitor/detection_delay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "analysis/monitor/change_test.hpp"
#include "core/random/number_source.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::monitor {
namespace {

constexpr double usual_relative_change = 0.2;
constexpr double usual_change_of_proportion = 0.1;
constexpr int sequences = 200;
constexpr int max_misses = sequences / 10;
constexpr std::size_t max_resample = 5000;

double middle_of(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  const auto middle = copy.begin() + static_cast<std::ptrdiff_t>(copy.size() / 2);
  std::nth_element(copy.begin(), middle, copy.end());
  return *middle;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

ChangeToSee change_of_proportion(bool quality, std::span<const double> baseline, double size) {
  const double middle = quality ? mean_of(baseline) : middle_of(baseline);
  ChangeToSee change{.size = size};
  if (middle + size <= 1.0) change.directions.push_back(Direction::higher);
  if (middle - size >= 0.0) change.directions.push_back(Direction::lower);
  return change;
}

bool can_be(const MonitoredMeasure& measure, double value) {
  if (measure.row->values.magnitude && value < 0.0) return false;
  const layout::ValidValues& valid = measure.row->field.valid;
  return valid.expected.empty() || (value >= valid.low && value <= valid.high);
}

/// Draws a value of the changed machine.
class ChangedValue {
 public:
  explicit ChangedValue(const DelayQuestion& question)
      : question_(question),
        sign_(question.direction == Direction::higher ? 1.0 : -1.0),
        is_binary_(question.measure.quality &&
                   std::ranges::all_of(question.baseline, [](double x) { return x == 0.0 || x == 1.0; })) {
    if (!is_binary_) return;
    const double rate = mean_of(question.baseline);
    flipped_ = question.size / (sign_ > 0.0 ? 1.0 - rate : rate);
  }

  double operator()(random::NumberSource& numbers) const {
    const double before = value_from(question_.baseline, numbers);
    if (is_binary_) {
      const bool can_flip = before == (sign_ > 0.0 ? 0.0 : 1.0);
      return can_flip && numbers.uniform() < flipped_ ? 1.0 - before : before;
    }
    switch (question_.measure.scale) {
      case Scale::proportion:
        return std::isinf(before) ? before : std::clamp(before + sign_ * question_.size, 0.0, 1.0);
      case Scale::counts: {
        const double whole = std::floor(question_.size);
        const double more = whole + (numbers.uniform() < question_.size - whole ? 1.0 : 0.0);
        return std::max(0.0, before + sign_ * more);
      }
      case Scale::plain:
        break;
    }
    return before + sign_ * question_.size;
  }

  static double value_from(std::span<const double> values, random::NumberSource& numbers) {
    const auto place = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(values.size()));
    return values[std::min(place, values.size() - 1)];
  }

 private:
  const DelayQuestion& question_;
  double sign_;
  bool is_binary_;
  double flipped_{0.0};  ///< probability with which a value becomes the other one
};

std::vector<double> resample(std::span<const double> values, random::NumberSource& numbers) {
  std::vector<double> drawn(std::min(values.size(), max_resample));
  for (double& value : drawn) value = ChangedValue::value_from(values, numbers);
  return drawn;
}

}  // namespace

ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const double> baseline,
                          std::optional<double> change) {
  if (measure.scale == Scale::proportion)
    return change_of_proportion(measure.quality, baseline, change.value_or(usual_change_of_proportion));
  const double middle = middle_of(baseline);
  const auto [low, high] = std::ranges::minmax(baseline);
  if (middle == 0.0 || std::isinf(middle) || (low < 0.0 && high > 0.0 && !std::isinf(high))) return {};
  ChangeToSee to_see{.size = change.value_or(usual_relative_change) * std::abs(middle)};
  if (can_be(measure, middle + to_see.size)) to_see.directions.push_back(Direction::higher);
  if (can_be(measure, middle - to_see.size)) to_see.directions.push_back(Direction::lower);
  return to_see;
}

std::optional<std::int64_t> values_to_see(const DelayQuestion& question) {
  const ChangedValue changed(question);
  const random::RandomKey values = designs::random_key(
      question.seed, fmt::format("monitor.{}.{}", question.measure.name,
                                 question.direction == Direction::higher ? "higher" : "lower"));
  std::vector<std::int64_t> delays;
  int misses = 0;
  for (std::uint32_t i = 0; i < sequences && misses <= max_misses; ++i) {
    random::NumberSource numbers(values, i);
    ChangeTest test(
        resample(question.baseline, numbers),
        designs::random_key(question.seed, fmt::format("monitor.{}.{}", question.measure.name, i)));
    while (test.martingale().values() < question.max_values && test.martingale().capital() < question.alarm)
      test.update(changed(numbers));
    const bool seen = test.martingale().capital() >= question.alarm;
    if (!seen) ++misses;
    delays.push_back(seen ? test.martingale().values() : std::numeric_limits<std::int64_t>::max());
  }
  if (misses > max_misses) return std::nullopt;
  std::ranges::sort(delays);
  return delays[sequences - max_misses - 1];
}

}  // namespace zerocount::monitor
