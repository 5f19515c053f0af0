#include "experiments/study/trial_completion.hpp"

#include "core/theory/gains.hpp"

namespace zerocount {
namespace {

/// Phase is ControllerParameters or CoarsePhaseParameters; both have kp, ki and kd.
template <class Phase>
void convert_gains(Phase& phase, const TrialParameters& trial) {
  const PidGains gains = sampled_gains({phase.kp, phase.ki, phase.kd}, trial.controller, trial.encoder);
  phase.kp = gains.kp;
  phase.ki = gains.ki;
  phase.kd = gains.kd;
}

}  // namespace

void complete_trial(const StudyUnits& units, TrialParameters& trial) {
  switch (units.axis) {
    case AxisKind::rotary:
      break;
    case AxisKind::linear: {
      EncoderParameters& encoder = trial.encoder;
      encoder.fine = encoder.coarse = 1.0;
      if (encoder.coarse_length == 0.0) encoder.coarse_length = encoder.fine_length;
      break;
    }
  }
  switch (units.gains) {
    case GainUnits::count:
      break;
    case GainUnits::si:
      convert_gains(trial.controller, trial);
      convert_gains(trial.controller.coarse, trial);
      break;
  }
}

}  // namespace zerocount
