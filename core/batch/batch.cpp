#include "core/batch/batch.hpp"

#include "core/batch/lane_work.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/measurement.hpp"

namespace zerocount {
namespace {

constexpr int max_delay = 64;

// What lanes can run, as lists of what they know. Each enumeration has all of its words here, and each
// structure all of its members: the compiler refuses one that is added later until it is decided here.

bool lanes_know(ReferenceShape shape) {
  switch (shape) {
    case ReferenceShape::step:
      return true;
    case ReferenceShape::trapezoidal:
    case ReferenceShape::s_curve:
      break;
  }
  return false;
}

bool lanes_know(EncoderChoice encoder) {
  switch (encoder) {
    case EncoderChoice::fine:
      return true;
    case EncoderChoice::coarse:
      break;
  }
  return false;
}

bool lanes_know(const AmplifierParameters& amplifier) {
  const auto& [bandwidth] = amplifier;
  return bandwidth == 0.0;
}

bool lanes_know(const ControllerParameters& controller) {
  const auto& [sample_rate, kp, ki, kd, delay, anti_windup, encoder, coarse] = controller;
  return delay <= max_delay && lanes_know(encoder) && !has_coarse_phase(controller);
}

bool lanes_know(const CommandParameters& command) {
  const auto& [targets, hold, profile, torque] = command;
  return !targets.empty() && lanes_know(profile.shape) && torque.levels.empty();
}

}  // namespace

bool runs_in_lanes(const TrialParameters& p) {
  const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial, verdict, randomness] =
      p;
  [[maybe_unused]] const auto& [inertia, presliding_damping, sliding_damping] = plant;
  return traits_of(friction.model).runs_in_lanes && !has_errors(encoder.fine_errors) &&
         !has_errors(encoder.coarse_errors) && !has_errors(dac) && lanes_know(amplifier) &&
         lanes_know(controller) && lanes_know(command) && samples_of_move(p, 0) > 0;
}

BatchEngine::BatchEngine(const BatchSettings& settings)
    : work_(std::make_unique<batch::LaneWork>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(std::span<const TrialParameters* const> trials, std::span<TrialOutcome> outcomes,
                      const BatchObservers& observers) {
  work_->run(trials, outcomes, observers);
}

}  // namespace zerocount
