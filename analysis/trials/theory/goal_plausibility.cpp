#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/theory/plausibility.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/friction/law.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/stability.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t max_whole_trials = 3;     // examined by the tests of whole trials
constexpr std::int64_t max_draws_of_moves = 50;  // by those of moves

/// Two-sided tail probability of the normal distribution: P(|X| > bound) for X with mean 0 and this standard
/// deviation.
double outside(double bound, double deviation) {
  return std::erfc(bound / deviation / std::numbers::sqrt2);
}

constexpr double negligible = 1e-6;  // of the samples or moves; smaller proportions are written as this

/// Text of an upper bound of a proportion, in percent.
std::string percent_at_most(double proportion) {
  return fmt::format("{:.3g} %", 100.0 * std::max(proportion, negligible));
}

std::string percent_text(double proportion) {
  return (proportion < negligible ? "less than " : "") + percent_at_most(proportion);
}

/// Doubt about a tolerance below the error that zero counts allow: half a count; a whole count if targets in
/// SI units are rounded to counts, because such a target is not in the middle of its count.
Doubt zero_counts_are_wider(const GoalOfTrial& of) {
  if (!of.goal.tolerance) return {};
  const trial::CommandParameters& command = of.trial.command;
  const double fine = loop::fine_resolution(of.trial.encoder);
  bool rounds = false;
  for (const MoveOfTrial& move : moves_of(of)) {
    constexpr double rounding = 1e-6;  // counts
    rounds =
        rounds || std::abs(move.to / fine - static_cast<double>(command.targets[move.number])) > rounding;
  }
  const double tolerance = *of.goal.tolerance / of.count();
  const double held = rounds ? 1.0 : 0.5;  // counts
  // Two errors, each evenly distributed over a count. Without rounding the axis may stand in the middle.
  const double within = rounds && tolerance >= 0.5 ? tolerance * (2.0 - tolerance) : 0.0;
  if (tolerance < held && of.goal.moves <= within) return {};
  return {held / tolerance,
          fmt::format("{} is less than {}, {}: an axis at zero counts stands anywhere within its count, and "
                      "the loop does not see where{}; expected at least {}, which zero counts hold, or a "
                      "count of at most {}",
                      of.band_text(), rounds ? "a count" : "half a count", of.length(held * of.count()),
                      rounds ? ", and the targets are rounded to counts" : "", of.length(held * of.count()),
                      of.length(*of.goal.tolerance / held))};
}

/// Effect of encoder noise on the error or the position of the axis, as two numbers from which rate_within()
/// computes how often it leaves a bound.
struct NoisyLoop {
  /// Standard deviation of the error or position that must stay within the bound, counts.
  double deviation;
  /// Number of independent values in the samples that must stay within the bound.
  double independent;
};

/// Proportion of moves in which the noise stays within ±`bound` (counts) at all samples.
double rate_within(double bound, const NoisyLoop& loop) {
  return std::exp(loop.independent * std::log1p(-outside(bound, loop.deviation)));
}

/// The linear loop with which the largest proportion of moves stays within ±`bound` (counts) at all samples.
/// The bound applies to the error that the loop reads, or to the axis, as `at` says. If the axis has
/// friction, loops with a sticking contact are considered; without friction the loops of the free axis.
/// Nothing without a stable loop.
std::optional<NoisyLoop> quietest_loop(const GoalOfTrial& of, NoiseAt at, double bound) {
  const loop::EncoderErrors& errors = of.errors();
  std::optional<NoisyLoop> quietest;
  const auto consider = [&](const NoisyLoop& loop) {
    if (!quietest || rate_within(bound, loop) > rate_within(bound, *quietest)) quietest = loop;
  };
  const bool has_friction = friction::has_friction(of.trial.friction.model);
  if (has_friction && at == NoiseAt::error) {
    // Noise with a bandwidth has about two independent values in each period of it.
    const double of_noise = std::min(1.0, 2.0 * errors.noise_bandwidth / of.trial.controller.sample_rate);
    consider({errors.noise, std::max(of_noise * of.samples_within(), 1.0)});
  }
  // A loop amplifies white noise (Bode's integral): an axis that stands still reads least of it.
  if (quietest && std::isinf(errors.noise_bandwidth)) return quietest;
  for (const TrialLoop& loop : trial_loops(of.trial)) {
    if ((has_friction && loop.slides) ||
        stability_of(loop.loop, of.trial.command.hold) != LoopStability::stable)
      continue;
    const NoiseResponse response = response_to_noise(loop.loop, at, errors.noise_bandwidth);
    consider(
        {errors.noise * response.gain, std::max(of.samples_within() / response.correlated_samples, 1.0)});
  }
  return quietest;
}

