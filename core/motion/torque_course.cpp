#include "core/motion/torque_course.hpp"

#include <cmath>
#include <limits>

#include "core/motion/disturbance.hpp"
#include "core/motion/load.hpp"
#include "core/motion/taylor_step.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::motion {

double torque_on_rotor(const TorqueCourse& course, double omega) {
  double torque = course.now;
  if (course.load != nullptr) torque -= coupling_torque(*course.load, omega);
  if (course.disturbance != nullptr) torque += value(*course.disturbance);
  return torque;
}

namespace {

/// A rotor that is held still, for the Taylor integrator, to find how the torque on it changes.
struct HeldRotor {
  struct Expansion {
    numerics::Series position{};
    numerics::Series omega{};
    numerics::Series exponent{};
    double change{0.0};  // first coefficient of the torque beyond the present value that is not 0
  };
  enum class Event { none };

  static Expansion start() { return {}; }
  static double expand(Expansion& series, std::size_t k, double torque) {
    if (k > 0 && series.change == 0.0) series.change = torque;
    return 0.0;
  }
  static NextEvent<Event> first_event(const Expansion&, double step) { return {step}; }
  void go_to(const Expansion&, const NextEvent<Event>&) {}
};

}  // namespace

double change_of_torque(const TorqueCourse& course, double omega) {
  if (course.load != nullptr && !is_plain(*course.load)) {
    LoadSeries load_series;
    return motion_series(HeldRotor{}, 1.0, course, load_series).change;
  }
  const double of_motor = motor_is_constant(course) ? 0.0 : course.rate * (course.settled - course.now);
  return course.disturbance == nullptr ? of_motor : of_motor + rate(*course.disturbance, omega);
}

double heading_under(const TorqueCourse& course, double omega, double friction) {
  if (omega != 0.0) return numerics::sign_of(omega);
  const double excess = torque_on_rotor(course, omega) - friction;
  return numerics::sign_of(excess != 0.0 ? excess : change_of_torque(course, omega));
}

bool load_is_quiet(const TorqueCourse& course, double omega, double inertia, double torque,
                   double acceleration) {
  if (course.load == nullptr) return true;
  const double steady = course.load->parameters.inertia * acceleration;
  return is_quiet(*course.load, omega, inertia, torque + 0.1 * std::abs(steady), steady);
}

void let_load_follow(const TorqueCourse& course, double omega) {
  if (course.load != nullptr) follow_rotor(*course.load, omega);
}

TorqueCourse course_after(const TorqueCourse& course, double t) {
  if (motor_is_constant(course)) return course;
  // Computed as a change of `now`, so that a small change keeps its digits.
  const double change = (course.now - course.settled) * numerics::expm1(-course.rate * t);
  return {course.now + change, course.settled, course.rate, course.load, course.disturbance};
}

double time_until(const TorqueCourse& course, double torque) {
  if (torque == course.now) return 0.0;
  if (motor_is_constant(course)) return std::numeric_limits<double>::infinity();
  const double change = (torque - course.now) / (course.now - course.settled);  // from 0 to −1
  if (change >= 0.0) return 0.0;
  if (change <= -1.0) return std::numeric_limits<double>::infinity();
  return -numerics::log1p(change) / course.rate;
}

}  // namespace zerocount::motion
