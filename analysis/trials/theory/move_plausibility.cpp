#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/theory/plausibility.hpp"
#include "core/friction/law.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/measurement.hpp"
#include "core/loop/reference.hpp"
#include "core/motion/disturbance.hpp"
#include "core/theory/move_times.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double largest_torque(const loop::DacParameters& dac) {
  const auto given_for = [&](double wanted) {
    return std::abs(loop::torque_with_errors(dac, loop::convert(dac, wanted).code));
  };
  return std::max(given_for(loop::lowest_torque(dac)), given_for(loop::highest_torque(dac)));
}

/// The largest torque that can drive a move, and the component that limits it.
struct TorqueBound {
  double torque;         ///< Largest torque, N m.
  std::string text;      ///< Description, such as "the ±4 N m of the converter".
  const char* expected;  ///< Change of the manifest that would allow a larger torque, for the warning.
};

TorqueBound torque_bound(const GoalOfTrial& of) {
  const loop::DacParameters& dac = of.trial.dac;
  loop::DacParameters without_limit = dac;
  without_limit.limit = infinity;
  const double torque = largest_torque(dac);
  const bool by_limit = torque < largest_torque(without_limit);
  return {torque,
          by_limit ? fmt::format("the ±{} of the torque limit (amplifier.limit)", of.torque(dac.limit))
                   : fmt::format("the ±{} of the converter", of.torque(torque)),
          by_limit ? "a larger amplifier.limit" : "a larger range of the converter"};
}

/// Bounds of the friction that a move meets.
struct FrictionBound {
  double sliding{0.0};    ///< Smallest friction torque while the axis slides, N m.
  double breakaway{0.0};  ///< Largest friction torque (breakaway), N m.
  double travel{0.0};     ///< Travel before the axis slides, rad.
};

FrictionBound friction_bound(const trial::TrialParameters& p) {
  if (!friction::has_friction(p.friction.model)) return {};
  constexpr double travels = 5.0;  // a bristle approaches its level by exp(−travel·σ0/level)
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  const double sliding = contact.coulomb_ratio * contact.breakaway;
  // The bristle of dahl yields at the Coulomb level.
  FrictionBound bound{sliding,
                      p.friction.model == friction::FrictionModel::dahl ? sliding : contact.breakaway};
  for (const friction::LinearContact& linear :
       friction::traits_of(p.friction.model).linear_contacts(p.plant, p.friction, contact)) {
    if (!linear.slides && linear.stiffness > 0.0)
      bound.travel = std::max(bound.travel, travels * contact.breakaway / linear.stiffness);
  }
  return bound;
}

double viscous_damping(const trial::TrialParameters& p) {
  const friction::LawTraits& law = friction::traits_of(p.friction.model);
  if (law.has_sliding_damping) return p.plant.sliding_damping;
  return law.has_presliding_damping ? p.plant.presliding_damping : 0.0;
}

/// The largest driving torque and the largest braking torque that a move may have, from which a lower bound
/// of its time follows.
struct BestTorques {
  double driving;  ///< Largest torque that can drive the move, without deduction of friction, N m.
  double braking;  ///< Largest torque that can brake the move, with the help of friction, N m.
};

BestTorques best_torques(const MoveOfTrial& move, const FrictionBound& friction) {
  const trial::TrialParameters& p = move.of.trial;
  double favour = largest_torque(p.dac);
  double along = 0.0;
  for (const trial::DisturbanceParameters* of : {&p.disturbance, &p.load_side.disturbance}) {
    for (const trial::RippleParameters& ripple : of->ripple) favour += std::abs(ripple.amplitude);
    for (const trial::VibrationParameters& one : of->vibration) favour += std::abs(one.amplitude);
    along += move.direction() * of->torque;
  }
  return {favour + along, favour - along + friction.breakaway};
}

