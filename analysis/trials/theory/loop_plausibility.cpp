#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/theory/plausibility.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/friction/presliding/spring.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/stability.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t max_trials_of_point = 5;
constexpr double min_phase_margin = 20.0;  // degrees
constexpr double min_delay_margin = 1.0;   // samples

/// The longest move of a trial, and the travel before the axis slides (presliding range), both in counts.
struct Travel {
  double move{0.0};
  /// Presliding range, counts; infinite if the friction has no spring before it slides, or criteria (6) and
  /// (7) do not apply.
  double range{std::numeric_limits<double>::infinity()};

  bool slides() const { return move > range; }
};

Travel travel_of(const trial::TrialParameters& p) {
  Travel travel;
  if (loop::moves_for_ever(p.command.profile.shape) || is_outside_theory(p)) return travel;
  for (const TargetStep& step : target_steps(p.command))
    travel.move = std::max(travel.move, static_cast<double>(step.length()));
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  travel.range = friction::presliding_range(contact) / loop::fine_resolution(p.encoder);
  return travel;
}

/// One control loop of one trial, with what the plausibility tests need.
struct ExaminedLoop {
  const trial::TrialParameters& trial;
  const TrialLoop& of_trial;
  Travel travel;
  LoopStability stability{LoopStability::stable};
  /// Phase margin, degrees, and its frequency, Hz; NaN if the margin is not needed.
  Margin phase{std::numeric_limits<double>::quiet_NaN(), 0.0};
};

/// Whether the controller has integral action alone, and criteria (6) and (7) apply to it.
bool is_integral_alone(const trial::TrialParameters& p) {
  return p.controller.kp == 0.0 && p.controller.kd == 0.0 &&
         left_out_of_criteria(p.plant, p.controller).empty();
}

/// Whether the stability margins of the loop matter, because moves of the trial are made in it: at rest, and
/// while sliding if they go so far. Without a spring before it slides, only where the loop is stable or there
/// is no friction: others hunt by design. Integral control alone works beyond criterion (6) too, that is with
/// a loop at k1 which is not stable; it does not beyond (7). So does it at the softest place of a profile.
bool is_used(const ExaminedLoop& loop) {
  if (!friction::has_friction(loop.trial.friction.model)) return true;
  if (loop.of_trial.slides) return loop.stability == LoopStability::stable && loop.travel.slides();
  const std::string& name = loop.of_trial.name;
  return (name != "at k1" && name != at_softest) || !is_integral_alone(loop.trial);
}

/// The value of a loop that a test compares with its limit; NaN if the test does not apply to the loop.
using Measure = double (*)(const ExaminedLoop&);
constexpr double not_concerned = std::numeric_limits<double>::quiet_NaN();

double phase_margin(const ExaminedLoop& loop) {
  return loop.stability == LoopStability::stable ? std::abs(loop.phase.value) : loop.phase.value;
}

// Only of stable loops with a sufficient phase margin: the others are reported by that test.
double delay_margin(const ExaminedLoop& loop) {
  if (loop.stability != LoopStability::stable || !(loop.phase.value >= min_phase_margin))
    return not_concerned;
  return loop.phase.value / 360.0 / loop.phase.frequency * loop.trial.controller.sample_rate;
}

// In the coarse phase, if there is one: it makes the long moves.
double presliding_range_over_move(const ExaminedLoop& loop) {
  const bool coarse = loop::has_coarse_phase(loop.trial.controller);
  const bool makes_moves =
      loop.of_trial.slides && (!coarse || loop.of_trial.phase == loop::ControlPhase::coarse);
  if (!makes_moves || loop.stability != LoopStability::unstable) return not_concerned;
  return loop.travel.range / loop.travel.move;
}

/// One row of the table of plausibility tests of loops.
struct LoopTest {
  Measure measure;
  double least;  ///< Value of the measure below which the loop is doubtful.
  std::string (*text)(const ExaminedLoop&, double value);
};

std::string phase_text(const ExaminedLoop& loop, double) {
  const bool unstable = loop.stability == LoopStability::unstable;
  return fmt::format("{} the phase margin is {:.3g}° at {:.3g} Hz{}; expected at least {}°",
                     loop.of_trial.name, loop.phase.value, loop.phase.frequency,
                     unstable ? ", and the loop is unstable" : "", min_phase_margin);
}

std::string delay_text(const ExaminedLoop& loop, double value) {
  return fmt::format(
      "{} a delay of {:.2g} samples more makes the loop unstable (phase margin {:.3g}° at {:.3g} Hz); "
      "expected at least {} sample",
      loop.of_trial.name, value, loop.phase.value, loop.phase.frequency, min_delay_margin);
}

std::string move_text(const ExaminedLoop& loop, double) {
  return fmt::format(
      "a move of {:.6g} counts is longer than the pre-sliding range of {:.4g} counts, and {} the loop is "
      "unstable; expected shorter moves, or gains that are stable then",
      loop.travel.move, loop.travel.range, loop.of_trial.name);
}

constexpr std::array<LoopTest, 3> tests{{{phase_margin, min_phase_margin, phase_text},
                                         {delay_margin, min_delay_margin, delay_text},
                                         {presliding_range_over_move, 1.0, move_text}}};

}  // namespace

std::vector<std::string> doubtful_loops(const study::Study& study) {
  std::vector<std::string> lines(tests.size());  // [test] of its worst value; empty where it does not fail
  std::array<double, tests.size()> worst{};
  worst.fill(std::numeric_limits<double>::infinity());
  const std::vector<std::int64_t> points =
      statistics::spread_over(study::point_count(study), max_trials_doubted);
  const study::TrialIndices indices = study::trial_indices(study);
  const std::int64_t draws =
      std::clamp<std::int64_t>(max_trials_doubted / (std::ssize(points) * indices.settings.total()), 1,
                               std::min(study::draw_count(study), max_trials_of_point));
  for (const std::int64_t point : points) {
    for (std::int64_t i = 0; i < draws * indices.settings.total(); ++i) {
      const std::int64_t setting = i % indices.settings.total();
      const std::int64_t index = indices.trial_of(i / indices.settings.total(), setting);
      const trial::TrialParameters p = study::study_trial(study, point, index).parameters;
      const Travel travel = travel_of(p);
      for (const TrialLoop& loop : trial_loops(p)) {
        ExaminedLoop examined{p, loop, travel, stability_of(loop.loop, p.command.hold)};
        if (is_used(examined)) examined.phase = stability_margins(loop.loop).phase;
        for (std::size_t test = 0; test < tests.size(); ++test) {
          const double value = tests[test].measure(examined);
          if (!(value < tests[test].least) || !(value < worst[test])) continue;
          worst[test] = value;
          lines[test] = place_text(study, point, setting) + tests[test].text(examined, value);
        }
      }
    }
  }
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  return lines;
}

}  // namespace zerocount::theory
