#include "core/batch/batch.hpp"

#include <type_traits>

#include "core/batch/lane_work.hpp"
#include "core/friction/law.hpp"
#include "core/loop/control_chain.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/measurement.hpp"

namespace zerocount::batch {
namespace {

constexpr int max_delay = 64;

// Features that lanes support. Each switch lists all enumerators and each structured binding all members, so
// that the compiler demands a decision for one that is added later.

bool lanes_know(friction::FrictionModel model) {
  switch (model) {
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
    case friction::FrictionModel::none:
    case friction::FrictionModel::dahl:
    case friction::FrictionModel::lugre:
      return true;
    case friction::FrictionModel::coulomb:
    case friction::FrictionModel::gms:
      break;
  }
  return false;
}

bool lanes_know(loop::ReferenceShape shape) {
  switch (shape) {
    case loop::ReferenceShape::step:
      return true;
    case loop::ReferenceShape::trapezoidal:
    case loop::ReferenceShape::s_curve:
      break;
  }
  return false;
}

bool lanes_know(loop::EncoderChoice encoder) {
  switch (encoder) {
    case loop::EncoderChoice::fine:
      return true;
    case loop::EncoderChoice::coarse:
      break;
  }
  return false;
}

bool lanes_know(const loop::AmplifierParameters& amplifier) {
  const auto& [bandwidth] = amplifier;
  return bandwidth == 0.0;
}

bool lanes_know(loop::ControlStructure structure) {
  switch (structure) {
    case loop::ControlStructure::pid:
    case loop::ControlStructure::cascade:
      return true;
  }
  return false;
}

/// The feed-forward is of no account: in lanes the reference is a step.
bool lanes_know(const loop::ControlBlocks& blocks) {
  [[maybe_unused]] const auto& [structure, cascade, deadband, zone, leak, cutoff, filters, feedforward,
                                observer] = blocks;
  return filters.size() <= max_lane_filters && lanes_know(structure);
}

bool lanes_know(const loop::ControllerParameters& controller) {
  static_assert(
      std::is_same_v<loop::ControlChain, loop::BlockChain<loop::ControlLaw, loop::Filters, loop::Feedforward,
                                                          loop::DisturbanceObserver>>,
      "sample_kernel has these blocks: another one needs its law there, or a condition here");
  const auto& [sample_rate, kp, ki, kd, delay, anti_windup, encoder, coarse, blocks, user] = controller;
  return delay <= max_delay && lanes_know(encoder) && lanes_know(blocks) && !user.plugin &&
         !loop::has_coarse_phase(controller);
}

bool lanes_know(const trial::CommandParameters& command) {
  const auto& [targets, hold, profile, torque] = command;
  return !targets.empty() && lanes_know(profile.shape) && torque.levels.empty();
}

}  // namespace

bool runs_in_lanes(const trial::TrialParameters& p) {
  const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial, verdict, randomness] =
      p;
  [[maybe_unused]] const auto& [inertia, presliding_damping, sliding_damping, load] = plant;
  return !motion::has_load(plant) && lanes_know(friction.model) && !loop::has_errors(encoder.fine_errors) &&
         !loop::has_errors(encoder.coarse_errors) && !loop::has_errors(dac) && lanes_know(amplifier) &&
         lanes_know(controller) && lanes_know(command) && trial::samples_of_move(p, 0) > 0;
}

BatchEngine::BatchEngine(const BatchSettings& settings) : work_(std::make_unique<LaneWork>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(std::span<const trial::TrialParameters* const> trials,
                      std::span<trial::TrialOutcome> outcomes, const BatchObservers& observers) {
  work_->run(trials, outcomes, observers);
}

}  // namespace zerocount::batch
