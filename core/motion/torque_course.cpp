#include "core/motion/torque_course.hpp"

#include <cmath>
#include <limits>

namespace zerocount::motion {

TorqueCourse course_after(const TorqueCourse& course, double t) {
  if (is_constant(course)) return course;
  // Computed as a change of `now`, so that a small change keeps its digits.
  const double change = (course.now - course.settled) * std::expm1(-course.rate * t);
  return {course.now + change, course.settled, course.rate};
}

double time_until(const TorqueCourse& course, double torque) {
  if (torque == course.now) return 0.0;
  if (is_constant(course)) return std::numeric_limits<double>::infinity();
  const double change = (torque - course.now) / (course.now - course.settled);  // from 0 to −1
  if (change >= 0.0) return 0.0;
  if (change <= -1.0) return std::numeric_limits<double>::infinity();
  return -std::log1p(change) / course.rate;
}

}  // namespace zerocount::motion
