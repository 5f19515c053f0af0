#include "analysis/trials/theory/hunting_prediction.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/trials/theory/lasting_motion.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/reference.hpp"
#include "core/trial/trial.hpp"
#include "core/trial/watched_trial.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t first_judged = 1 << 13;  // samples
/// Length of the first record in which a cycle is looked for, in multiples of the longest time that the
/// controller waits; it has at least first_judged samples.
constexpr double waits_judged = 8.0;
/// Torque that certainly does not move an axis at rest, as a proportion of the breakaway torque.
constexpr double part_of_breakaway = 0.05;

bool has_load_friction(const trial::TrialParameters& p) {
  return motion::has_load(p.plant) && p.load_side.friction.model != friction::LoadFrictionModel::none;
}

/// Whether the loop has a nonlinear part (friction or a gap) that may sustain a limit cycle. False for an
/// open loop and a sine reference.
bool may_hunt(const trial::TrialParameters& p) {
  if (!p.command.torque.levels.empty() || p.command.profile.shape == loop::ReferenceShape::sine) return false;
  const bool has_gap = motion::has_load(p.plant) && p.plant.load.gap > 0.0;
  return friction::has_friction(p.friction.model) || has_load_friction(p) || has_gap;
}

/// The trial reduced to this single move from its start, without noise and vibration, which move the axis by
/// themselves.
trial::TrialParameters trial_of_move(trial::TrialParameters trial, const TargetStep& move) {
  trial.command.targets = {move.to - move.from};
  trial.command.exact_targets.clear();
  trial.verdict = {};
  for (loop::EncoderErrors* of :
       {&trial.encoder.fine_errors, &trial.encoder.coarse_errors, &trial.encoder.other.errors})
    of->noise = 0.0;
  trial.dac.noise = 0.0;
  for (trial::DisturbanceParameters* of : {&trial.disturbance, &trial.load_side.disturbance}) {
    of->vibration.clear();
    of->spectra.clear();
  }
  return trial;
}

/// Number of the first sample at which the motion profile of the reference has ended.
double reference_ends_at(const trial::TrialParameters& p) {
  const loop::ReferenceProfile& profile = p.command.profile;
  const double duration =
      profile.shape == loop::ReferenceShape::record
          ? loop::record_duration(profile.record->time, 1.0 / p.controller.sample_rate)
          : loop::Reference(profile, 0, p.command.targets.front(), loop::fine_resolution(p.encoder))
                .duration();
  return std::ceil(duration * p.controller.sample_rate);
}

double longest_wait(const loop::ControlBlocks& blocks, double sample_rate) {
  const double dwell = std::max(blocks.hold.enter < 0.0 ? 0.0 : blocks.hold.dwell,
                                blocks.standstill.band < 0.0 ? 0.0 : blocks.standstill.dwell);
  const double command = static_cast<double>(blocks.cascade.divider) + blocks.cascade.latency;
  return std::max({dwell * sample_rate, command, static_cast<double>(blocks.derivative_window)});
}

/// The longest time that the controller may take before it changes its torque at a constant error, samples.
double longest_wait(const loop::ControllerParameters& c) {
  const double fine = std::max(longest_wait(c.blocks, c.sample_rate), c.delay);
  if (!loop::has_coarse_phase(c)) return fine;
  return std::max({fine, longest_wait(c.coarse.blocks, c.sample_rate), c.coarse.fine_dwell * c.sample_rate});
}

/// Change of the torque that certainly does not move an axis at rest, N m.
double negligible_torque(const trial::TrialParameters& p) {
  const double motor = friction::friction_at(p.friction, p.initial.position).breakaway;
  const double load = p.load_side.friction.contact.breakaway;
  double breakaway = 0.0;
  if (friction::has_friction(p.friction.model)) breakaway = motor;
  if (has_load_friction(p)) breakaway = breakaway > 0.0 ? std::min(breakaway, load) : load;
  return std::max(part_of_breakaway * breakaway, 0.5 * p.dac.resolution);
}