Doubt noise_leaves_the_band(const GoalOfTrial& of) {
  const loop::EncoderErrors& errors = of.errors();
  if (of.goal.tolerance || !(errors.noise > 0.0)) return {};
  const double bound = static_cast<double>(of.goal.band) + 0.5;
  const std::optional<NoisyLoop> loop = quietest_loop(of, NoiseAt::error, bound);
  if (!loop) return {};
  const double rate = rate_within(bound, *loop);
  const bool stands = friction::has_friction(of.trial.friction.model);
  return {of.goal.moves / rate,
          fmt::format("encoder noise of {:.3g} counts rms leaves {} in {} of the samples of an axis that {}, "
                      "and {:.0f} samples of a move must be within it: at most {} of the moves can meet the "
                      "goal, which asks for {}; expected less noise, a wider band, or a tolerance",
                      errors.noise, of.band_text(), percent_text(outside(bound, loop->deviation)),
                      stands ? "stands still" : "the loop holds", of.samples_within(), percent_at_most(rate),
                      percent_text(of.goal.moves))};
}

Doubt noise_moves_the_axis(const GoalOfTrial& of) {
  const loop::EncoderErrors& errors = of.errors();
  if (!of.goal.tolerance || !(errors.noise > 0.0)) return {};
  const double bound = *of.goal.tolerance / of.count();
  const std::optional<NoisyLoop> loop = quietest_loop(of, NoiseAt::axis, bound);
  if (!loop) return {};
  const double rate = rate_within(bound, *loop);
  return {of.goal.moves / rate,
          fmt::format("encoder noise of {:.3g} counts rms moves the axis by {} rms by the linear loop: it is "
                      "within {} in {} of the samples, and {:.0f} samples of a move must be: at most {} of "
                      "the moves can meet the goal, which asks for {}; expected less noise, lower gains, or "
                      "a wider tolerance",
                      errors.noise, of.length(loop->deviation * of.count()), of.band_text(),
                      percent_text(1.0 - outside(bound, loop->deviation)), of.samples_within(),
                      percent_at_most(rate), percent_text(of.goal.moves))};
}

Doubt code_leaves_the_band(const GoalOfTrial& of) {
  const trial::TrialParameters& p = of.trial;
  if (!friction::has_spring(p.friction.model) || p.dac.sigma_delta) return {};
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  const double stiffness = contact.k1 + contact.k2;
  const double travel = p.dac.resolution / stiffness;
  return {
      travel / of.width(),
      fmt::format("one code of the DAC, {}, moves the axis by {} = {:.3g} counts even at k1 + k2, right "
                  "after a reversal, more than the {} from one end of {} to the other; expected a code of at "
                  "most {}, dac.sigma_delta, or a wider one",
                  of.torque(p.dac.resolution), of.length(travel), travel / of.count(), of.length(of.width()),
                  of.band_text(), of.torque(stiffness * of.width()))};
}

/// Doubt about a goal of the motor on an axis with a load: the encoder of the motor closes the loop, so
/// nothing tells the loop where the load is.
Doubt load_hangs_behind(const GoalOfTrial& of) {
  const motion::PlantParameters& plant = of.trial.plant;
  if (of.goal.of != motion::EncoderPlace::motor || !motion::has_load(plant) ||
      plant.load.encoder != motion::EncoderPlace::motor)
    return {};
  return {2.0, fmt::format(
                   "the goal is of the motor, whose encoder closes the loop, and the load behind it may be "
                   "elsewhere; expected {}of: load, or a load that does not matter",
                   of.goal.tolerance ? "" : "a tolerance with ")};
}

