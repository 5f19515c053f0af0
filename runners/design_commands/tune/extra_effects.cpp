#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "analysis/trials/measures/move_criterion.hpp"
#include "core/numerics/roots.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::design_commands {
namespace {

constexpr std::int64_t points_of_delay = 13;
constexpr double max_more_delay = 5.0;  // samples

tuning::ExtraCost cost_of_delay(const tuning::TunedAxis& axis) {
  if (!axis.is_met) return {.trials = axis.machines().trials()};
  return {.points = points_of_delay, .trials = points_of_delay * axis.trials_of_point()};
}

/// [setting] Value of controller.delay of the first machine in each setting (condition at an age), samples.
std::vector<double> delays_of(const study::Study& study) {
  const study::TrialIndices indices = study::trial_indices(study);
  std::vector<double> delays;
  for (std::int64_t setting = 0; setting < indices.settings.total(); ++setting)
    delays.push_back(study::study_trial(study, 0, indices.trial_of(0, setting)).parameters.controller.delay);
  return delays;
}

/// Finds the additional delay of the controller at which a goal is lost. Every machine gets the same
/// additional delay in each setting.
void find_lost_delay(const tuning::TunedAxis& axis, MoreDelay& found) {
  const auto holds = [&](double more) {
    const tuning::Change later = [&](trial::TrialParameters& p) { p.controller.delay += more; };
    const std::optional<std::size_t> lost = axis.lost_claim(axis.tuned, &later);
    if (lost) found.claim = *lost;
    return !lost;
  };
  constexpr double accuracy = 1.0 / 32.0;
  double kept = 0.0;
  double lost = 0.25;
  while (holds(lost)) {
    if (lost == max_more_delay) return;
    kept = lost;
    lost = std::min(2.0 * lost, max_more_delay);
  }
  found.lost = numerics::bisect({kept, lost}, holds, numerics::within(accuracy)).holds;
}

/// Success rate of the goal, in its worst setting, if its band is one count wider. Nothing for a goal with a
/// tolerance instead of a band.
/// @param goal index of the goal
std::optional<double> rate_in_wider_band(const tuning::TunedAxis& axis, std::size_t goal) {
  const measures::MoveCriterion criterion = measures::move_criteria_of(axis.tuned).at(goal);
  if (criterion.settling != measures::Settling::in_band) return std::nullopt;
  const tuning::Change wider = [slot = criterion.slot](trial::TrialParameters& p) {
    for (std::size_t b = slot; b < p.verdict.bands.count; ++b) ++p.verdict.bands.limits[b];
  };
  const tuning::RateEstimate estimate =
      tuning::estimate_on(axis.tuned, axis.search.machines(), axis.machines().count, &wider, axis.effort);
  const std::size_t settings = tuning::aim_of(axis.tuned).settings;
  return std::ranges::min(std::span(estimate.rates).subspan(goal * settings, settings));
}

std::any find_delay(tuning::TunedAxis& axis) {
  MoreDelay found;
  if (axis.is_met) {
    found.delays = delays_of(axis.tuned);
    find_lost_delay(axis, found);
  } else {
    found.wider_band_rate = rate_in_wider_band(axis, axis.proof.verdict.goal);
  }
  return found;
}

/// Index of the setting (condition at an age) in which a goal is lost first by additional delay; 0 without
/// settings.
std::size_t delayed_setting(const MoreDelay& delay, const Tuning& tuning) {
  return tuning::place_of_claim(tuning.study, delay.claim).setting;
}

std::string borne_delay_sentence(const Tuning& tuning) {
  const MoreDelay& delay = found_by_extra<MoreDelay>(tuning);
  if (delay.delays.empty()) return "";
  if (!delay.lost)
    return fmt::format("the goals seem met up to {:g} samples more of controller.delay", max_more_delay);
  return fmt::format("with {:.3g} samples more of controller.delay, at {:.3g}, the goal{} seems lost",
                     *delay.lost, delay.delays[delayed_setting(delay, tuning)] + *delay.lost,
                     claim_text(tuning.study, tuning::place_of_claim(tuning.study, delay.claim)));
}

void describe_delay(Items& items) {
  items
      .value(proportion("wider_band_rate", "rate of the goal with a band one count wider",
                        "rate of the goal with a band one count wider, where it is not met"),
             [](const Tuning& t) { return found_by_extra<MoreDelay>(t).wider_band_rate; })
      .sentence(borne_delay_sentence)
      .value(
          document::in_data(
              "delay_lost",
              "controller.delay from which on the goal seems lost; with conditions that of the condition under which it is lost first",
              "samples"),
          [](const Tuning& t) -> std::optional<double> {
            const MoreDelay& delay = found_by_extra<MoreDelay>(t);
            if (!delay.lost) return {};
            return delay.delays[delayed_setting(delay, t)] + *delay.lost;
          })
      .value(optional(document::in_data("delay_lost_condition", "that condition, with conditions")),
             [](const Tuning& t) -> std::optional<std::string> {
               const MoreDelay& delay = found_by_extra<MoreDelay>(t);
               if (!delay.lost) return {};
               return tuning::names_of(t.study, {0, delayed_setting(delay, t)}).setting;
             });
}

constexpr std::int64_t points_of_robustness = 14;

tuning::ExtraCost cost_of_robustness(const tuning::TunedAxis& axis) {
  return {.applies = axis.is_met,
          .points = points_of_robustness,
          .trials = points_of_robustness * axis.machines().trials()};
}

/// Proportion of moves that meet the goal at the tuned values, if a premise of the study differs: other
/// seeds, another spread of the random parameters, another delay.
struct OtherPremises {
  std::vector<tuning::Limit> rates{};
};

std::any find_robustness(tuning::TunedAxis& axis) {
  const study::Study tuned = axis.on_machines();
  return OtherPremises{tuning::variations_of(
      tuning::EffectRuns(tuned, axis.machines(), axis.effort), axis.machines(),
      [&](std::uint64_t seed) { return axis.on_machines({fmt::format("seed={}", seed)}); })};
}

void describe_robustness(Items& items) {
  using document::everywhere;
  items.table(
      everywhere("robustness", "at the tuned values, with other premises",
                 "rates at the tuned values with other seeds, spreads and delays"),
      document::Description<tuning::Limit>()
          .value(everywhere("premise", "premise", "what differs from the study"), &tuning::Limit::effect)
          .value(everywhere("holds", "holds", "whether every goal is met under every condition"),
                 [](const tuning::Limit& one) { return one.rate ? std::optional(one.holds) : std::nullopt; })
          .value(proportion(
                     "rate", "rate",
                     "proportion of moves, or of machines, that meet the worst goal; of seeds the lowest"),
                 &tuning::Limit::rate)
          .value(optional(everywhere("note", "note", "what stayed, or why there is no rate")),
                 [](const tuning::Limit& one) {
                   return one.note.empty() ? std::nullopt : std::optional(one.note);
                 }),
      [](const Tuning& t) { return found_by_extra<OtherPremises>(t).rates; });
}

tuning::ExtraCost cost_of_limits(const tuning::TunedAxis& axis) {
  const std::int64_t points =
      std::llround(tuning::runs_of_causes(axis.tuned, 0, axis.search.machines().count));
  return {.points = points, .trials = points * axis.machines().trials()};
}

std::any find_limits(tuning::TunedAxis& axis) {
  const study::Study tuned = axis.on_machines();
  return tuning::find_causes(tuning::EffectRuns(tuned, axis.machines(), axis.effort));
}

void describe_limits(Items& items) {
  items.include(limits_description("what limits it, each by simulation on the machines of the search"),
                found_by_extra<std::vector<tuning::Limit>>);
}

}  // namespace

tuning::Extra margins_extra() {
  return {.name = "margins",
          .question = "How much more delay does it tolerate?",
          .part = "margins (what more delay loses)",
          .cost = cost_of_delay,
          .run = find_delay,
          .describe = describe_delay};
}

tuning::Extra robustness_extra() {
  return {.name = "robustness",
          .question = "Does it hold under other premises?",
          .cost = cost_of_robustness,
          .run = find_robustness,
          .describe = describe_robustness};
}

tuning::Extra limits_extra() {
  return {.name = "limits",
          .question = "What limits it?",
          .cost = cost_of_limits,
          .run = find_limits,
          .describe = describe_limits};
}

}  // namespace zerocount::design_commands
