#include "analysis/theory/goal_plausibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "analysis/statistics/spread_over.hpp"
#include "analysis/theory/loop_plausibility.hpp"
#include "analysis/theory/trial_loops.hpp"
#include "core/friction/law.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/stability.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t max_draws_examined = 3;

/// A goal and a trial that is to meet it.
struct GoalOfTrial {
  const study::Study& study;
  const study::Goal& goal;
  const trial::TrialParameters& trial;

  bool feeds_back_coarse() const { return trial.controller.encoder == loop::EncoderChoice::coarse; }
  double count() const {  // rad
    return feeds_back_coarse() ? loop::coarse_resolution(trial.encoder)
                               : loop::fine_resolution(trial.encoder);
  }
  const loop::EncoderErrors& errors() const {
    return feeds_back_coarse() ? trial.encoder.coarse_errors : trial.encoder.fine_errors;
  }
  /// From one end of the band or tolerance to the other, rad.
  double width() const {
    return goal.tolerance ? 2.0 * *goal.tolerance : (2.0 * static_cast<double>(goal.band) + 1.0) * count();
  }
  /// Samples of the shortest move of the goal at which it must be within the band.
  double samples_within() const {
    const double from = std::floor(goal.within * trial.controller.sample_rate);
    return std::max(static_cast<double>(trial::samples_of_move(trial, 0)) - from, 1.0);
  }
  std::string length(double value) const {
    return fmt::format("{:.3g} {}", value, parameters::unit_on(study.units.axis, "rad"));
  }
  std::string band_text() const {
    return goal.tolerance ? "a tolerance of " + length(*goal.tolerance)
                          : fmt::format("a band of {} count{}", goal.band, goal.band == 1 ? "" : "s");
  }
};

/// Upper tail probability of both sides of the normal distribution.
double outside(double bound, double deviation) {
  return std::erfc(bound / deviation / std::numbers::sqrt2);
}

constexpr double negligible = 1e-6;  // of the samples or moves; smaller proportions are written as this

/// An upper bound in %.
std::string percent_at_most(double proportion) {
  return fmt::format("{:.3g} %", 100.0 * std::max(proportion, negligible));
}

std::string percent_text(double proportion) {
  return (proportion < negligible ? "less than " : "") + percent_at_most(proportion);
}

/// Result of a test: a factor that is above 1 where the goal is out of reach, and the reason.
struct Doubt {
  double ratio{0.0};
  std::string text{};
};

Doubt below_half_a_count(const GoalOfTrial& of) {
  if (!of.goal.tolerance) return {};
  const double half = 0.5 * of.count();
  return {half / *of.goal.tolerance,
          fmt::format("{} is less than half a count, {}: an axis at zero counts stands anywhere within its "
                      "count, and the loop does not see where; expected at least {}, which zero counts hold, "
                      "or a count of at most {}",
                      of.band_text(), of.length(half), of.length(half), of.length(2.0 * *of.goal.tolerance))};
}

Doubt noise_leaves_the_band(const GoalOfTrial& of) {
  const loop::EncoderErrors& errors = of.errors();
  if (of.goal.tolerance || !(errors.noise > 0.0)) return {};
  // Noise with a bandwidth has about two independent values in each period of it.
  const double independent =
      std::min(1.0, 2.0 * errors.noise_bandwidth / of.trial.controller.sample_rate) * of.samples_within();
  const double rate =
      highest_rate_within_band(static_cast<double>(of.goal.band), errors.noise, std::max(independent, 1.0));
  return {
      of.goal.moves / rate,
      fmt::format("encoder noise of {:.3g} counts rms leaves {} in {} of the samples of an axis that stands "
                  "still, and {:.0f} samples of a move must be within it: at most {} of the moves can meet "
                  "the goal, which asks for {}; expected less noise, a wider band, or a tolerance",
                  errors.noise, of.band_text(),
                  percent_text(outside(static_cast<double>(of.goal.band) + 0.5, errors.noise)),
                  of.samples_within(), percent_at_most(rate), percent_text(of.goal.moves))};
}

Doubt noise_moves_the_axis(const GoalOfTrial& of) {
  const loop::EncoderErrors& errors = of.errors();
  if (!of.goal.tolerance || !(errors.noise > 0.0)) return {};
  double least = std::numeric_limits<double>::infinity();
  for (const TrialLoop& loop : trial_loops(of.trial)) {
    if (loop.slides || stability_of(loop.loop, of.trial.command.hold) != LoopStability::stable) continue;
    least = std::min(least, motion_by_noise(loop.loop, errors.noise, of.count(), errors.noise_bandwidth));
  }
  if (!std::isfinite(least)) return {};
  const double rate = 1.0 - outside(*of.goal.tolerance, least);  // of the last sample alone
  return {of.goal.moves / rate,
          fmt::format("encoder noise of {:.3g} counts rms moves the axis by {} rms by the linear loop: it is "
                      "within {} in {} of the samples, and the goal asks for {} of the moves; expected less "
                      "noise, lower gains, or a wider tolerance",
                      errors.noise, of.length(least), of.band_text(), percent_text(rate),
                      percent_text(of.goal.moves))};
}

