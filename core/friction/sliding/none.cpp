#include "core/friction/sliding/none.hpp"

#include "core/friction/sliding/slide_formulas.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::friction {

FreeMotion free_motion(const motion::PlantParameters& plant, const FreeMotion& start,
                       const motion::TorqueCourse& torque, double t) {
  const double settled = motion::is_constant(torque) ? torque.now : torque.settled;
  const double damping = plant.presliding_damping / plant.inertia * t;  // a·t
  const double impulse = settled / plant.inertia * t;                   // U/J·t, rad/s
  const double mean_decay = numerics::exponential_difference(damping);
  FreeMotion end;
  end.omega = start.omega * numerics::exp(-damping) + impulse * mean_decay;
  end.theta = start.theta + t * (start.omega * mean_decay +
                                 impulse * numerics::second_exponential_difference(0.0, damping));
  if (motion::is_constant(torque)) return end;
  const double lag = (torque.now - settled) / plant.inertia * t;  // (u(0) − U)/J·t, rad/s
  const double settling = torque.rate * t;                        // r·t
  end.omega += lag * numerics::exponential_difference(damping, settling);
  end.theta += t * lag * numerics::second_exponential_difference(damping, settling);
  return end;
}

namespace {

struct FreeSeries {
  numerics::Series position{};  ///< Rotor angle θ, rad
  numerics::Series omega{};     ///< Rotor velocity ω, rad/s
  numerics::Series exponent{};  ///< Exponent of the motion's exponential: 0, because there is none
};

/// The motion J·dω/dt = u − c·ω, dθ/dt = ω of a rotor with viscous damping alone, for the Taylor integrator.
/// It has no events.
struct DampedRotor {
  using Expansion = FreeSeries;
  enum class Event { none };

  double damping;  ///< Viscous damping c, N m s/rad
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
