#include "analysis/theory/load_mode.hpp"

#include <numbers>

namespace zerocount::theory {

motion::PlantParameters with_load_mode(motion::PlantParameters plant, double frequency) {
  constexpr double load_part = 0.5;       // of the inertia
  constexpr double damping_ratio = 0.01;  // of the mode
  const double inertia = plant.inertia;
  const double swinging = load_part * (1.0 - load_part) * inertia;  // of both masses against each other
  const double rate = 2.0 * std::numbers::pi * frequency;
  plant.inertia = (1.0 - load_part) * inertia;
  plant.load = {.inertia = load_part * inertia,
                .stiffness = swinging * rate * rate,
                .damping = 2.0 * damping_ratio * swinging * rate};
  return plant;
}

}  // namespace zerocount::theory
