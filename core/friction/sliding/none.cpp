#include "core/friction/sliding/none.hpp"

#include "core/friction/sliding/slide_formulas.hpp"

namespace zerocount::friction {
namespace {

struct FreeSeries {
  numerics::Series position{};  ///< θ, rad
  numerics::Series omega{};     ///< ω, rad/s
  numerics::Series exponent{};  ///< 0
};

/// J·dω/dt = u − c·ω, dθ/dt = ω. It has no events.
struct DampedRotor {
  using Expansion = FreeSeries;
  enum class Event { none };

  double damping;  ///< c, N m s/rad
  FreeMotion& motion;

  FreeSeries start() const {
    FreeSeries s;
    s.position[0] = motion.theta;
    s.omega[0] = motion.omega;
    return s;
  }
  double expand(FreeSeries& s, std::size_t k, double torque) const {
    return damped_coefficient(damping, s, k, torque);
  }
  static motion::NextEvent<Event> first_event(const FreeSeries&, double step) { return {step}; }
  void go_to(const FreeSeries& s, const motion::NextEvent<Event>& next) {
    motion = {numerics::value_at(s.position, next.time), numerics::value_at(s.omega, next.time)};
  }
};

}  // namespace

double NoFriction::step_coupled(const motion::TorqueCourse& torque, double duration) {
  DampedRotor rotor{plant_.presliding_damping, motion_};
  return motion::taylor_step(rotor, plant_.inertia, torque, tolerance_, duration).time;
}

}  // namespace zerocount::friction
