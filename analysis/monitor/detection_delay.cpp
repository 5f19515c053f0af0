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

/// The change of one class.
struct ChangeOfClass {
  double size{0.0};
  std::vector<Direction> directions{};
};

ChangeOfClass change_of_proportion(bool quality, std::span<const double> baseline, double size) {
  const double middle = quality ? mean_of(baseline) : middle_of(baseline);
  ChangeOfClass change{.size = size};
  if (middle + size <= 1.0) change.directions.push_back(Direction::higher);
  if (middle - size >= 0.0) change.directions.push_back(Direction::lower);
  return change;
}

bool can_be(const MonitoredMeasure& measure, double value) {
  if (measure.row->values.magnitude && value < 0.0) return false;
  const layout::ValidValues& valid = measure.row->field.valid;
  return valid.expected.empty() || (value >= valid.low && value <= valid.high);
}

ChangeOfClass change_of_class(const MonitoredMeasure& measure, std::span<const double> baseline,
                              std::optional<double> change) {
  if (baseline.empty()) return {};
  if (measure.scale == Scale::proportion)
    return change_of_proportion(measure.quality, baseline, change.value_or(usual_change_of_proportion));
  const double middle = middle_of(baseline);
  const auto [low, high] = std::ranges::minmax(baseline);
  if (middle == 0.0 || std::isinf(middle) || (low < 0.0 && high > 0.0 && !std::isinf(high))) return {};
  ChangeOfClass to_see{.size = change.value_or(usual_relative_change) * std::abs(middle)};
  if (can_be(measure, middle + to_see.size)) to_see.directions.push_back(Direction::higher);
  if (can_be(measure, middle - to_see.size)) to_see.directions.push_back(Direction::lower);
  return to_see;
}

/// Draws a value of a class of the changed machine.
class ChangedValue {
 public:
  ChangedValue(const DelayQuestion& question, std::size_t of_class)
      : scale_(question.measure.scale),
        baseline_(question.baseline[of_class]),
        size_(question.sizes[of_class]),
        sign_(question.direction == Direction::higher ? 1.0 : -1.0),
        is_binary_(question.measure.quality &&
                   std::ranges::all_of(baseline_, [](double x) { return x == 0.0 || x == 1.0; })) {
    if (!is_binary_ || baseline_.empty()) return;
    const double rate = mean_of(baseline_);
    flipped_ = size_ / (sign_ > 0.0 ? 1.0 - rate : rate);
  }

  double operator()(random::NumberSource& numbers) const {
    const double before = value_from(baseline_, numbers);
    if (is_binary_) {
      const bool can_flip = before == (sign_ > 0.0 ? 0.0 : 1.0);
      return can_flip && numbers.uniform() < flipped_ ? 1.0 - before : before;
    }
    switch (scale_) {
      case Scale::proportion:
        return std::isinf(before) ? before : std::clamp(before + sign_ * size_, 0.0, 1.0);
      case Scale::counts: {
        const double whole = std::floor(size_);
        const double more = whole + (numbers.uniform() < size_ - whole ? 1.0 : 0.0);
        return std::max(0.0, before + sign_ * more);
      }
      case Scale::plain:
        break;
    }
    return before + sign_ * size_;
  }

  static double value_from(std::span<const double> values, random::NumberSource& numbers) {
    const auto place = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(values.size()));
    return values[std::min(place, values.size() - 1)];
  }

 private:
  Scale scale_;
  std::span<const double> baseline_;
  double size_;
  double sign_;
  bool is_binary_;
  double flipped_{0.0};  ///< probability with which a value becomes the other one
};

/// The classes of values, drawn as often as the baseline has them.
class ClassDraw {
 public:
  explicit ClassDraw(std::span<const std::vector<double>> baseline) {
    for (const std::vector<double>& values : baseline)
      ends_.push_back((ends_.empty() ? 0 : ends_.back()) + values.size());
  }
  std::size_t total() const { return ends_.back(); }
  std::size_t operator()(random::NumberSource& numbers) const {
    if (ends_.size() == 1) return 0;
    const auto place = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(total()));
    return static_cast<std::size_t>(std::ranges::upper_bound(ends_, std::min(place, total() - 1)) -
                                    ends_.begin());
  }

 private:
  std::vector<std::size_t> ends_{};
};

std::vector<std::vector<double>> resample(std::span<const std::vector<double>> classes, std::size_t total,
                                          random::NumberSource& numbers) {
  const double part = std::min(1.0, static_cast<double>(max_resample) / static_cast<double>(total));
  std::vector<std::vector<double>> drawn;
  for (const std::vector<double>& values : classes) {
    const auto size = static_cast<std::size_t>(std::rint(part * static_cast<double>(values.size())));
    drawn.emplace_back(values.empty() ? 0 : std::max<std::size_t>(1, size));
    for (double& value : drawn.back()) value = ChangedValue::value_from(values, numbers);
  }
  return drawn;
}

}  // namespace

ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change) {
  ChangeToSee to_see;
  std::vector<Direction> possible{Direction::higher, Direction::lower};
  bool any = false;
  for (const std::vector<double>& values : baseline) {
    const ChangeOfClass one = change_of_class(measure, values, change);
    to_see.sizes.push_back(one.directions.empty() ? 0.0 : one.size);
    if (one.directions.empty()) continue;
    any = true;
    std::erase_if(possible, [&](Direction direction) {
      return std::ranges::find(one.directions, direction) == one.directions.end();
    });
  }
  if (any) to_see.directions = possible;
  return to_see;
}

std::optional<std::int64_t> values_to_see(const DelayQuestion& question) {
  const ClassDraw of_class(question.baseline);
  std::vector<ChangedValue> changed;
  for (std::size_t i = 0; i < question.baseline.size(); ++i) changed.emplace_back(question, i);
  const random::RandomKey values = designs::random_key(
      question.seed, fmt::format("monitor.{}.{}", question.measure.name,
                                 question.direction == Direction::higher ? "higher" : "lower"));
  std::vector<std::int64_t> delays;
  int misses = 0;
  for (std::uint32_t i = 0; i < sequences && misses <= max_misses; ++i) {
    random::NumberSource numbers(values, i);
    ChangeTest test(
        resample(question.baseline, of_class.total(), numbers),
        designs::random_key(question.seed, fmt::format("monitor.{}.{}", question.measure.name, i)));
    while (test.martingale().values() < question.max_values && test.martingale().capital() < question.alarm) {
      const std::size_t next = of_class(numbers);
      test.update(changed[next](numbers), next);
    }
    const bool seen = test.martingale().capital() >= question.alarm;
    if (!seen) ++misses;
    delays.push_back(seen ? test.martingale().values() : std::numeric_limits<std::int64_t>::max());
  }
  if (misses > max_misses) return std::nullopt;
  std::ranges::sort(delays);
  return delays[sequences - max_misses - 1];
}

}  // namespace zerocount::monitor
