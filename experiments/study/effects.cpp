#include "experiments/study/effects.hpp"

#include <array>

#include "experiments/study/point_limits.hpp"

namespace zerocount::study {

std::span<const Effect> effects() {
  using F = StudyFeatures;
  using R = random::TrialRandomness;
  constexpr const char* noise = "no encoder noise";
  constexpr const char* errors = "no other encoder errors";
  constexpr const char* converter = "ideal converter";
  constexpr const char* disturbance = "no disturbance";
  static constexpr std::array all{
      Effect{"encoder.fine_errors.noise", noise, &F::encoder_errors, &R::fine_noise},
      Effect{"encoder.coarse_errors.noise", noise, &F::encoder_errors, &R::coarse_noise},
      Effect{"encoder.load.fine_errors.noise", noise, &F::encoder_errors, &R::other_noise},
      Effect{"encoder.fine_errors.eccentricity", errors, &F::encoder_errors},
      Effect{"encoder.fine_errors.interpolation", errors, &F::encoder_errors},
      Effect{"encoder.fine_errors.missed", errors, &F::encoder_errors, &R::fine_missed},
      Effect{"encoder.coarse_errors.eccentricity", errors, &F::encoder_errors},
      Effect{"encoder.coarse_errors.interpolation", errors, &F::encoder_errors},
      Effect{"encoder.coarse_errors.missed", errors, &F::encoder_errors, &R::coarse_missed},
      Effect{"encoder.load.fine_errors.eccentricity", errors, &F::encoder_errors},
      Effect{"encoder.load.fine_errors.interpolation", errors, &F::encoder_errors},
      Effect{"encoder.load.fine_errors.missed", errors, &F::encoder_errors, &R::other_missed},
      Effect{"controller.delay", "no delay"},
      Effect{"controller.jitter", "no jitter", nullptr, &R::jitter},
      Effect{"controller.missed", {}, nullptr, &R::missed_samples},
      Effect{"amplifier.bandwidth", "ideal amplifier", &F::drive_torque},
      Effect{"dac.offset", converter, &F::drive_torque},
      Effect{"dac.gain_error", converter, &F::drive_torque},
      Effect{"dac.nonlinearity", converter, &F::drive_torque},
      Effect{"dac.noise", converter, &F::drive_torque, &R::dac_noise},
      Effect{"plant.load.inertia", "rigid", &F::load},
      Effect{"disturbance.torque", disturbance},
      Effect{"disturbance.ripple.#.amplitude", disturbance},
      Effect{"disturbance.vibration.#.amplitude", disturbance},
      Effect{"disturbance.load.torque", disturbance},
      Effect{"disturbance.load.ripple.#.amplitude", disturbance},
      Effect{"disturbance.load.vibration.#.amplitude", disturbance}};
  return all;
}

bool acts_somewhere(const StudyPlan& plan, std::string_view parameter) {
  return holds_somewhere(plan, parameter,
                         [](const ValueLimits& limits) { return limits.low != 0.0 || limits.high != 0.0; });
}

}  // namespace zerocount::study
