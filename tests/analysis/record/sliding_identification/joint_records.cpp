#include "tests/analysis/record/sliding_identification/joint_records.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "tests/analysis/record/sliding_identification/coverage.hpp"

namespace zerocount::testing {
namespace {

using State = std::array<double, 4>;  // θ, ω of the motor and of the load

class MovingJoint {
 public:
  explicit MovingJoint(const Joint& joint) : joint_(joint) {}

  double theta() const { return state_[0]; }

  void advance(double torque, double duration) {
    torque_ = torque;
    constexpr int parts = 8;
    for (int i = 0; i < parts; ++i) step(duration / parts);
    time_ += duration;
  }

 private:
  bool two_masses() const { return joint_.stiffness > 0.0; }

  double coupling(const State& y) const {
    return joint_.stiffness * (y[0] - y[2]) + joint_.coupling_damping * (y[1] - y[3]);
  }

  double gravity(double angle) const { return joint_.gravity * std::sin(angle + joint_.gravity_phase); }

  /// Sum of all torques on the motor except its friction, N m.
  double drive(const State& y) const {
    const double ripple = joint_.ripple * std::sin(joint_.periods * y[0] + joint_.ripple_phase);
    return torque_ - joint_.offset + ripple + (two_masses() ? -coupling(y) : gravity(y[0]));
  }

  double level(double speed, int direction) const {
    const double ratio = joint_.stribeck_velocity > 0.0 ? speed / joint_.stribeck_velocity : 0.0;
    return joint_.coulomb * (1.0 - joint_.coulomb_drift * time_) + 0.5 * direction * joint_.directional +
           joint_.excess * std::exp(-ratio * ratio);
  }

  /// Friction of the transmission, N m, which grows with the torque u − d that it carries; d is the sum of
  /// all other torques except friction.
  double load_friction(const State& y) const {
    return joint_.load_friction * 0.5 * std::abs(2.0 * torque_ - drive(y));
  }

  State slopes(const State& y) const {
    State slope{};
    if (direction_ != 0) {
      const double damping = joint_.damping * (1.0 + joint_.damping_asymmetry * direction_);
      const double friction = damping * y[1] + joint_.quadratic * y[1] * std::abs(y[1]) +
                              direction_ * (level(y[1], direction_) + load_friction(y));
      slope[0] = y[1];
      slope[1] = (drive(y) - friction) / joint_.inertia;
    }
    if (two_masses()) {
      slope[2] = y[3];
      slope[3] = (coupling(y) + gravity(y[2])) / joint_.load;
    }
    return slope;
  }

  State after(double time) const {
    boost::numeric::odeint::runge_kutta_dopri5<State> stepper;
    State end = state_;
    stepper.do_step([this](const State& y, State& slope, double) { slope = slopes(y); }, end, 0.0, time);
    return end;
  }

  void step(double time) {
    if (direction_ == 0) {
      const double torque = drive(state_);
      const int towards = torque > 0.0 ? 1 : -1;
      if (std::abs(torque) > level(0.0, towards) + load_friction(state_)) direction_ = towards;
    }
    const State end = after(time);
    if (direction_ == 0 || direction_ * end[1] >= 0.0) {
      state_ = end;
      return;
    }
    double before = 0.0;
    double behind = time;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (before + behind);
      (direction_ * after(middle)[1] >= 0.0 ? before : behind) = middle;
    }
    state_ = after(before);
    state_[1] = 0.0;
    direction_ = 0;
    if (time - behind > 1e-9 * time) step(time - behind);
  }