/// Inertia that the torque has to move in this move, kg m². A coupling with a gap, or one that is soft for
/// such a short move, lets the motor move without its load.
double moved_inertia(const MoveOfTrial& move) {
  const motion::PlantParameters& plant = move.of.trial.plant;
  if (!(plant.load.inertia > 0.0)) return plant.inertia;
  constexpr double periods = 10.0;  // of the mode of both masses, in which they move as one
  const double mode = std::sqrt(plant.load.stiffness * (1.0 / plant.inertia + 1.0 / plant.load.inertia));
  const bool is_soft = plant.load.gap > 0.0 || periods * 2.0 * std::numbers::pi / mode > move.within();
  return plant.inertia +
         (is_soft && plant.load.encoder == motion::EncoderPlace::motor ? 0.0 : plant.load.inertia);
}

/// A lower bound of the time of the move, s. Over the travel before it slides, the axis is taken to gain the
/// whole work of the torque, without losses to friction.
double shortest_time(const MoveOfTrial& move) {
  const trial::TrialParameters& p = move.of.trial;
  const FrictionBound friction = friction_bound(p);
  const BestTorques torques = best_torques(move, friction);
  const double inertia = moved_inertia(move);
  const double distance = move.distance() - 0.5 * move.of.width();
  DrivenAxis axis{inertia, viscous_damping(p), torques.driving, torques.braking};
  if (!(torques.driving > 0.0) || distance <= friction.travel) return shortest_move(axis, distance);
  const double energy = torques.driving * friction.travel;
  const double sliding = distance - friction.travel;
  axis.driving -= friction.sliding;
  if (!(axis.driving > 0.0)) return sliding * -axis.driving > energy ? infinity : 0.0;
  const double run_up = energy / axis.driving;  // from rest to that energy
  const double run_up_time = std::sqrt(2.0 * run_up * inertia / axis.driving);
  return std::max(shortest_move(axis, sliding + run_up) - run_up_time, 0.0);
}

/// Torque of the constant disturbance and the ripple at the angle `theta` (rad), N m.
double standing_torque(const trial::DisturbanceParameters& of, const trial::TrialParameters& p,
                       double theta) {
  return of.torque + motion::value(trial::ripples_of(of.ripple, p.initial.position), theta);
}

/// Largest torque that the friction of a load holds, N m. The bristle of the law `dahl` yields at the Coulomb
/// level.
double friction_of_load(const friction::LoadFrictionParameters& friction) {
  switch (friction.model) {
    case friction::LoadFrictionModel::none:
      return 0.0;
    case friction::LoadFrictionModel::dahl:
      return friction.contact.coulomb_ratio * friction.contact.breakaway;
    case friction::LoadFrictionModel::coulomb:
    case friction::LoadFrictionModel::lugre:
      break;
  }
  return friction.contact.breakaway;
}

/// The cascade (velocity loop within a position loop) that ends the moves of the trial; null without one.
const loop::CascadeParameters* cascade_of(const trial::TrialParameters& p) {
  const loop::ControlBlocks& blocks = p.controller.blocks;
  const bool has_cascade = blocks.structure == loop::ControlStructure::cascade && !p.controller.user.plugin;
  return has_cascade ? &blocks.cascade : nullptr;
}

/// Torque of the constant disturbances and the ripples on rotor and load together at the angle `theta` (rad),
/// N m.
double standing_torque(const trial::TrialParameters& p, double theta) {
  return standing_torque(p.disturbance, p, theta) + standing_torque(p.load_side.disturbance, p, theta);
}

}  // namespace

double GoalOfTrial::count() const {
  return feeds_back_coarse() ? loop::coarse_resolution(trial.encoder) : loop::fine_resolution(trial.encoder);
}

double GoalOfTrial::width() const {
  return goal.tolerance ? 2.0 * *goal.tolerance : (2.0 * static_cast<double>(goal.band) + 1.0) * count();
}

