#include "core/batch/batch.hpp"

#include <cmath>
#include <type_traits>

#include "core/batch/lane_scheduler.hpp"
#include "core/batch/lane_trial.hpp"
#include "core/friction/law.hpp"
#include "core/loop/control_chain.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/measurement.hpp"

namespace zerocount::batch {
namespace {

constexpr double max_delay = 64.0;

// Each overload returns the feature that the lanes lack, empty if they have all. Each switch lists all
// enumerators and each structured binding all members, so that the compiler demands a decision for one that
// is added later.

std::string_view lacking(loop::ReferenceShape shape) {
  switch (shape) {
    case loop::ReferenceShape::step:
      return "";
    case loop::ReferenceShape::trapezoidal:
    case loop::ReferenceShape::s_curve:
      break;
  }
  return "a reference with a profile";
}

std::string_view lacking(loop::EncoderChoice encoder) {
  switch (encoder) {
    case loop::EncoderChoice::fine:
      return "";
    case loop::EncoderChoice::coarse:
      break;
  }
  return "control by the coarse encoder";
}

std::string_view lacking(const loop::AmplifierParameters& amplifier) {
  const auto& [bandwidth] = amplifier;
  return bandwidth == 0.0 ? "" : "an amplifier";
}

bool lanes_have(loop::ControlStructure structure) {
  switch (structure) {
    case loop::ControlStructure::pid:
    case loop::ControlStructure::cascade:
      return true;
  }
  return false;
}

/// Ignores the feed-forward, which is 0 for a step, the only reference of the lanes.
std::string_view lacking(const loop::ControlBlocks& blocks) {
  [[maybe_unused]] const auto& [structure, cascade, deadband, zone, leak, cutoff, filters, feedforward,
                                observer] = blocks;
  if (filters.size() > max_lane_filters) return "more than four filters";
  return lanes_have(structure) ? "" : "the controller's structure";
}

std::string_view lacking(const loop::ControllerParameters& controller) {
  static_assert(
      std::is_same_v<loop::ControlChain, loop::BlockChain<loop::ControlLaw, loop::Filters, loop::Feedforward,
                                                          loop::DisturbanceObserver>>,
      "sample_kernel has these blocks: another one needs its law there, or a condition here");
  const auto& [sample_rate, kp, ki, kd, delay, anti_windup, encoder, coarse, blocks, user] = controller;
  if (user.plugin) return "a controller from a plugin";
  if (delay > max_delay) return "a delay above 64 samples";
  if (loop::has_coarse_phase(controller)) return "two phases of control";
  const std::string_view by_encoder = lacking(encoder);
  return by_encoder.empty() ? lacking(blocks) : by_encoder;
}

std::string_view lacking(const trial::CommandParameters& command) {
  const auto& [targets, hold, profile, torque] = command;
  if (!torque.levels.empty()) return "torque levels";
  return targets.empty() ? "no moves" : lacking(profile.shape);
}

}  // namespace

std::string lacking_in_lanes(const trial::TrialParameters& p) {
  const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial, verdict, randomness] =
      p;
  [[maybe_unused]] const auto& [inertia, presliding_damping, sliding_damping, load] = plant;
  if (!lane_motion(friction.model))
    return "friction.model " + std::string(friction::traits_of(friction.model).word);
  if (motion::has_load(plant)) return "a second mass";
  if (loop::has_errors(encoder.fine_errors) || loop::has_errors(encoder.coarse_errors))
    return "errors of an encoder";
  if (loop::has_errors(dac)) return "errors of the DAC";
  for (const std::string_view feature : {lacking(amplifier), lacking(controller), lacking(command)}) {
    if (!feature.empty()) return std::string(feature);
  }
  if (controller.delay != std::floor(controller.delay) && lane_motion(friction.model) == LaneMotion::free)
    return "a delay of a fraction of a sample without friction";
  return trial::samples_of_move(p, 0) > 0 ? "" : "moves without a sample";
}

bool runs_in_lanes(const trial::TrialParameters& parameters) {
  return lacking_in_lanes(parameters).empty();
}

BatchEngine::BatchEngine(const BatchSettings& settings)
    : scheduler_(std::make_unique<LaneScheduler>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(std::span<const trial::TrialParameters* const> trials,
                      std::span<trial::TrialOutcome> outcomes, const BatchObservers& observers) {
  scheduler_->run(trials, outcomes, observers);
}

}  // namespace zerocount::batch