Doubt code_leaves_the_band(const GoalOfTrial& of) {
  const trial::TrialParameters& p = of.trial;
  if (!friction::has_spring(p.friction.model) || p.dac.sigma_delta) return {};
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  const double stiffness = contact.k1 + contact.k2;
  const double travel = p.dac.resolution / stiffness;
  const std::string torque = parameters::unit_on(of.study.units.axis, "N m");
  return {travel / of.width(),
          fmt::format(
              "one code of the DAC, {:.3g} {}, moves the axis by {} = {:.3g} counts even at k1 + k2, right "
              "after a reversal, more than the {} from one end of {} to the other; expected a code of at "
              "most {:.3g} {}, dac.sigma_delta, or a wider one",
              p.dac.resolution, torque, of.length(travel), travel / of.count(), of.length(of.width()),
              of.band_text(), stiffness * of.width(), torque)};
}

using GoalTest = Doubt (*)(const GoalOfTrial&);
constexpr std::array<GoalTest, 4> goal_tests{below_half_a_count, noise_leaves_the_band, noise_moves_the_axis,
                                             code_leaves_the_band};

/// The smallest doubt of the first trials of a point under a condition.
Doubt smallest_doubt(GoalTest test, const study::Study& study, const study::Goal& goal, std::int64_t point,
                     std::int64_t condition) {
  Doubt smallest{std::numeric_limits<double>::infinity()};
  for (std::int64_t draw = 0; draw < std::min(study::draw_count(study), max_draws_examined); ++draw) {
    const trial::TrialParameters p =
        study::study_trial(study, point, study::turns_of(study).trial_of(draw, condition)).parameters;
    Doubt doubt = test({study, goal, p});
    if (doubt.ratio < smallest.ratio) smallest = std::move(doubt);
    if (!(smallest.ratio > 1.0)) break;
  }
  return smallest;
}

std::optional<std::string> worst_doubt(GoalTest test, const study::Study& study,
                                       const std::vector<std::int64_t>& points) {
  double worst = 1.0;
  std::optional<std::string> line;
  for (const std::int64_t point : points) {
    for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition) {
      for (const study::Goal& goal : study.goals) {
        const Doubt doubt = smallest_doubt(test, study, goal, point, condition);
        if (!(doubt.ratio > worst)) continue;
        worst = doubt.ratio;
        line =
            fmt::format("point {} ({}){}: {}{}", point, study.points.labels[static_cast<std::size_t>(point)],
                        study::condition_text(study, condition),
                        goal.name.empty() ? "" : "goal " + goal.name + ": ", doubt.text);
      }
    }
  }
  return line;
}

}  // namespace

double highest_rate_within_band(double band, double noise, double samples) {
  return std::exp(samples * std::log1p(-outside(band + 0.5, noise)));
}

double motion_by_noise(const FrozenLoop& loop, double noise, double resolution, double bandwidth) {
  constexpr int angles = 4000;
  const double pole = std::exp(-2.0 * std::numbers::pi * bandwidth * loop.sample_time);  // 0: white
  const OpenLoop open_loop_at = open_loop(loop);
  double mean_square = 0.0;
  for (int i = 0; i < angles; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / angles;
    const std::complex<double> open = open_loop_at.at_angle(angle);
    const double spectrum = (1.0 - pole * pole) / std::norm(1.0 - std::polar(pole, -angle));
    mean_square += std::norm(open / (1.0 + open)) * spectrum / angles;
  }
  return noise * resolution * std::sqrt(mean_square);
}

std::vector<std::string> doubtful_goals(const study::Study& study) {
  std::vector<std::string> lines;
  if (study.goals.empty()) return lines;
  const std::int64_t claims = study::condition_count(study) * std::ssize(study.goals);
  const std::vector<std::int64_t> points = statistics::spread_over(
      study::point_count(study), std::max<std::int64_t>(max_trials_doubted / claims, 1));
  for (const GoalTest test : goal_tests) {
    if (const auto line = worst_doubt(test, study, points)) lines.push_back(*line);
  }
  return lines;
}

}  // namespace zerocount::theory
