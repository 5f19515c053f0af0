#include "core/batch/lanes/lane_needs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/batch/kernels/batch_state.hpp"
#include "core/batch/lanes/member_count.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/control_chain.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/machine.hpp"

namespace zerocount::batch {
namespace {

// The functions below decide for each member of these structures whether the lanes have its feature. One that
// is added later changes a count, and asks for a decision.
static_assert(member_count<trial::TrialParameters>() == 12, "lacking(): decide on the new part of a trial");
static_assert(member_count<loop::ControllerParameters>() == 14, "lacking(): decide on the new member");
static_assert(member_count<loop::ControlBlocks>() == 13,
              "blocks_remember(), has_blocks(): decide on the new block");
static_assert(member_count<trial::CommandParameters>() == 5, "lacking(): decide on the new member");
static_assert(member_count<trial::DisturbanceParameters>() == 4,
              "lacking(), needs_lane_drive(): decide on the new disturbance");
static_assert(member_count<motion::LoadParameters>() == 6, "lacking(): decide on the new member");
static_assert(member_count<trial::LoadSideParameters>() == 3, "lacking(): decide on the new member");

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

/// Whether a block of the controller can change the torque at zero error and without motion, because it has a
/// memory other than the integral.
bool blocks_remember(const loop::ControlBlocks& blocks) {
  return blocks.observer.bandwidth > 0.0 || !blocks.filters.empty() ||
         std::isfinite(blocks.derivative_cutoff) || std::isfinite(blocks.integrator_leak) ||
         has_queues(blocks);
}

/// The feature of a controller that the lanes lack; empty if they have all.
std::string_view lacking(const loop::ControllerParameters& controller,
                         const loop::EncoderParameters& encoders) {
  static_assert(
      std::is_same_v<loop::ControlBlockChain, loop::BlockChain<loop::ControlLaw, loop::Filters,
                                                               loop::Feedforward, loop::DisturbanceObserver>>,
      "sample_kernel has these blocks: another one needs its law there, or needs_lane_loop()");
  const bool reads_two =
      controller.velocity_by_other || (controller.user.plugin && loop::has_other(encoders));
  return reads_two ? "encoder.load" : "";
}

/// The feature of a disturbance that the vectorised lanes lack, as a noun phrase; empty if they have all of
/// them.
/// @param max_frequency highest frequency of a vibration whose series over a sample is accurate, Hz.
std::string_view lacking(const trial::DisturbanceParameters& disturbance, LaneMotion motion,
                         double max_frequency) {
  const auto& vibration = disturbance.vibration;
  const bool vibrates = !vibration.empty() || !disturbance.spectra.empty();
  switch (motion) {
    case LaneMotion::free:
      if (!disturbance.ripple.empty()) return "disturbance.ripple without friction";
      if (vibrates) return "disturbance.vibration without friction";
      break;
    case LaneMotion::coulomb:
    case LaneMotion::contact:
    case LaneMotion::bristle:
    case LaneMotion::elements:
      break;
  }
  const auto is_fast = [&](double frequency) { return frequency > max_frequency; };
  const bool fast_line =
      std::ranges::any_of(vibration, [&](const auto& line) { return is_fast(line.frequency); });
  const bool fast_spectrum = std::ranges::any_of(
      disturbance.spectra, [&](const auto& spectrum) { return is_fast(spectrum->density.back().frequency); });
  if (fast_line || fast_spectrum) return "a vibration above half the sample rate";
  return disturbance.ripple.size() > max_lane_ripples ? "more than eight ripples" : "";
}

/// The features of the second mass that the trial has and the vectorised lanes lack, as noun phrases.
std::vector<std::string_view> lacking(const motion::LoadParameters& load,
                                      const trial::LoadSideParameters& side) {
  const trial::DisturbanceParameters& disturbance = side.disturbance;
  std::vector<std::string_view> features;
  if (load.inertia == 0.0) return features;
  if (side.friction.model != friction::LoadFrictionModel::none) features.push_back("plant.load.friction");
  if (load.gap > 0.0) features.push_back("plant.load.gap");
  if (!side.error.empty()) features.push_back("plant.load.error");
  if (load.damping_to_ground > 0.0) features.push_back("plant.load.damping_to_ground");
  if (disturbance.torque != 0.0 || !disturbance.ripple.empty() || !disturbance.vibration.empty() ||
      !disturbance.spectra.empty())
    features.push_back("disturbance.load");
  return features;
}

/// The feature of a command that the lanes lack; empty if they have all.
std::string_view lacking(const trial::CommandParameters& command) {
  return command.targets.empty() && command.torque.levels.empty() ? "no moves" : "";
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
  // After a late sample the series must reach up to the next one.
  const double max_frequency = 0.5 / (1.0 / p.controller.sample_rate + p.controller.jitter);
  std::vector<std::string_view> features = lacking(p.plant.load, p.load_side);
  for (const std::string_view feature : {lacking(p.controller, p.encoder), lacking(p.command),
                                         lacking(p.disturbance, motion, max_frequency)}) {
    if (!feature.empty()) features.push_back(feature);
  }
  if (p.friction.gms_elements.size() > max_lane_elements)
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
  const loop::ControlBlocks& blocks = parameters.controller.blocks;
  return blocks.structure != loop::ControlStructure::pid || blocks.deadband.enter >= 0.0 ||
         std::isfinite(blocks.integrator_zone) || std::isfinite(blocks.integrator_leak) ||
         std::isfinite(blocks.derivative_cutoff) || !blocks.filters.empty() ||
         blocks.observer.bandwidth > 0.0 || blocks.error_deadband.band > 0.0 || blocks.hold.enter >= 0.0 ||
         blocks.standstill.band >= 0.0 || never_settles(parameters);
}

bool needs_lane_drive(const trial::TrialParameters& p) {
  const trial::DisturbanceParameters& disturbance = p.disturbance;
  return p.controller.delay > 0.0 || p.controller.jitter > 0.0 || p.amplifier.bandwidth > 0.0 ||
         !disturbance.ripple.empty() || !disturbance.vibration.empty() || !disturbance.spectra.empty();
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
