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

std::string_view lacking(const loop::ControlBlocks& blocks) {
  [[maybe_unused]] const auto& [structure, cascade, deadband, zone, leak, cutoff, filters, feedforward,
                                observer, error_deadband, hold, standstill] = blocks;
  return lanes_have(structure) ? "" : "the controller's structure";
}

std::string_view lacking(const loop::ControllerParameters& controller) {
  static_assert(
      std::is_same_v<loop::ControlBlockChain, loop::BlockChain<loop::ControlLaw, loop::Filters,
                                                               loop::Feedforward, loop::DisturbanceObserver>>,
      "sample_kernel has these blocks: another one needs its law there, or needs_lane_loop()");
  [[maybe_unused]] const auto& [sample_rate, kp, ki, kd, delay, anti_windup, encoder, coarse, blocks, user,
                                dither, missed, jitter] = controller;
  if (jitter > 0.0) return "late samples (controller.jitter)";
  if (delay > max_delay) return "a delay above 64 samples";
  return lacking(blocks);
}

std::string_view lacking(const trial::DisturbanceParameters& disturbance) {
  [[maybe_unused]] const auto& [torque, ripple, vibration, spectra] = disturbance;
  if (!ripple.empty()) return "disturbance.ripple";
  return vibration.empty() && spectra.empty() ? "" : "disturbance.vibration";
}

std::string_view lacking(const trial::CommandParameters& command) {
  [[maybe_unused]] const auto& [targets, hold, profile, torque] = command;
  if (!torque.levels.empty()) return "torque levels";
  return targets.empty() ? "no moves" : "";
}

}  // namespace

std::string lacking_in_lanes(const trial::TrialParameters& p) {
  [[maybe_unused]] const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial,
                                verdict, randomness, disturbance] = p;
  [[maybe_unused]] const auto& [inertia, presliding_damping, sliding_damping, load] = plant;
  if (!lane_motion(friction.model))
    return "friction.model " + std::string(friction::traits_of(friction.model).word);
  if (motion::has_load(plant)) return "a second mass";
  for (const std::string_view feature :
       {lacking(amplifier), lacking(controller), lacking(command), lacking(disturbance)}) {
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