  const Joint& joint_;
  State state_{};
  double torque_{0.0};
  double time_{0.0};
  int direction_{0};  // of the slide; 0 at rest
};

/// [sample] the reference position, rad, of moves to the targets with this speed (rad/s).
std::vector<double> reference(const std::vector<double>& targets, double speed, double sample_time) {
  constexpr double rise = 0.08;  // s
  constexpr double dwell = 0.1;  // s
  std::vector<double> course;
  double from = 0.0;
  for (const double target : targets) {
    const double way = std::abs(target - from);
    const double total = way / speed + rise;
    double moved = 0.0;
    for (double t = 0.0; t < total + dwell; t += sample_time) {
      course.push_back(from + std::copysign(std::min(moved, way), target - from));
      moved += sample_time * speed * std::clamp(std::min(t, total - t) / rise, 0.0, 1.0);
    }
    from = target;
  }
  return course;
}

}  // namespace

Joint random_joint(std::mt19937_64& random) {
  const auto between = [&](double low, double high) { return log_uniform(random, low, high); };
  Joint joint;
  joint.inertia = between(0.05, 2.0);
  joint.damping = joint.inertia * between(0.3, 10.0);
  joint.coulomb = joint.inertia * between(1.0, 10.0);
  joint.offset = joint.coulomb * std::uniform_real_distribution<double>(-0.5, 0.5)(random);
  if (random() % 2 == 0) {
    joint.excess = joint.coulomb * between(0.1, 0.5);
    joint.stribeck_velocity = between(0.02, 0.1);
  }
  const std::array rates{1000.0, 2000.0, 4000.0};
  joint.sample_time = 1.0 / rates[random() % rates.size()];
  joint.resolution = 2.0 * std::numbers::pi / between(1e5, 1e8);
  joint.noise = joint.resolution * between(0.1, 2.0);
  return joint;
}

JointMotion random_joint_motion(std::mt19937_64& random, bool with_gravity, bool with_ripple) {
  JointMotion motion;
  motion.joint = random_joint(random);
  Joint& joint = motion.joint;
  const double range = log_uniform(random, 0.3, 8.0);
  const std::size_t moves = 2 + random() % 13;
  double at = 0.0;
  while (motion.targets.size() < moves) {
    const double target = uniform(random, -0.5, 0.5) * range;
    if (std::abs(target - at) < 0.15 * range) continue;
    motion.targets.push_back(target);
    at = target;
  }
  motion.speed = std::min(log_uniform(random, 0.5, 4.0), 3.0 * range);
  if (with_gravity) joint.gravity = joint.coulomb * log_uniform(random, 0.3, 5.0);
  joint.gravity_phase = uniform(random, -3.0, 3.0);
  if (with_ripple) joint.ripple = joint.coulomb * log_uniform(random, 0.05, 0.5);
  joint.periods = std::round(log_uniform(random, 3.0, 80.0));
  joint.ripple_phase = uniform(random, -3.0, 3.0);
  return motion;
}

records::RawSeries joint_record(const Joint& joint, const std::vector<double>& targets, double speed,
                                std::mt19937_64& random) {
  constexpr double position_gain = 25.0;   // 1/s
  constexpr double velocity_gain = 150.0;  // 1/s, times the inertia
  MovingJoint motion(joint);
  records::RawSeries series;
  series.name = "joint.csv";
  std::normal_distribution<double> normal;
  double before = 0.0;
  double speed_read = 0.0;
  for (const double target : reference(targets, speed, joint.sample_time)) {
    const double shaken = motion.theta() + joint.noise * normal(random);
    const double reading = joint.resolution * std::floor(shaken / joint.resolution + 0.37);
    constexpr double smoothing = 0.4;
    speed_read += smoothing * ((reading - before) / joint.sample_time - speed_read);
    before = reading;
    const double torque =
        (joint.inertia + joint.load) * velocity_gain * (position_gain * (target - reading) - speed_read);
    series.time.push_back(joint.sample_time * static_cast<double>(series.time.size()));
    series.torque.push_back(torque);
    series.angle.push_back(reading);
    const std::size_t acting = series.torque.size() - 1;
    const auto delay = static_cast<std::size_t>(joint.torque_delay);
    motion.advance(acting < delay ? 0.0 : series.torque[acting - delay], joint.sample_time);
  }
  return series;
}

}  // namespace zerocount::testing