double GoalOfTrial::samples_within() const {
  double allowed = goal.within.from_start(0.0);
  for (const MoveOfTrial& move : moves_of(*this)) allowed = std::max(allowed, move.allowed());
  const double from = std::floor(allowed * trial.controller.sample_rate);
  return std::max(static_cast<double>(trial::samples_of_move(trial, 0)) - from, 1.0);
}

std::string GoalOfTrial::unit(const char* rotary) const {
  return parameters::unit_on(study.units.axis, rotary);
}

std::string GoalOfTrial::length(double value) const {
  return fmt::format("{:.3g} {}", value, unit("rad"));
}

std::string GoalOfTrial::torque(double value) const {
  return fmt::format("{:.3g} {}", value, unit("N m"));
}

std::string GoalOfTrial::band_text() const {
  return goal.tolerance ? "a tolerance of " + length(*goal.tolerance)
                        : fmt::format("a band of {} count{}", goal.band, goal.band == 1 ? "" : "s");
}

double MoveOfTrial::distance() const {
  return std::abs(to - from);
}

loop::Reference MoveOfTrial::reference() const {
  const double resolution = loop::fine_resolution(of.trial.encoder);
  const auto counts = [&](double angle) {
    return static_cast<std::int64_t>(std::llround(angle / resolution));
  };
  return {of.trial.command.profile, counts(from), counts(to), resolution};
}

double MoveOfTrial::allowed() const {
  return of.goal.within.from_start(reference().travel_time());
}

double MoveOfTrial::within() const {
  return std::min(allowed(), of.trial.command.hold);
}

std::vector<MoveOfTrial> moves_of(const GoalOfTrial& of) {
  constexpr std::size_t max_moves = 20;
  const trial::CommandParameters& command = of.trial.command;
  std::vector<MoveOfTrial> moves;
  if (loop::moves_for_ever(command.profile.shape)) return moves;
  double before = 0.0;
  for (std::size_t i = 0; i < command.targets.size() && moves.size() < max_moves; ++i) {
    const double target = command.exact_targets.empty() ? static_cast<double>(command.targets[i]) *
                                                              loop::fine_resolution(of.trial.encoder)
                                                        : command.exact_targets[i];
    const bool is_asked =
        of.goal.on.empty() || std::ranges::binary_search(of.goal.on, static_cast<std::int64_t>(i));
    if (is_asked && target != before) moves.push_back({of, i, before, target});
    before = target;
  }
  return moves;
}

Doubt band_is_half_a_step(const GoalOfTrial& of) {
  constexpr double half_or_more = 1.0 + 1e-9;
  const double reach =
      of.goal.tolerance ? *of.goal.tolerance : static_cast<double>(of.goal.band) * of.count();
  Doubt worst;
  for (const MoveOfTrial& move : moves_of(of)) {
    const double ratio = half_or_more * 2.0 * reach / move.distance();
    if (!(ratio > worst.ratio)) continue;
    worst = {ratio,
             fmt::format("{} is half of the step of {} by {}, or more: the move is within it on its way; "
                         "expected less than half of a step, or goal.on without this move",
                         of.band_text(), move.name(), of.length(move.distance()))};
  }
  return worst;
}

Doubt hold_ends_before_the_goal(const MoveOfTrial& move) {
  const double hold = move.of.trial.command.hold;
  constexpr double rounding = 1.0 + 1e-9;
  if (!move.of.goal.within.after_profile) return {};
  return {
      move.allowed() / (hold * rounding),
      fmt::format("{} takes {:.4g} s by its profile, and with the {:.4g} s of the goal after it more than "
                  "its hold of {:.4g} s, at whose end it is judged; expected command.hold of at least "
                  "{:.4g} s, or higher limits of the profile",
                  move.name(), move.reference().duration(), move.of.goal.within.time, hold, move.allowed())};
}

