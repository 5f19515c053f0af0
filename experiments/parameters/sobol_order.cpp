#include "experiments/parameters/sobol_order.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::parameters {
namespace {

constexpr std::array<std::string_view, 63> before_moves{
    "friction.k1",
    "friction.k2",
    "initial.encoder_phase",
    "friction.beta",
    "friction.alpha",
    "friction.lambda",
    "friction.breakaway",
    "friction.coulomb_ratio",
    "friction.stribeck_velocity",
    "initial.position",
    "initial.hardening",
    "initial.preload",
    "plant.inertia",
    "plant.presliding_damping",
    "plant.sliding_damping",
    "friction.n",
    "encoder.fine",
    "encoder.coarse",
    "dac.bits",
    "dac.resolution",
    "controller.sample_rate",
    "controller.kp",
    "controller.ki",
    "controller.kd",
    "controller.delay",
    "controller.anti_windup",
    "command.hold",
    "verdict.dwell",
    "verdict.window",
    "encoder.fine_errors.eccentricity",
    "encoder.fine_errors.eccentricity_angle",
    "encoder.fine_errors.interpolation",
    "encoder.fine_errors.interpolation_period",
    "encoder.fine_errors.noise",
    "encoder.fine_errors.missed",
    "encoder.coarse_errors.eccentricity",
    "encoder.coarse_errors.eccentricity_angle",
    "encoder.coarse_errors.interpolation",
    "encoder.coarse_errors.interpolation_period",
    "encoder.coarse_errors.noise",
    "encoder.coarse_errors.missed",
    "dac.offset",
    "dac.gain_error",
    "dac.nonlinearity",
    "dac.noise",
    "amplifier.bandwidth",
    "controller.coarse.kp",
    "controller.coarse.ki",
    "controller.coarse.kd",
    "controller.coarse.fine_within",
    "controller.coarse.fine_rate",
    "controller.coarse.fine_dwell",
    "controller.coarse.coarse_beyond",
    "command.profile.velocity_limit",
    "command.profile.acceleration_limit",
    "command.profile.jerk_limit",
    "command.torque.rate",
    "command.sequence.overrun",
    "initial.velocity",
    "initial.integral",
    "initial.history.reversals",
    "initial.history.torque",
    "verdict.limit",
};
static_assert(before_moves.size() <= first_sobol_dimension_of_moves);

// Most of them have labels and are never drawn. Add new parameters at the end of this list.
constexpr std::array<std::string_view, 9> beyond_moves{
    "friction.model",         "controller.encoder",    "controller.coarse.encoder",
    "command.torque.through", "command.profile.shape", "initial.mode",
    "verdict.stop",           "encoder.resolution",    "encoder.coarse_resolution",
};

}  // namespace

std::size_t sobol_dimension(std::string_view parameter) {
  const auto before = std::find(before_moves.begin(), before_moves.end(), parameter);
  if (before != before_moves.end()) return static_cast<std::size_t>(before - before_moves.begin());
  const auto beyond = std::find(beyond_moves.begin(), beyond_moves.end(), parameter);
  if (beyond != beyond_moves.end()) {
    return first_sobol_dimension_beyond_moves + static_cast<std::size_t>(beyond - beyond_moves.begin());
  }
  throw std::logic_error(std::string(parameter) + " has no place in the order of Sobol dimensions");
}

}  // namespace zerocount::parameters