/// A plausibility test of goals, which is applied either to whole trials or to each move of a trial.
struct GoalTest {
  Doubt (*of_trial)(const GoalOfTrial&){nullptr};
  Doubt (*of_move)(const MoveOfTrial&){nullptr};
  bool needs_goal{true};
  bool holds_for_any_controller{false};
  /// True if a failure is an obstacle to meeting the goal, and not only a doubt about the meaning of the
  /// goal.
  bool is_obstacle{true};
  /// True if a failure counts for a move only if a simulation shows that the move misses the band or
  /// tolerance.
  bool needs_trial{false};
};
constexpr std::array<GoalTest, 14> goal_tests{
    {{load_hangs_behind, nullptr, true, false, false},
     {zero_counts_are_wider},
     {noise_leaves_the_band},
     {noise_moves_the_axis},
     {code_leaves_the_band},
     {band_is_half_a_step},
     {nullptr, hold_ends_before_the_goal},
     {nullptr, reference_is_on_its_way, true, true},
     {nullptr, torque_is_too_small_for_the_move, false, true},
     {nullptr, torque_is_too_small_at_the_target, false},
     {nullptr, other_mass_is_elsewhere_unseen, true, false, true, true},
     {nullptr, velocity_command_is_too_coarse, true, false, true, true},
     {nullptr, velocity_is_too_small_for_the_move, true, false, true, true},
     {nullptr, encoder_misplaces_the_target, true, true}}};

constexpr std::int64_t max_simulated_samples = std::int64_t{1} << 20;  // of all trials
/// Smallest number of samples that may be simulated for a design point in one setting (condition at an age),
/// however many points there are.
constexpr std::int64_t min_simulated_samples_of_cell = std::int64_t{1} << 14;

/// A trial that the plausibility tests examine, with its simulated outcome if a test has needed it.
struct ExaminedTrial {
  trial::TrialParameters parameters;
  std::optional<trial::TrialOutcome> outcome{};
};

/// The examined trials of a design point in one setting (condition at an age).
struct ExaminedTrials {
  std::span<ExaminedTrial> trials;
  std::int64_t& samples_left;  ///< Number of samples that may still be simulated for this point and setting.
};

/// Whether the simulated move settles in the goal's band or tolerance within the allowed time.
/// @param number index of the move in the trial
bool settles(const study::Study& study, const study::Goal& goal, const trial::TrialOutcome& outcome,
             std::size_t number) {
  if (number >= outcome.moves.size()) return false;  // the trial was stopped
  const trial::MoveOutcome& move = outcome.moves[number];
  const auto time_in = [](const auto& values, auto value, const auto& time) {
    const auto slot = std::ranges::find(values, value) - values.begin();
    return time(static_cast<std::size_t>(slot));
  };
  const double time = goal.tolerance
                          ? time_in(study.features.tolerances.values(), *goal.tolerance,
                                    [&](std::size_t slot) {
                                      return (goal.of_other_mass ? move.other_tolerance_settling_times
                                                                 : move.tolerance_settling_times)[slot];
                                    })
                          : time_in(study.features.bands.values(), goal.band,
                                    [&](std::size_t slot) { return move.bands[slot].settling_time; });
  constexpr double rounding = 1.0 + 1e-9;                              // as measures::is_in_time()
  return time <= goal.within.from_start(move.travel_time) * rounding;  // not NaN
}

/// Simulates the trial, unless it has been simulated, and reduces `samples_left` by its samples.
/// @returns false if it has more samples than are left, so that it is not simulated
bool simulate(ExaminedTrial& trial, std::int64_t& samples_left) {
  if (trial.outcome) return true;
  const std::int64_t samples = trial::samples_of_trial(trial.parameters);
  if (samples > samples_left) return false;
  samples_left -= samples;
  trial.outcome = trial::run_trial(trial.parameters);
  return true;
}

