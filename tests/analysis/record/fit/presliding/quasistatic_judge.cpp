#include "tests/analysis/record/fit/presliding/quasistatic_judge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/tools/roots.hpp>

#include "tests/support/stop_elements.hpp"

namespace zerocount::testing {
namespace {

/// The elongation (rad) at which the spring carries `torque` (N m). It lies between x and the elongation at
/// which a spring of stiffness k1 alone would carry the torque.
double elongation_at(const StopElements& spring, double x, double torque, double k1) {
  const auto surplus = [&](double at) {
    StopElements moved = spring;
    moved.move_to(at);
    return moved.torque() - torque;
  };
  const double far = x - 1.001 * surplus(x) / k1;
  constexpr int bits = 45;
  std::uintmax_t steps = 100;
  const auto bracket = boost::math::tools::toms748_solve(
      surplus, std::min(x, far), std::max(x, far), boost::math::tools::eps_tolerance<double>(bits), steps);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace

fit::TestRecord quasistatic_test(const friction::FrictionParameters& friction, double damping,
                                 const TorqueProgramme& programme, double counts_per_revolution,
                                 double phase) {
  constexpr std::size_t elements = 1500;
  StopElements spring(friction, elements);
  fit::TestRecord record;
  record.name = "quasistatic";
  record.sample_time = programme.sample_time();
  record.unit = 2.0 * std::numbers::pi / counts_per_revolution;
  record.counted = true;
  double x = 0.0;
  double extension = 0.0;
  double hardening = 0.0;
  double velocity = 0.0;
  for (const double torque : programme.torque()) {
    const double before = x + extension;
    record.reading.push_back(std::floor(before / record.unit + phase));
    record.torque.push_back(motion::constant_torque(torque));
    const double of_spring = torque - damping * velocity;
    if (of_spring != spring.torque()) {
      x = elongation_at(spring, x, of_spring, friction.k1);
      spring.move_to(x);
    }
    constexpr int parts = 100;
    for (int i = 0; i < parts; ++i) {
      const double limit = std::pow(std::abs(torque), friction.n) / friction.lambda;
      const double growth = friction.alpha * std::max(limit - hardening, 0.0) * record.sample_time / parts;
      hardening += growth;
      extension += std::copysign(growth, torque);
    }
    velocity = (x + extension - before) / record.sample_time;
  }
  return record;
}

}  // namespace zerocount::testing