Doubt reference_is_on_its_way(const MoveOfTrial& move) {
  const double resolution = loop::fine_resolution(move.of.trial.encoder);
  const loop::Reference reference = move.reference();
  const double within = move.allowed();
  if (!(within < reference.duration())) return {};
  const double remaining =
      std::abs(reference.exact_at(reference.duration()) - reference.exact_at(within)) * resolution;
  return {remaining / (0.5 * move.of.width()),
          fmt::format("{} takes {:.4g} s by its profile, and after the {:.4g} s of the goal the reference is "
                      "still {} from its end, beyond {}; expected `within` of at least {:.4g} s, or higher "
                      "limits of the profile",
                      move.name(), reference.duration(), within, move.of.length(remaining),
                      move.of.band_text(), reference.duration())};
}

Doubt torque_is_too_small_for_the_move(const MoveOfTrial& move) {
  const trial::TrialParameters& p = move.of.trial;
  const bool starts_at_rest = move.number > 0 || p.initial.velocity == 0.0;
  if (trial::random_lines(p.disturbance) + trial::random_lines(p.load_side.disturbance) > 0 ||
      !starts_at_rest)
    return {};
  const double time = shortest_time(move) + p.controller.delay / p.controller.sample_rate;
  const TorqueBound bound = torque_bound(move.of);
  const std::string what =
      fmt::format("{} by {} with an inertia of {:.3g} {} and {}", move.name(),
                  move.of.length(move.distance()), moved_inertia(move), move.of.unit("kg m^2"), bound.text);
  if (std::isinf(time))
    return {infinity, fmt::format("{} never ends: friction and disturbance exceed the torque; expected {}",
                                  what, bound.expected)};
  return {time / move.within(),
          fmt::format("{} takes {:.3g} s at least, longer than the {:.4g} s that it has; expected {}, more "
                      "time, or a shorter move",
                      what, time, move.within(), bound.expected)};
}

Doubt torque_is_too_small_at_the_target(const MoveOfTrial& move) {
  const trial::TrialParameters& p = move.of.trial;
  const TorqueBound bound = torque_bound(move.of);
  const double torque = std::abs(standing_torque(p, move.to));
  const bool sticks = torque <= bound.torque + friction_bound(p).breakaway;
  return {torque / bound.torque,
          fmt::format("at the target of {} the disturbance (torque and ripple) is {}, more than {}: {}; "
                      "expected {}, or less disturbance",
                      move.name(), move.of.torque(torque), bound.text,
                      sticks ? "only friction can hold the axis there" : "nothing holds the axis there",
                      bound.expected)};
}

Doubt other_mass_is_elsewhere_unseen(const MoveOfTrial& move) {
  const GoalOfTrial& of = move.of;
  const trial::TrialParameters& p = of.trial;
  const motion::LoadParameters& load = p.plant.load;
  if (!motion::has_load(p.plant) || !of.goal.of || *of.goal.of == load.encoder || !of.goal.tolerance)
    return {};
  const double friction = friction_of_load(p.load_side.friction);
  const double disturbance = standing_torque(p.load_side.disturbance, p, move.to);
  const double error = motion::value(trial::ripples_of(p.load_side.error, p.initial.position), move.to);
  const double wound = (friction + std::abs(disturbance)) / load.stiffness;
  std::vector<std::string> causes;
  std::vector<std::string> expected;
  const auto add = [&](double length, const std::string& cause, const char* remedy) {
    if (!(length > 0.0)) return;
    causes.push_back(cause);
    expected.emplace_back(remedy);
  };
  add(load.gap, "half of the gap is " + of.length(0.5 * load.gap), "a smaller gap");
  add(std::abs(error), "the kinematic error there is " + of.length(std::abs(error)),
      "a smaller kinematic error");
  add(wound,
      fmt::format("friction ({}) and disturbance ({}) of the load wind up the coupling by up to {}",
                  of.torque(friction), of.torque(std::abs(disturbance)), of.length(wound)),
      "a stiffer coupling");
  const std::string_view other = study::mass_text(*of.goal.of);
  const double apart =
      std::abs(error + disturbance / load.stiffness) + friction / load.stiffness + 0.5 * load.gap;
  return {apart / *of.goal.tolerance,
          fmt::format("at the target of {} the {} may be up to {} away, beyond {}, and the encoder of the {} "
                      "closes the loop: {}; expected {}, or the encoder of the {} in the position loop",
                      move.name(), other, of.length(apart), of.band_text(), study::mass_text(load.encoder),
                      fmt::join(causes, ", "), fmt::join(expected, ", "), other)};
}

