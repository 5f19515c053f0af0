#include "analysis/identification/record_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/plant/plant.hpp"

namespace zerocount::identification {
namespace {

/// Truncation error allowed per Taylor step, in units of the readings.
constexpr double motion_tolerance = 1e-9;

/// Step of the finite differences: small enough for a smooth path, far above the integration error.
constexpr double difference_step = 1e-6;

/// Decay rate (1/s) of the slowest oscillation about a point of the spring.
double decay_rate(const ContactParameters& contact) {
  const double damping = contact.plant.presliding_damping;
  const double inertia = contact.plant.inertia;
  const double stiffness = contact.friction.k1;
  const double discriminant = damping * damping - 4.0 * inertia * stiffness;
  if (discriminant <= 0.0) return damping / (2.0 * inertia);
  return 2.0 * stiffness / (damping + std::sqrt(discriminant));
}

/// Fills the samples inside a step of `m` samples by cubic Hermite interpolation.
void fill_between(Eigen::VectorXd& path, std::size_t first, std::size_t m, double slope_first,
                  double slope_last) {
  const double from = path[static_cast<Eigen::Index>(first)];
  const double to = path[static_cast<Eigen::Index>(first + m)];
  for (std::size_t i = 1; i < m; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(m);
    const double r = 1.0 - s;
    path[static_cast<Eigen::Index>(first + i)] =
        from * r * r * (1.0 + 2.0 * s) + to * s * s * (3.0 - 2.0 * s) +
        static_cast<double>(m) * s * r * (slope_first * r - slope_last * s);
  }
}

/// Simulation of the plant along a record.
class RecordRun {
 public:
  RecordRun(const TestRecord& record, const ContactParameters& contact)
      : record_(record),
        plant_(contact.plant, {contact.friction, {}}, record.start, {motion_tolerance * record.unit}),
        path_(static_cast<Eigen::Index>(sample_count(record))),
        settled_after_(samples_of(40.0 / decay_rate(contact))),
        creep_stride_(samples_of(0.03 / contact.friction.alpha)) {}

  Eigen::VectorXd run() {
    const std::size_t samples = sample_count(record_);
    std::size_t k = 0;
    note(k);
    for (std::size_t held = 0; k + 1 < samples;) {
      if (!same_torque(k)) held = 0;
      const bool strides = record_.intervals.empty() && held > settled_after_;
      const std::size_t end = strides ? hold_end(k) : k;
      const std::size_t stride = std::min(creep_stride_, end - k);
      if (stride >= 2) {
        stride_over(k, stride);
        k += stride;
        held += stride;
      } else {
        plant_.advance(record_.torque[k], interval_after(record_, k));
        note(++k);
        ++held;
      }
    }
    return std::move(path_);
  }

 private:
  std::size_t samples_of(double duration) const {
    return static_cast<std::size_t>(std::clamp(duration / record_.sample_time, 1.0, 1e9));
  }

  void note(std::size_t k) { path_[static_cast<Eigen::Index>(k)] = plant_.theta() / record_.unit; }

  /// Whether the torque is constant over sample k and equal to the one before.
  bool same_torque(std::size_t k) const {
    return k > 0 && motion::is_constant(record_.torque[k]) && motion::is_constant(record_.torque[k - 1]) &&
           record_.torque[k].now == record_.torque[k - 1].now;
  }

  /// The last sample with the same torque as sample k.
  std::size_t hold_end(std::size_t k) const {
    const motion::TorqueCourse& torque = record_.torque[k];
    std::size_t end = k;
    while (end + 1 < sample_count(record_) && end < k + creep_stride_ &&
           motion::is_constant(record_.torque[end]) && record_.torque[end].now == torque.now) {
      ++end;
    }
    return end;
  }

  void stride_over(std::size_t k, std::size_t stride) {
    const double per_sample = record_.sample_time / record_.unit;
    const double slope_first = plant_.omega() * per_sample;
    plant_.advance(record_.torque[k], static_cast<double>(stride) * record_.sample_time);
    note(k + stride);
    fill_between(path_, k, stride, slope_first, plant_.omega() * per_sample);
  }

  const TestRecord& record_;
  plant::Plant plant_;
  Eigen::VectorXd path_;
  std::size_t settled_after_;
  std::size_t creep_stride_;
};

}  // namespace

Eigen::VectorXd angle_path(const TestRecord& record, const ContactParameters& contact) {
  return RecordRun(record, contact).run();
}

RecordMotion motion_with_sensitivity(const TestRecord& record, const ContactPoint& point, double creep_torque,
                                     const FreeCoordinates& free) {
  RecordMotion motion;
  motion.path = angle_path(record, contact_at(point, creep_torque));
  motion.sensitivity.setZero(motion.path.size(), coordinate_count);
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    if (!free[j]) continue;
    ContactPoint moved = point;
    moved[j] += difference_step;
    const double step = moved[j] - point[j];
    motion.sensitivity.col(static_cast<Eigen::Index>(j)) =
        (angle_path(record, contact_at(moved, creep_torque)) - motion.path) / step;
  }
  return motion;
}

}  // namespace zerocount::identification