/// The doubt of a test of whole trials, if the goal is out of reach in each examined trial; otherwise
/// nothing.
std::optional<Doubt> doubt_of_trials(const GoalTest& test, const study::Study& study, const study::Goal& goal,
                                     const ExaminedTrials& of) {
  std::optional<Doubt> smallest;
  for (const ExaminedTrial& trial :
       of.trials.first(std::min<std::size_t>(of.trials.size(), max_whole_trials))) {
    Doubt doubt = test.of_trial({study, goal, trial.parameters});
    if (!(doubt.ratio > 1.0)) return {};
    if (!smallest || doubt.ratio < smallest->ratio) smallest = std::move(doubt);
  }
  return smallest;
}

/// The doubt of a test of moves, if the goal is out of reach in more moves than it permits, by more than
/// chance; otherwise nothing.
std::optional<Doubt> doubt_of_moves(const GoalTest& test, const study::Study& study, const study::Goal& goal,
                                    const ExaminedTrials& examined) {
  Doubt worst;
  double moves = 0.0;
  double failing = 0.0;
  double moves_of_trial = 1.0;
  for (ExaminedTrial& trial : examined.trials) {
    const GoalOfTrial of{study, goal, trial.parameters};
    const std::vector<MoveOfTrial> all = moves_of(of);
    std::vector<Doubt> doubts;
    for (const MoveOfTrial& move : all) doubts.push_back(test.of_move(move));
    const bool is_doubted = std::ranges::any_of(doubts, [](const Doubt& doubt) { return doubt.ratio > 1.0; });
    if (test.needs_trial && is_doubted && !simulate(trial, examined.samples_left)) break;
    moves_of_trial = std::max(moves_of_trial, static_cast<double>(all.size()));
    moves += static_cast<double>(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      Doubt& doubt = doubts[i];
      if (!(doubt.ratio > 1.0)) continue;
      if (test.needs_trial && trial.outcome && settles(study, goal, *trial.outcome, all[i].number)) continue;
      ++failing;
      if (doubt.ratio > worst.ratio) worst = std::move(doubt);
    }
  }
  if (failing == 0.0) return {};
  const double permitted =
      study.goals.empty() ? 0.0 : moves * (1.0 - goal.moves * goal.machines.value_or(1.0));
  constexpr double chance = 1.645;  // standard deviations: 5 % of them are larger
  // All moves of a trial may fail together: trials count, each of so many moves.
  const double by_chance =
      permitted > 0.0 ? chance * std::sqrt(permitted * moves_of_trial) + moves_of_trial : 0.0;
  if (failing < moves && failing <= permitted + by_chance) return {};
  if (failing < moves) worst.text += fmt::format(" (so in {:.0f} of {:.0f} moves examined)", failing, moves);
  return worst;
}

