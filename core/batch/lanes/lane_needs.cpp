#include "core/batch/lanes/lane_needs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/batch/kernels/batch_state.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/control_chain.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/machine.hpp"

namespace zerocount::batch {
namespace {

/// Whether the torque changes from sample to sample for ever, because of a dither or the carried-over
/// rounding error of a sigma-delta converter.
bool never_settles(const trial::TrialParameters& p) {
  return p.controller.dither.amplitude != 0.0 || p.dac.sigma_delta;
}

/// Whether the controller needs queues, for a window of counts or a delayed velocity command. The vectorised
/// lanes have none, so that the scalar control law must run.
bool has_queues(const loop::ControlBlocks& blocks) {
  const loop::CascadeParameters& c = blocks.cascade;
  return blocks.derivative_window > 1 || (blocks.structure == loop::ControlStructure::cascade &&
                                          (c.feedforward != 0.0 || c.divider > 1 || c.latency > 0 ||
                                           c.resolution > 0.0 || std::isfinite(c.limit)));
}

/// Whether controller blocks behind the integral (filters, observer) start in the steady state of a torque
/// that the integral holds.
bool starts_with_held_blocks(const trial::TrialParameters& p) {
  const loop::ControlBlocks& blocks = p.controller.blocks;
  return (!blocks.filters.empty() || blocks.observer.bandwidth > 0.0) && trial::held_torque(p) != 0.0;
}

/// Whether the noise of the fine encoder is the only random error of encoders and converter.
bool has_noise_alone(const trial::TrialParameters& p) {
  const loop::EncoderErrors& e = p.encoder.fine_errors;
  return e.noise != 0.0 && e.eccentricity == 0.0 && e.interpolation == 0.0 && e.missed == 0.0 &&
         !loop::has_errors(p.encoder.coarse_errors) && p.dac.noise == 0.0 &&
         loop::coarse_resolution(p.encoder) >= loop::fine_resolution(p.encoder);
}

// Each overload returns the feature that the lanes lack, empty if they have all. Each switch lists all
// enumerators and each structured binding all members, so that the compiler demands a decision for one that
// is added later.

bool blocks_remember(const loop::ControlBlocks& blocks) {
  [[maybe_unused]] const auto& [structure, cascade, deadband, zone, leak, window, cutoff, filters,
                                feedforward, observer, error_deadband, hold, standstill] = blocks;
  // At zero error and without motion, only memory other than the integral can change the torque.
  return observer.bandwidth > 0.0 || !filters.empty() || std::isfinite(cutoff) || std::isfinite(leak) ||
         has_queues(blocks);
}

std::string_view lacking(const loop::ControllerParameters& controller,
                         const loop::EncoderParameters& encoders) {
  static_assert(
      std::is_same_v<loop::ControlBlockChain, loop::BlockChain<loop::ControlLaw, loop::Filters,
                                                               loop::Feedforward, loop::DisturbanceObserver>>,
      "sample_kernel has these blocks: another one needs its law there, or needs_lane_loop()");
  [[maybe_unused]] const auto& [sample_rate, kp, ki, kd, delay, anti_windup, encoder, coarse, blocks,
                                velocity_by_other, user, dither, missed, jitter] = controller;
  return velocity_by_other || (user.plugin && loop::has_other(encoders)) ? "encoder.load" : "";
}

/// The feature of a disturbance that the vectorised lanes lack, as a noun phrase; empty if they have all of
/// them.
/// @param max_frequency highest frequency of a vibration whose series over a sample is accurate, Hz.
std::string_view lacking(const trial::DisturbanceParameters& disturbance, LaneMotion motion,
                         double max_frequency) {
  [[maybe_unused]] const auto& [torque, ripple, vibration, spectra] = disturbance;
  const bool vibrates = !vibration.empty() || !spectra.empty();
  switch (motion) {
    case LaneMotion::free:
      if (!ripple.empty()) return "disturbance.ripple without friction";
      if (vibrates) return "disturbance.vibration without friction";
      break;
    case LaneMotion::coulomb:
    case LaneMotion::contact:
    case LaneMotion::bristle:
    case LaneMotion::elements:
      break;
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

/// The features of the second mass that the trial has and the vectorised lanes lack, as noun phrases.
std::vector<std::string_view> lacking(const motion::LoadParameters& load,
                                      const trial::LoadSideParameters& side) {
  [[maybe_unused]] const auto& [inertia, stiffness, damping, encoder, gap, damping_to_ground] = load;
  [[maybe_unused]] const auto& [error, disturbance, friction] = side;
  std::vector<std::string_view> features;
  if (inertia == 0.0) return features;
  if (friction.model != friction::LoadFrictionModel::none) features.push_back("plant.load.friction");
  if (gap > 0.0) features.push_back("plant.load.gap");
  if (!error.empty()) features.push_back("plant.load.error");
  if (damping_to_ground > 0.0) features.push_back("plant.load.damping_to_ground");
  if (disturbance.torque != 0.0 || !disturbance.ripple.empty() || !disturbance.vibration.empty() ||
      !disturbance.spectra.empty())
    features.push_back("disturbance.load");
  return features;
}

std::string_view lacking(const trial::CommandParameters& command) {
  [[maybe_unused]] const auto& [targets, hold, profile, torque, exact_targets] = command;
  return targets.empty() && torque.levels.empty() ? "no moves" : "";
}

/// Whether each move of the trial has at least one sample. A move to a torque level without a hold may have
/// none.
bool has_samples(const trial::TrialParameters& p) {
  const std::size_t moves = p.command.torque.levels.empty() ? 1 : p.command.torque.levels.size();
  for (std::size_t m = 0; m < moves; ++m)
    if (trial::samples_of_move(p, m) <= 0) return false;
  return true;
}

/// The features of the trial that the vectorised lanes lack, as noun phrases; `motion` is the kind of kernel
/// of its friction model.
std::vector<std::string_view> lacking(const trial::TrialParameters& p, LaneMotion motion) {
  [[maybe_unused]] const auto& [plant, friction, encoder, dac, amplifier, controller, command, initial,
                                verdict, randomness, disturbance, load_side] = p;
  // After a late sample the series must reach up to the next one.
  const double max_frequency = 0.5 / (1.0 / controller.sample_rate + controller.jitter);
  std::vector<std::string_view> features = lacking(plant.load, load_side);
  for (const std::string_view feature :
       {lacking(controller, encoder), lacking(command), lacking(disturbance, motion, max_frequency)}) {
    if (!feature.empty()) features.push_back(feature);
  }
  if (friction.gms_elements.size() > max_lane_elements)
    features.push_back("more than sixteen elements of gms");
  if (!has_samples(p)) features.push_back("moves without a sample");
  return features;
}

}  // namespace

std::optional<LaneMotion> lane_motion(friction::FrictionModel model) {
  switch (model) {
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
      return LaneMotion::contact;
    case friction::FrictionModel::none:
      return LaneMotion::free;
    case friction::FrictionModel::dahl:
    case friction::FrictionModel::lugre:
      return LaneMotion::bristle;
    case friction::FrictionModel::coulomb:
      return LaneMotion::coulomb;
    case friction::FrictionModel::gms:
      return LaneMotion::elements;
  }
  return std::nullopt;
}

bool is_certain(const trial::TrialParameters& p) {
  return !loop::has_errors(p.encoder.fine_errors) && !loop::has_errors(p.encoder.coarse_errors) &&
         p.dac.noise == 0.0;
}

bool remembers(const trial::TrialParameters& p) {
  return blocks_remember(p.controller.blocks) || never_settles(p);
}

bool has_blocks(const trial::TrialParameters& parameters) {
  // The feed-forward acts on profiles alone, and a window of counts by has_queues(): both need a LaneLoop.
  [[maybe_unused]] const auto& [structure, cascade, deadband, zone, leak, window, cutoff, filters,
                                feedforward, observer, error_deadband, hold, standstill] =
      parameters.controller.blocks;
  return structure != loop::ControlStructure::pid || deadband.enter >= 0.0 || std::isfinite(zone) ||
         std::isfinite(leak) || std::isfinite(cutoff) || !filters.empty() || observer.bandwidth > 0.0 ||
         error_deadband.band > 0.0 || hold.enter >= 0.0 || standstill.band >= 0.0 ||
         never_settles(parameters);
}

bool needs_lane_drive(const trial::TrialParameters& p) {
  [[maybe_unused]] const auto& [torque, ripple, vibration, spectra] = p.disturbance;
  return p.controller.delay > 0.0 || p.controller.jitter > 0.0 || p.amplifier.bandwidth > 0.0 ||
         !ripple.empty() || !vibration.empty() || !spectra.empty();
}

bool needs_lane_noise(const trial::TrialParameters& p) {
  return has_noise_alone(p) && !needs_lane_loop(p);
}

bool needs_drive_kernel(const trial::TrialParameters& p) {
  const double delay = p.controller.delay;
  const double jitter = p.controller.jitter;
  const motion::TorqueCourse lag{1.0, 0.0, loop::lag_rate(p.amplifier)};
  const double longest = 1.0 / p.controller.sample_rate + jitter;
  const bool is_slow = lag.rate == 0.0 || motion::time_to_settle(lag) >= longest;
  return needs_lane_drive(p) && delay == std::floor(delay) && delay <= max_lane_delay && is_slow &&
         (jitter == 0.0 || delay == 0.0);
}

bool needs_lane_loop(const trial::TrialParameters& p) {
  return !(is_certain(p) || has_noise_alone(p)) || p.verdict.motion || p.verdict.other_mass ||
         p.controller.missed > 0.0 || loop::has_errors(p.dac) || loop::has_coarse_phase(p.controller) ||
         p.controller.encoder != loop::EncoderChoice::fine ||
         p.command.profile.shape != loop::ReferenceShape::step || p.controller.user.plugin ||
         !p.command.torque.levels.empty() || p.controller.blocks.filters.size() > max_lane_filters ||
         has_queues(p.controller.blocks) || std::isfinite(p.dac.limit) || starts_with_held_blocks(p);
}

bool is_steady_at_zero(const trial::TrialParameters& p) {
  const loop::ControllerParameters& c = p.controller;
  const auto has_dwell = [](const loop::ControlBlocks& b) {
    return b.hold.enter >= 0.0 || b.standstill.band >= 0.0;
  };
  const bool all_fine = c.encoder == loop::EncoderChoice::fine && c.coarse.encoder == c.encoder;
  return is_certain(p) && !p.verdict.motion && !p.verdict.position_error && !c.user.plugin && all_fine &&
         !remembers(p) && !has_dwell(c.blocks) &&
         (!loop::has_coarse_phase(c) || !blocks_remember(c.coarse.blocks));
}

std::vector<std::string> lacking_in_lanes(const trial::TrialParameters& parameters) {
  const friction::FrictionModel model = parameters.friction.model;
  const std::optional<LaneMotion> motion = lane_motion(model);
  if (!motion) return {"friction.model " + std::string(friction::traits_of(model).word)};
  const std::vector<std::string_view> features = lacking(parameters, *motion);
  return {features.begin(), features.end()};
}

bool runs_in_lanes(const trial::TrialParameters& parameters) {
  const std::optional<LaneMotion> motion = lane_motion(parameters.friction.model);
  return motion && lacking(parameters, *motion).empty();
}

}  // namespace zerocount::batch