Doubt velocity_command_is_too_coarse(const MoveOfTrial& move) {
  const GoalOfTrial& of = move.of;
  const loop::CascadeParameters* const cascade = cascade_of(of.trial);
  if (cascade == nullptr || !(cascade->resolution > 0.0) || !(cascade->kv > 0.0)) return {};
  const double half = 0.5 * of.width();
  const double still = cascade->resolution / (2.0 * cascade->kv);
  return {still / half,
          fmt::format("the velocity command has steps of {:.3g} {}: within {} of the target of {} "
                      "(resolution/(2·kv)) it is rounded to 0, so that the axis may stay there, beyond {}; "
                      "expected controller.cascade.resolution of at most {:.3g} {}, or a larger "
                      "controller.cascade.kv",
                      cascade->resolution, of.unit("rad/s"), of.length(still), move.name(), of.band_text(),
                      2.0 * cascade->kv * half, of.unit("rad/s"))};
}

Doubt velocity_is_too_small_for_the_move(const MoveOfTrial& move) {
  const GoalOfTrial& of = move.of;
  const loop::CascadeParameters* const cascade = cascade_of(of.trial);
  if (cascade == nullptr || !std::isfinite(cascade->limit)) return {};
  const double time = (move.distance() - 0.5 * of.width()) / cascade->limit;
  return {time / move.within(),
          fmt::format("{} by {} takes {:.3g} s at the ±{:.3g} {} of the velocity command "
                      "(controller.cascade.limit), longer than the {:.4g} s that it has; expected a larger "
                      "limit, more time, or a shorter move",
                      move.name(), of.length(move.distance()), time, cascade->limit, of.unit("rad/s"),
                      move.within())};
}

Doubt encoder_misplaces_the_target(const MoveOfTrial& move) {
  const GoalOfTrial& of = move.of;
  const trial::TrialParameters& p = of.trial;
  loop::EncoderErrors systematic = of.errors();
  systematic.noise = 0.0;
  systematic.missed = 0.0;
  if (!of.goal.tolerance || of.feeds_back_coarse() || !loop::has_errors(systematic)) return {};
  const double count = of.count();
  const double phase = p.initial.encoder_phase;
  const auto count_at = [&](double theta) {
    loop::ImperfectEncoder encoder(loop::fine_encoder(p.encoder, phase), systematic, p.initial.position,
                                   1.0 / p.controller.sample_rate, 0, {}, {});
    return encoder.read(0, theta);
  };
  const std::int64_t target = p.command.targets[move.number];
  const double middle = move.to + (0.5 - phase) * count;  // where the position error is 0
  const std::int64_t lowest = count_at(middle - *of.goal.tolerance);
  const std::int64_t highest = count_at(middle + *of.goal.tolerance);
  if (lowest <= target && target <= highest) return {};
  const double error = std::abs(static_cast<double>(count_at(middle) - target)) * count;
  return {
      std::max(error / *of.goal.tolerance, 1.0 + 1e-9),
      fmt::format("the systematic errors of the encoder misplace the target of {} by about {}, beyond {}; "
                  "expected smaller errors, or a wider tolerance",
                  move.name(), of.length(error), of.band_text())};
}

}  // namespace zerocount::theory