/// [test] Warning of the test at the design point where it fails worst; empty if the test does not fail.
/// @param is_wanted selects the tests
std::vector<std::string> worst_lines(const study::Study& study, bool (*is_wanted)(const GoalTest&)) {
  if (study.open_loop) return {};
  std::array<Doubt, goal_tests.size()> worst;
  const study::Goal none{.within = std::numeric_limits<double>::infinity()};
  const std::span<const study::Goal> goals =
      study.goals.empty() ? std::span(&none, 1) : std::span<const study::Goal>(study.goals);
  const study::TrialIndices indices = study::trial_indices(study);
  const std::vector<std::int64_t> points = statistics::spread_over(
      study::point_count(study),
      std::max<std::int64_t>(max_trials_doubted / (indices.settings.total() * std::ssize(goals)), 1));
  const std::int64_t draws =
      std::min(study::draw_count(study),
               std::clamp<std::int64_t>(max_trials_doubted / (indices.settings.total() * std::ssize(points)),
                                        max_whole_trials, max_draws_of_moves));
  const std::int64_t samples_of_cell = std::max(
      max_simulated_samples / (std::ssize(points) * indices.settings.total()), min_simulated_samples_of_cell);
  std::int64_t all_samples_left = max_simulated_samples;
  for (const std::int64_t point : points) {
    for (std::int64_t setting = 0; setting < indices.settings.total(); ++setting) {
      const std::int64_t samples = std::min(samples_of_cell, all_samples_left);
      std::int64_t samples_left = samples;
      std::vector<ExaminedTrial> trials;
      for (std::int64_t draw = 0; draw < draws; ++draw)
        trials.push_back({study::study_trial(study, point, indices.trial_of(draw, setting)).parameters});
      for (std::size_t i = 0; i < goal_tests.size(); ++i) {
        const GoalTest& test = goal_tests[i];
        if ((study.goals.empty() && test.needs_goal) || !is_wanted(test)) continue;
        for (const study::Goal& goal : goals) {
          const auto examine = test.of_trial != nullptr ? doubt_of_trials : doubt_of_moves;
          const std::optional<Doubt> doubt = examine(test, study, goal, {trials, samples_left});
          if (!doubt || !(doubt->ratio > worst[i].ratio)) continue;
          worst[i] = {doubt->ratio, place_text(study, point, setting) +
                                        (goal.name.empty() ? "" : "goal " + goal.name + ": ") + doubt->text};
        }
      }
      all_samples_left -= samples - samples_left;
    }
  }
  std::vector<std::string> lines;
  for (Doubt& line : worst)
    if (!line.text.empty()) lines.push_back(std::move(line.text));
  return lines;
}

}  // namespace

NoiseResponse response_to_noise(const FrozenLoop& loop, NoiseAt at, double bandwidth) {
  constexpr int angles = 4000;
  constexpr double uncorrelated = 0.1;
  const double pole = std::exp(-2.0 * std::numbers::pi * bandwidth * loop.sample_time);  // 0: white
  const OpenLoop open_loop_at = open_loop(loop);
  std::vector<double> power(angles);
  for (int i = 0; i < angles; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / angles;
    const std::complex<double> open = open_loop_at.at_angle(angle);
    const double spectrum = (1.0 - pole * pole) / std::norm(1.0 - std::polar(pole, -angle));
    power[static_cast<std::size_t>(i)] =
        std::norm((at == NoiseAt::axis ? open : 1.0) / (1.0 + open)) * spectrum / angles;
  }
  const auto correlation = [&](int lag) {
    double sum = 0.0;
    for (int i = 0; i < angles; ++i)
      sum += power[static_cast<std::size_t>(i)] * std::cos((i + 0.5) * std::numbers::pi / angles * lag);
    return sum;
  };
  const double mean_square = correlation(0);
  const auto is_correlated = [&](int lag) { return std::abs(correlation(lag)) > uncorrelated * mean_square; };
  // An oscillation is uncorrelated at a lag and correlated again later.
  int lag = 1;
  while (lag < angles / 4 && (is_correlated(lag) || is_correlated(lag + lag / 2) || is_correlated(2 * lag) ||
                              is_correlated(3 * lag)))
    lag *= 2;
  return {std::sqrt(mean_square), static_cast<double>(lag)};
}

std::string place_text(const study::Study& study, std::int64_t point, std::int64_t setting) {
  return fmt::format("point {} ({}){}: ", point, study.points.labels[static_cast<std::size_t>(point)],
                     study::setting_phrase(study.settings, setting));
}

std::vector<std::string> doubtful_goals(const study::Study& study) {
  return worst_lines(study, [](const GoalTest&) { return true; });
}

std::vector<std::string> obstacles_to_goals(const study::Study& study) {
  return worst_lines(study, [](const GoalTest& test) { return test.is_obstacle; });
}

std::vector<std::string> goals_out_of_reach(const study::Study& study) {
  return worst_lines(study, [](const GoalTest& test) { return test.holds_for_any_controller; });
}

}  // namespace zerocount::theory
