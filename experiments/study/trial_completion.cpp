#include "core/theory/gains.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {
namespace {

/// Phase is ControllerParameters or CoarsePhaseParameters; both have kp, ki and kd.
template <class Phase>
void convert_gains(Phase& phase, const trial::TrialParameters& trial) {
  const loop::PidGains gains =
      theory::sampled_gains({phase.kp, phase.ki, phase.kd}, trial.controller, trial.encoder);
  phase.kp = gains.kp;
  phase.ki = gains.ki;
  phase.kd = gains.kd;
}

}  // namespace

void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial) {
  switch (units.axis) {
    case parameters::AxisKind::rotary:
      break;
    case parameters::AxisKind::linear: {
      loop::EncoderParameters& encoder = trial.encoder;
      encoder.fine = encoder.coarse = 1.0;
      if (encoder.coarse_length == 0.0) encoder.coarse_length = encoder.fine_length;
      break;
    }
  }
  switch (units.gains) {
    case parameters::GainUnits::count:
      break;
    case parameters::GainUnits::si:
      convert_gains(trial.controller, trial);
      convert_gains(trial.controller.coarse, trial);
      convert_gains(trial.controller.blocks.standstill, trial);
      convert_gains(trial.controller.coarse.blocks.standstill, trial);
      break;
  }
}

}  // namespace zerocount::study
