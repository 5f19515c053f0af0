#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/loop/encoder.hpp"
#include "runners/trials/trial_set.hpp"
#include "runners/tuning/tuner.hpp"

namespace zerocount::tuning {
namespace {

using summary::MoveBehaviour;

constexpr double max_overshoot_of_step = 0.25;
constexpr double max_saturated = 0.01;
constexpr double min_phase_margin = 30.0;  // degrees
constexpr double max_noise_of_range = 0.1;

/// Switches on the measures of the true motion at rest in the parameters of a trial, unless the study already
/// measures the motion. Rest is then a position error within the widest band or tolerance of the goals.
void measure_motion(const study::Study& study, trial::TrialParameters& p) {
  if (p.verdict.motion) return;
  p.verdict.motion = true;
  for (const study::Goal& goal : study.goals) {
    const double band = goal.tolerance ? std::ceil(*goal.tolerance / loop::fine_resolution(p.encoder))
                                       : static_cast<double>(goal.band);
    p.verdict.rest_band = std::max(p.verdict.rest_band, band);
  }
}

/// Text such as " of goal 'large' under condition loaded", which names the goal and the setting (condition at
/// an age) that a row of the table of move behaviour describes. It names the goal only if there are several,
/// and the setting only if the row has one. " that no goal is about" for moves that no goal judges.
std::string text_of_row(const MoveBehaviour& row, const study::Study& study) {
  const bool is_asked = row.number < study.goals.size();
  std::string text;
  if (!is_asked && !study.goals.empty()) text = " that no goal is about";
  if (is_asked && study.goals.size() > 1 && row.goal) text = fmt::format(" of goal '{}'", *row.goal);
  if (!row.setting) return text;
  return text + study::setting_phrase(study.settings, *row.setting);
}

/// Largest overshoot that stays within the band or tolerance of the goal that the row describes, counts. 1 if
/// the row has no goal; NaN for a tolerance if no move overshoots.
double overshoot_in_band(const MoveBehaviour& row, const study::Study& study) {
  if (row.number >= study.goals.size()) return 1.0;
  const study::Goal& goal = study.goals[row.number];
  if (!goal.tolerance) return std::max(static_cast<double>(goal.band), 1.0);
  return *goal.tolerance * row.overshoot.max / row.overshoot_length.max;  // NaN without overshoot
}

void judge_overshoot(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  if (!(row.overshoot_of_step.p95 > max_overshoot_of_step) ||
      !(row.overshoot.p95 > overshoot_in_band(row, study)))
    return;
  const double limit = std::max(max_overshoot_of_step * row.smallest_step, overshoot_in_band(row, study));
  const bool of_other_mass = row.number < study.goals.size() && study.goals[row.number].of_other_mass;
  const double count = row.overshoot_length.p95 / row.overshoot.p95;  // rad
  // Readings are whole counts; those of the other mass no encoder in the loop sees.
  const std::string remedy =
      of_other_mass ? fmt::format("limits: {{true_overshoot: {}}}", text::short_number(limit * count))
                    : fmt::format("limits: {{overshoot: {:g}}}", std::floor(limit));
  found.push_back(
      {"overshoot",
       fmt::format("5 % of the moves{} overshoot by {:.3g} % of the step or more (from {:.4g} counts)",
                   text_of_row(row, study), 100.0 * row.overshoot_of_step.p95, row.overshoot.p95),
       row.overshoot_of_step.p95, max_overshoot_of_step, remedy});
}

void judge_saturation(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  constexpr double part_of_range = 0.95;
  if (!(row.saturated > max_saturated)) return;
  found.push_back(
      {"saturation",
       fmt::format("the converter clips in {:.3g} % of the moves{}", 100.0 * row.saturated,
                   text_of_row(row, study)),
       row.saturated, max_saturated,
       fmt::format("limits: {{peak_torque: {}}}", text::short_number(part_of_range * row.range))});
}

void judge_noise(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  if (!row.rest || !(row.rest->of_range > max_noise_of_range)) return;
  const double largest = max_noise_of_range * row.range;
  found.push_back({"torque noise",
                   fmt::format("at rest after the moves{} the torque changes by {:.3g} % of the converter's "
                               "range (rms) from sample to sample, which heats the motor",
                               text_of_row(row, study), 100.0 * row.rest->of_range),
                   row.rest->of_range, max_noise_of_range,
                   fmt::format("limits: {{rest_torque_noise: {}}}, with verdict: {{motion: true}}",
                               text::short_number(largest * largest))});
}

}  // namespace

std::vector<MoveBehaviour> simulated_behaviour(const study::Study& study, const trials::Replicates& machines,
                                               std::int64_t count, const trials::Effort& effort) {
  constexpr std::int64_t block = 16;
  const std::int64_t settings = study.settings.total();
  const auto draw = [&](std::int64_t number) {
    const std::int64_t trial =
        trials::trial_of_replicate(study, machines, number / settings, number % settings);
    trial::TrialParameters p = study::study_trial(study, machines.point, trial).parameters;
    measure_motion(study, p);
    return p;
  };
  const std::vector<trial::TrialOutcome> outcomes =
      trials::results_of(std::min(count, machines.count) * settings, block, draw, effort,
                         [](const trial::TrialOutcome& outcome) { return outcome; });
  summary::BehaviourCounter counter(study);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    counter.add(summary::scale_of(draw(number)), number % settings, outcomes[i].moves);
  }
  return counter.behaviour();
}

std::vector<Refusal> refusals_of(const std::vector<MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study) {
  std::vector<Refusal> found;
  for (const MoveBehaviour& row : behaviour) {
    judge_overshoot(row, study, found);
    judge_saturation(row, study, found);
    judge_noise(row, study, found);
  }
  if (margins && margins->stable && margins->phase.value < min_phase_margin)
    found.push_back(
        {"phase margin",
         fmt::format("the smallest phase margin is {}°", text::short_number(margins->phase.value)),
         margins->phase.value, min_phase_margin, "tune: {margins: {phase: 30}}"});
  return found;
}

}  // namespace zerocount::tuning
