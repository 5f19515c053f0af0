#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/theory/point_theory.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/friction/law.hpp"
#include "core/loop/reference.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t first_samples = 1 << 13;
constexpr std::int64_t max_samples = 1 << 17;
constexpr std::int64_t longer = 2;
constexpr double min_amplitude = 1.0;  // counts: the encoder does not see less
constexpr double min_periods = 2.0;    // in the last half of the hold
constexpr double alike = 0.05;         // amplitudes of a cycle, measured in whole counts

/// The trial with this move from its start alone, and nothing that moves the axis by itself.
trial::TrialParameters trial_of_move(trial::TrialParameters trial, const TargetStep& move) {
  trial.command.targets = {move.to - move.from};
  trial.command.exact_targets.clear();
  trial.verdict = {};
  trial.encoder.fine_errors.noise = 0.0;
  trial.encoder.coarse_errors.noise = 0.0;
  trial.dac.noise = 0.0;
  for (trial::DisturbanceParameters* of : {&trial.disturbance, &trial.load_side.disturbance}) {
    of->vibration.clear();
    of->spectra.clear();
  }
  return trial;
}

trial::MoveOutcome held_for(trial::TrialParameters& trial, std::int64_t samples,
                            const std::stop_token& stop) {
  trial.command.hold = static_cast<double>(samples) / trial.controller.sample_rate;
  trial.verdict.window = 0.5 * trial.command.hold;
  trial.verdict.dwell = 1.0 / trial.controller.sample_rate;
  return trial::run_trial(trial, {.sample = {}, .jerk = {}, .stop = stop}).moves.front();
}

/// Whether the torque of a standing axis changes, so that it may break away later.
bool has_integral(const loop::ControllerParameters& controller) {
  const bool cascade = controller.blocks.structure == loop::ControlStructure::cascade;
  return (cascade ? controller.blocks.cascade.ki : controller.ki) > 0.0 || controller.user.plugin;
}

bool stays_within_a_count(const trial::MoveOutcome& move) {
  return move.outcome == trial::Outcome::zero_count || move.outcome == trial::Outcome::one_count;
}

bool has_come_to_rest(const trial::MoveOutcome& move, const trial::TrialParameters& trial) {
  if (move.final_settling_time <= 0.5 * trial.command.hold) return true;
  return move.outcome == trial::Outcome::off_target && !has_integral(trial.controller) &&
         move.midway_error == move.final_error;
}

bool is_cycle(const trial::MoveOutcome& move, double amplitude_before, const trial::TrialParameters& trial) {
  return move.oscillation_amplitude > min_amplitude &&
         min_periods * move.oscillation_period <= 0.5 * trial.command.hold &&
         std::abs(move.oscillation_amplitude - amplitude_before) <= alike * move.oscillation_amplitude;
}

}  // namespace

std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial,
                                                 const std::stop_token& stop) {
  if (!trial.command.torque.levels.empty() || !friction::has_friction(trial.friction.model) ||
      loop::moves_for_ever(trial.command.profile.shape))
    return std::nullopt;
  const TargetStep move = std::ranges::max(target_steps(trial.command), {}, &TargetStep::length);
  trial::TrialParameters p = trial_of_move(trial, move);
  HuntingPrediction prediction{.step = move.length()};
  trial::MoveOutcome before;
  // The last half of the samples tells: the reference has long ended there.
  const double profile =
      loop::Reference(p.command.profile, 0, p.command.targets.front(), loop::fine_resolution(p.encoder))
          .duration() *
      p.controller.sample_rate;
  if (!(3.0 * profile <= static_cast<double>(max_samples) * longer)) return prediction;
  const std::int64_t first = std::max(first_samples, static_cast<std::int64_t>(3.0 * profile));
  for (std::int64_t samples = first; samples <= std::max(max_samples, first); samples *= longer) {
    trial::MoveOutcome outcome;
    try {
      outcome = held_for(p, samples, stop);
    } catch (const trial::Interrupted&) {
      return prediction;
    }
    prediction.duration = p.command.hold;
    if (has_come_to_rest(outcome, p) || (stays_within_a_count(outcome) && stays_within_a_count(before))) {
      prediction.state = Hunting::rests;
      return prediction;
    }
    if (outcome.outcome == trial::Outcome::nonfinite) {
      prediction.state = Hunting::diverges;
      return prediction;
    }
    if (is_cycle(outcome, before.oscillation_amplitude, p)) {
      prediction.state = Hunting::hunts;
      prediction.amplitude = outcome.oscillation_amplitude;
      prediction.period = outcome.oscillation_period;
      return prediction;
    }
    before = outcome;
  }
  return prediction;
}

document::Description<HuntingPrediction> hunting_description() {
  using document::in_data;
  using Of = const HuntingPrediction&;
  const auto if_hunts = [](double HuntingPrediction::*number) {
    return [number](Of hunting) -> std::optional<double> {
      if (hunting.state != Hunting::hunts) return std::nullopt;
      return hunting.*number;
    };
  };
  static const std::vector<std::string> words{"rests", "hunts", "diverges", "undecided"};
  return document::Description<HuntingPrediction>()
      .value(document::with_words(document::everywhere("hunting", "hunting of trial 0",
                                                       "what the longest move of trial 0 comes to"),
                                  words),
             [](Of hunting) { return words[static_cast<std::size_t>(hunting.state)]; })
      .shown_as([](Of hunting) -> std::string {
        switch (hunting.state) {
          case Hunting::rests:
            return "none, it comes to rest";
          case Hunting::hunts:
            return fmt::format("amplitude {:.4g} counts, period {:.4g} s", hunting.amplitude, hunting.period);
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
      .value(in_data("hunting_duration", "time that the move was held to see it", "s"),
             &HuntingPrediction::duration);
}

}  // namespace zerocount::theory
