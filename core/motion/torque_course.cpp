#include "core/motion/torque_course.hpp"

#include <cmath>
#include <limits>

#include "core/motion/disturbance.hpp"
#include "core/motion/load.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::motion {

double torque_on_rotor(const TorqueCourse& course, double omega) {
  double torque = course.now;
  if (course.load != nullptr) torque -= coupling_torque(*course.load, omega);
  if (course.disturbance != nullptr) torque += value(*course.disturbance);
  return torque;
}

double applied_torque_rate(const TorqueCourse& course, double omega) {
  const double of_motor = motor_is_constant(course) ? 0.0 : course.rate * (course.settled - course.now);
  return course.disturbance == nullptr ? of_motor : of_motor + rate(*course.disturbance, omega);
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