/// Records the motion of a loop after the end of the reference's motion, and judges whether it has come to
/// rest or hunts (oscillates for good).
class HeldLoop {
 public:
  HeldLoop(const trial::TrialParameters& p, std::int64_t reference_ends)
      : p_(p),
        reference_ends_(reference_ends),
        next_judged_(static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(
            std::clamp(waits_judged * longest_wait(p.controller), static_cast<double>(first_judged),
                       static_cast<double>(max_samples_held)))))),
        has_load_(motion::has_load(p.plant)) {}

  /// Takes the next sample.
  /// @returns whether the prediction is still undecided
  bool add(const trial::LoopSample& sample, HuntingPrediction& prediction) {
    prediction.duration = sample.record.t;
    if (sample.steps > max_steps_held) return false;
    if (sample.record.k < reference_ends_) return true;
    const double count = loop::fine_resolution(p_.encoder);
    if (motor_.empty()) target_ = static_cast<double>(sample.record.reference);
    motor_.push_back(static_cast<float>(sample.record.theta / count - target_));
    if (has_load_) load_.push_back(static_cast<float>(sample.record.load_theta / count - target_));
    torque_.push_back(static_cast<float>(
        std::clamp(sample.wanted, loop::lowest_torque(p_.dac), loop::highest_torque(p_.dac))));
    if (std::ssize(motor_) < next_judged_) return true;
    next_judged_ *= 2;
    judge(prediction);
    return prediction.state == Hunting::undecided && std::ssize(motor_) < max_samples_held;
  }

 private:
  void judge(HuntingPrediction& prediction) const {
    const bool at_load = has_load_ && p_.plant.load.encoder == motion::EncoderPlace::load;
    const std::vector<float>& closes = at_load ? load_ : motor_;
    const std::vector<float>& other = at_load ? motor_ : load_;
    const bool stands_here = stands(closes);
    if (stands_here && (!has_load_ || stands(other))) {
      if (torque_has_settled(torque_, negligible_torque(p_))) prediction.state = Hunting::rests;
      return;
    }
    const std::optional<Cycle> cycle = lasting_cycle(stands_here ? other : closes);
    if (!cycle) return;
    prediction.state = Hunting::hunts;
    prediction.amplitude = cycle->amplitude;
    prediction.period = cycle->period / p_.controller.sample_rate;
    if (has_load_)
      prediction.mass = at_load != stands_here ? motion::EncoderPlace::load : motion::EncoderPlace::motor;
  }

  const trial::TrialParameters& p_;
  /// Index of the first sample after the end of the reference's motion, from which samples are kept.
  std::int64_t reference_ends_;
  /// Number of samples after the end of the reference at which the motion is next judged as rest or hunting.
  std::int64_t next_judged_;
  bool has_load_;
  double target_{0.0};  ///< Position at which the reference rests, counts.
  // Of each sample: positions from the target, counts, and the wanted torque within the range of the
  // converter, N m.
  std::vector<float> motor_{}, load_{}, torque_{};
};

}  // namespace

std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial) {
  if (!may_hunt(trial)) return std::nullopt;
  const TargetStep move = std::ranges::max(target_steps(trial.command), {}, &TargetStep::length);
  trial::TrialParameters p = trial_of_move(trial, move);
  HuntingPrediction prediction{.step = move.length()};
  const double reference_ends = reference_ends_at(p);
  if (!(reference_ends < static_cast<double>(max_steps_held))) return prediction;
  const auto first = static_cast<std::int64_t>(reference_ends);
  p.command.hold = static_cast<double>(first + max_samples_held) / p.controller.sample_rate;
  HeldLoop loop(p, first);
  const std::optional<trial::TrialOutcome> outcome =
      trial::watch_trial(p, [&](const trial::LoopSample& sample) { return loop.add(sample, prediction); });
  if (outcome && outcome->moves.front().outcome == trial::Outcome::nonfinite)
    prediction.state = Hunting::diverges;
  return prediction;
}

document::Description<HuntingPrediction> hunting_description() {
  using document::in_data;
  const auto if_hunts = [](double HuntingPrediction::*number) {
    return [number](const HuntingPrediction& hunting) -> std::optional<double> {
      if (hunting.state != Hunting::hunts) return std::nullopt;
      return hunting.*number;
    };
  };
  const auto mass_text = [](const HuntingPrediction& hunting) -> std::optional<std::string> {
    if (!hunting.mass) return std::nullopt;
    return *hunting.mass == motion::EncoderPlace::load ? "load" : "motor";
  };
  static const std::vector<std::string> words{"rests", "hunts", "diverges", "undecided"};
  return document::Description<HuntingPrediction>()
      .value(document::with_words(document::everywhere("hunting", "hunting of trial 0",
                                                       "what the longest move of trial 0 comes to"),
                                  words),
             [](const HuntingPrediction& hunting) { return words[static_cast<std::size_t>(hunting.state)]; })
      .shown_as([mass_text](const HuntingPrediction& hunting) -> std::string {
        switch (hunting.state) {
          case Hunting::rests:
            return "none, it comes to rest";
          case Hunting::hunts:
            return fmt::format("amplitude {:.4g} counts{}, period {:.4g} s", hunting.amplitude,
                               hunting.mass ? " at the " + mass_text(hunting).value() : "", hunting.period);
          case Hunting::diverges:
            return "the motion grows without bound";
          case Hunting::undecided:
            break;
        }
        if (hunting.duration == 0.0) return std::string("not decided: its simulation takes too long");
        return fmt::format("not decided: neither a cycle nor rest within {:.3g} s", hunting.duration);
      })
      .value(in_data("hunting_step", "length of that move", "count"), &HuntingPrediction::step)
      .value(in_data("hunting_amplitude", "half of the range of its oscillation; null: it does not hunt",
                     "count"),
             if_hunts(&HuntingPrediction::amplitude))
      .value(in_data("hunting_period", "period of the oscillation", "s"),
             if_hunts(&HuntingPrediction::period))
      .value(in_data("hunting_mass",
                     "mass that oscillates, motor or load; null: it does not hunt, or has one mass"),
             mass_text)
      .value(in_data("hunting_duration", "time that was simulated to see it", "s"),
             &HuntingPrediction::duration);
}

}  // namespace zerocount::theory
