#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/plant/plant.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

plant::Plant plant_of(const SlidingAxis& axis) {
  motion::PlantParameters parameters;
  parameters.inertia = axis.mass;
  parameters.sliding_damping = axis.damping;
  friction::FrictionAlongRotor friction;
  friction.model = friction::FrictionModel::coulomb;
  if (axis.bristle_stiffness > 0.0) {
    friction.model = friction::FrictionModel::dahl;
    friction.uniform.sigma0 = axis.bristle_stiffness;
    parameters.presliding_damping = axis.damping;
  }
  friction.uniform.breakaway = axis.breakaway;
  friction.uniform.coulomb_ratio = axis.coulomb / axis.breakaway;
  friction.uniform.stribeck_velocity = axis.stribeck_velocity;
  return plant::Plant(parameters, friction, {}, {1e-12});
}

/// The axis with its sensor and the forces that the record does not show.
class Machine {
 public:
  Machine(const SlidingAxis& axis, const AxisLoop& loop, std::mt19937_64& random)
      : axis_(axis), loop_(loop), random_(random), plant_(plant_of(axis)) {
    series_.name = "motion.csv";
    series_.linear = !axis.rotary;
    plant_.disturb({.ripple = axis.ripple});
  }

  double read() {
    const double shaken = loop_.noise > 0.0 ? loop_.noise * normal_(random_) : 0.0;
    reading_ = loop_.resolution * std::floor((plant_.theta() + shaken) / loop_.resolution + 0.37);
    return reading_;
  }

  void act(double force) {
    series_.time.push_back(loop_.sample_time * static_cast<double>(series_.time.size()));
    series_.torque.push_back(force);
    series_.angle.push_back(reading_);
    constexpr double correlation = 0.95;  // of the unknown force from sample to sample
    unknown_ = correlation * unknown_ + std::sqrt(1.0 - correlation * correlation) * normal_(random_);
    const double disturbance = axis_.friction_noise * unknown_;
    plant_.advance(motion::constant_torque(force - axis_.offset + disturbance), loop_.sample_time);
  }

  records::RawSeries series() && { return std::move(series_); }

 private:
  SlidingAxis axis_;
  AxisLoop loop_;
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  plant::Plant plant_;
  records::RawSeries series_;
  double reading_{0.0};
  double unknown_{0.0};
};

/// [sample] velocity of the reference.
std::vector<double> reference_velocity(const std::vector<Cruise>& lap, int laps, double sample_time) {
  constexpr double acceleration = 0.83;  // m/s²
  std::vector<double> velocity;
  for (int i = 0; i < laps; ++i) {
    for (const Cruise& cruise : lap) {
      const double rise = std::abs(cruise.velocity) / acceleration;
      const double total = 2.0 * rise + cruise.duration;
      for (double t = 0.0; t < total; t += sample_time) {
        velocity.push_back(cruise.velocity * std::clamp(std::min(t, total - t) / rise, 0.0, 1.0));
      }
    }
  }
  return velocity;
}

}  // namespace

std::vector<Cruise> emps_lap() {
  return {{0.0417, 0.351},  {0.0813, 0.687},  {0.1228, 1.035},  {0.0417, 0.351},
          {-0.0417, 0.351}, {-0.0813, 0.687}, {-0.1228, 1.035}, {-0.0417, 0.351}};
}

records::RawSeries closed_loop_record(const SlidingAxis& axis, const AxisLoop& loop,
                                      const std::vector<Cruise>& lap, int laps, std::mt19937_64& random) {
  Machine machine(axis, loop, random);
  double target = 0.0;
  double before = 0.0;
  double smooth_before = 0.0;
  for (const double velocity : reference_velocity(lap, laps, loop.sample_time)) {
    const double reading = machine.read();
    const double smooth = 0.5 * (reading + before);
    const double speed = (smooth - smooth_before) / loop.sample_time;
    const double voltage = loop.velocity_gain * (loop.position_gain * (target - reading) - speed);
    machine.act(loop.gain * std::clamp(voltage, -loop.voltage_limit, loop.voltage_limit));
    before = reading;
    smooth_before = smooth;
    target += velocity * loop.sample_time;
  }
  return std::move(machine).series();
}

records::RawSeries open_loop_record(const SlidingAxis& axis, const AxisLoop& loop, double duration,
                                    std::mt19937_64& random) {
  Machine machine(axis, loop, random);
  const auto samples = static_cast<int>(duration / loop.sample_time);
  for (int k = 0; k < samples; ++k) {
    machine.read();
    const double t = loop.sample_time * k;
    machine.act(axis.offset + 2.0 * axis.breakaway * std::sin(2.0 * std::numbers::pi * 0.8 * t) +
                0.8 * axis.breakaway * std::sin(2.0 * std::numbers::pi * 2.1 * t));
  }
  return std::move(machine).series();
}

}  // namespace zerocount::testing
