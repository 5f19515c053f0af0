#include "core/friction/sliding/free_motion.hpp"

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/exponential_differences.hpp"

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

}  // namespace zerocount::friction
