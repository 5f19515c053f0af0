#include "core/batch/batch.hpp"

#include <algorithm>
#include <optional>
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

// Each overload returns the feature that the lanes lack, empty if they have all. Each switch lists all
// enumerators and each structured binding all members, so that the compiler demands a decision for one that
// is added later.

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
  return lacking(blocks);
}

/// @param max_frequency of a vibration whose series over a sample is accurate, Hz.
std::string_view lacking(const trial::DisturbanceParameters& disturbance, LaneMotion motion,
                         double max_frequency) {
  [[maybe_unused]] const auto& [torque, ripple, vibration, spectra] = disturbance;
  if (motion == LaneMotion::free) {
    if (!ripple.empty()) return "disturbance.ripple without friction";
    return vibration.empty() && spectra.empty() ? "" : "disturbance.vibration without friction";
  }
  const auto is_fast = [&](double frequency) { return frequency > max_frequency; };
  const bool fast_line = std::any_of(vibration.begin(), vibration.end(),
                                     [&](const auto& line) { return is_fast(line.frequency); });
  const bool fast_spectrum = std::any_of(spectra.begin(), spectra.end(), [&](const auto& spectrum) {
    return is_fast(spectrum->density.back().frequency);
  });
  if (fast_line || fast_spectrum) return "a vibration above half the sample rate";
  return ripple.size() > max_lane_ripples ? "more than eight ripples" : "";
}

std::string_view lacking(const trial::CommandParameters& command) {
  [[maybe_unused]] const auto& [targets, hold, profile, torque] = command;
  if (!torque.levels.empty()) return "torque levels";
  return targets.empty() ? "no moves" : "";
}

/// The first feature of the trial that the lanes of its friction model lack; empty if they have all.
std::string_view lacking(const trial::TrialParameters& p, LaneMotion motion) {
  [[maybe_unused]] const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial,
                                verdict, randomness, disturbance] = p;
  [[maybe_unused]] const auto& [inertia, presliding_damping, sliding_damping, load] = plant;
  if (motion::has_load(plant)) return "a second mass";
  // After a late sample the series must reach up to the next one.
  const double max_frequency = 0.5 / (1.0 / controller.sample_rate + controller.jitter);
  for (const std::string_view feature :
       {lacking(controller), lacking(command), lacking(disturbance, motion, max_frequency)}) {
    if (!feature.empty()) return feature;
  }
  return trial::samples_of_move(p, 0) > 0 ? "" : "moves without a sample";
}

}  // namespace

std::string lacking_in_lanes(const trial::TrialParameters& parameters) {
  const friction::FrictionModel model = parameters.friction.model;
  const std::optional<LaneMotion> motion = lane_motion(model);
  if (!motion) return "friction.model " + std::string(friction::traits_of(model).word);
  return std::string(lacking(parameters, *motion));
}

bool runs_in_lanes(const trial::TrialParameters& parameters) {
  const std::optional<LaneMotion> motion = lane_motion(parameters.friction.model);
  return motion && lacking(parameters, *motion).empty();
}

BatchEngine::BatchEngine(const BatchSettings& settings)
    : scheduler_(std::make_unique<LaneScheduler>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
                      const BatchObservers& observers) {
  scheduler_->run(source, outcomes, observers);
}

void BatchEngine::run(std::span<const trial::TrialParameters* const> trials,
                      std::span<trial::TrialOutcome> outcomes, const BatchObservers& observers) {
  const auto source = [trials](std::size_t trial, std::size_t) -> const trial::TrialParameters& {
    return *trials[trial];
  };
  run(source, outcomes.first(trials.size()), observers);
}

}  // namespace zerocount::batch
