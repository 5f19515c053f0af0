#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/record/fit/record.hpp"

namespace zerocount::fit {
namespace {

/// Fills in the samples inside a long step of `m` samples by cubic Hermite interpolation.
/// @param first index of the sample at which the step begins
void fill_between(SampledPath& path, Eigen::Index first, std::size_t m) {
  const Eigen::Index last = first + static_cast<Eigen::Index>(m);
  const double from = path.angle[first];
  const double to = path.angle[last];
  const auto samples = static_cast<double>(m);
  const double slope_first = samples * path.velocity[first];
  const double slope_last = samples * path.velocity[last];
  for (std::size_t i = 1; i < m; ++i) {
    const double s = static_cast<double>(i) / samples;
    const double r = 1.0 - s;
    const Eigen::Index at = first + static_cast<Eigen::Index>(i);
    path.angle[at] = from * r * r * (1.0 + 2.0 * s) + to * s * s * (3.0 - 2.0 * s) +
                     s * r * (slope_first * r - slope_last * s);
    path.velocity[at] =
        (6.0 * s * r * (to - from) + r * (1.0 - 3.0 * s) * slope_first + s * (3.0 * s - 2.0) * slope_last) /
        samples;
  }
}

/// Simulation of the plant along a record. Interval i of the torque lasts from i to i + 1 samples; with a
/// delay d the reading k is at the time k − d on this axis: in interval k − ⌈d⌉, at the fraction ⌈d⌉ − d.
class RecordRun {
 public:
  RecordRun(const TestRecord& record, plant::Plant plant, double offset, const LongSteps& steps)
      : record_(record),
        plant_(std::move(plant)),
        settled_after_(samples_of(steps.settled_after)),
        creep_stride_(samples_of(steps.longest)),
        delay_(record.delay_fraction + offset) {
    lag_ = static_cast<std::ptrdiff_t>(std::ceil(delay_));
    fraction_ = std::ceil(delay_) - delay_;
    path_.angle.setConstant(static_cast<Eigen::Index>(sample_count(record)), plant_.theta() / record.unit);
    path_.velocity.setZero(static_cast<Eigen::Index>(sample_count(record)));
  }

  SampledPath run() {
    if (record_.intervals.empty()) {
      run_even();
    } else {
      run_uneven();
    }
    return std::move(path_);
  }

 private:
  void run_even() {
    const auto samples = static_cast<std::ptrdiff_t>(sample_count(record_));
    std::ptrdiff_t at = 0;    // the interval of a reading
    std::ptrdiff_t k = lag_;  // its number, which is negative before the first one
    if (fraction_ > 0.0) plant_.advance(torque_of(0), fraction_ * record_.sample_time);
    if (k >= 0 && k < samples) note(k);
    for (std::size_t held = 0; k + 1 < samples;) {
      if (!same_torque(at)) held = 0;
      const std::size_t steady = held > settled_after_ ? steady_samples(at, samples - 1 - k) : 1;
      const std::size_t stride = k < 0 ? 1 : std::min(creep_stride_, steady);
      if (stride >= 2) {
        plant_.advance(torque_of(at), static_cast<double>(stride) * record_.sample_time);
      } else {
        advance_sample(at);
      }
      const std::ptrdiff_t before = k;
      k += static_cast<std::ptrdiff_t>(stride);
      at += static_cast<std::ptrdiff_t>(stride);
      held += stride;
      if (k >= 0) note(k);
      if (stride >= 2) fill_between(path_, before, stride);
    }
  }

  /// Simulates a record with uneven sampling from event to event. An event is a reading, or a change of the
  /// torque.
  void run_uneven() {
    double now = delay_ * record_.sample_time;  // when the first torque begins
    double begin = now;                         // of the torque's interval
    std::size_t interval = 0;
    const auto advance_to = [&](double end) {
      plant_.advance(motion::course_after(record_.torque[interval], now - begin), end - now);
      now = end;
    };
    double read_at = 0.0;
    for (std::size_t k = 0; k < sample_count(record_); ++k) {
      if (read_at >= now) {
        while (interval + 1 < record_.torque.size()) {
          const double end = begin + interval_after(record_, interval);
          if (end > read_at) break;
          advance_to(end);
          begin = end;
          ++interval;
        }
        if (read_at > now) advance_to(read_at);
        note(static_cast<std::ptrdiff_t>(k));
      }
      read_at += interval_after(record_, k);
    }
  }

  std::size_t samples_of(double duration) const {
    return static_cast<std::size_t>(std::clamp(duration / record_.sample_time, 1.0, 1e9));
  }

  /// Course of the torque over an interval between two samples. After the last interval the last torque
  /// stays.
  const motion::TorqueCourse& torque_of(std::ptrdiff_t interval) const {
    return record_.torque[static_cast<std::size_t>(
        std::min(interval, static_cast<std::ptrdiff_t>(record_.torque.size()) - 1))];
  }

  void note(std::ptrdiff_t k) {
    path_.angle[k] = plant_.theta() / record_.unit;
    path_.velocity[k] = plant_.omega() * record_.sample_time / record_.unit;
  }

  /// Advances the simulated plant by one sample: from the time of a reading within one torque interval to
  /// that of the next reading within the next interval.
  void advance_sample(std::ptrdiff_t interval) {
    const motion::TorqueCourse& torque = torque_of(interval);
    if (fraction_ == 0.0 || same_torque(interval + 1)) {
      plant_.advance(torque, record_.sample_time);
      return;
    }
    const double before = fraction_ * record_.sample_time;
    plant_.advance(motion::course_after(torque, before), record_.sample_time - before);
    plant_.advance(torque_of(interval + 1), before);
  }

  /// True if the torque is constant over an interval and equal to the one before.
  bool same_torque(std::ptrdiff_t interval) const {
    if (interval <= 0) return false;
    const motion::TorqueCourse& torque = torque_of(interval);
    const motion::TorqueCourse& before = torque_of(interval - 1);
    return motion::is_constant(torque) && motion::is_constant(before) && torque.now == before.now;
  }

  /// Number of samples, at most `most`, until the last reading that is reached while the torque of this
  /// interval stays unchanged.
  std::size_t steady_samples(std::ptrdiff_t interval, std::ptrdiff_t most) const {
    if (!motion::is_constant(torque_of(interval))) return 1;
    if (fraction_ > 0.0 && !same_torque(interval + 1)) return 1;
    const std::ptrdiff_t limit = std::min(most, static_cast<std::ptrdiff_t>(creep_stride_));
    const std::ptrdiff_t reaches = fraction_ > 0.0 ? 1 : 0;  // into the next interval
    std::ptrdiff_t steady = 1;
    while (steady < limit && same_torque(interval + steady + reaches)) ++steady;
    return static_cast<std::size_t>(steady);
  }

  const TestRecord& record_;
  plant::Plant plant_;
  SampledPath path_;
  std::size_t settled_after_;
  std::size_t creep_stride_;
  double delay_;  // samples
  std::ptrdiff_t lag_{0};
  double fraction_{0.0};
};

}  // namespace

SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps) {
  return RecordRun(record, std::move(plant), offset, steps).run();
}

}  // namespace zerocount::fit
