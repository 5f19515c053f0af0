#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/forecast.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/pairs/comparison/point_trials.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/status/progress.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::design_commands {
namespace {

using document::everywhere;
using document::in_data;

/// Number of trials per design point that the pilot study simulates.
constexpr std::int64_t pilot_trials = 1000;
constexpr std::int64_t pilot_block = 100;  ///< Number of pilot trials that one task runs.
constexpr double min_planned_trials = 20.0;
constexpr double max_planned_trials = 100'000.0;

[[noreturn]] void refuse_margin(const command_line::Arguments& arguments, const std::string& text,
                                const std::string& expected) {
  arguments.refuse(fmt::format("option '--margin': '{}' is not a margin; expected {}", text, expected));
}

std::string measure_names() {
  std::vector<std::string> names;
  for (const comparison::GateMeasure& one : comparison::all_gate_measures()) names.emplace_back(one.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Parses a margin of the option --margin: `success_rate=0.02` is absolute, `arrival_time=5%` is relative to
/// the measure's value.
/// @returns name of the measure, and its margin
std::pair<std::string, comparison::GateMargin> read_margin(const command_line::Arguments& arguments,
                                                           const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto measure = comparison::find_gate_measure(name);
  if (const std::string_view meanings = trial::meanings_of_settling_time(name); !meanings.empty())
    refuse_margin(arguments, text, fmt::format("{}", meanings));
  if (equals == std::string::npos || !measure)
    refuse_margin(arguments, text, fmt::format("MEASURE=M, a measure of {}", measure_names()));
  std::string number = text.substr(equals + 1);
  const bool relative = number.ends_with('%');
  if (relative) number.pop_back();
  const double value = text::parse_number<double>(number).value_or(0.0);
  if (!std::isfinite(value) || value <= 0.0)
    refuse_margin(arguments, text, "a number greater than 0, or PERCENT% of the measure");
  if (measure->proportion() && !relative && value >= 1.0)
    refuse_margin(arguments, text, "less than 1, such as 0.02 for two percent points");
  if (relative) return {name, {.relative = 0.01 * value}};
  return {name, {.absolute = value}};
}

comparison::GateRules rules_of(const command_line::Arguments& arguments) {
  comparison::GateRules rules;
  rules.confidence = command_line::probability_option(arguments, "confidence").value_or(rules.confidence);
  rules.changed_fails = true;
  for (const std::string& text : arguments.values("margin")) {
    const auto [name, margin] = read_margin(arguments, text);
    rules.margins[name] = margin;
    rules.measures.push_back(name);
  }
  return rules;
}

study::Study planned_study(const command_line::Arguments& arguments) {
  const std::string& manifest = arguments.operands()[0];
  study::Study study = commands::load_study(manifest, arguments);
  plugins::require_no_hidden_state(study);
  const auto refuse = [&](const char* what) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}", manifest, what));
  };
  if (study.open_loop) refuse("has torque levels and no targets; expected a study with targets");
  if (study.design == study::Design::saltelli)
    refuse("the trials of `design: saltelli` are not independent; expected another design");
  return study;
}

/// Refuses margins for measures that belong to goals which the study does not have.
void require_goals_of_margins(const comparison::GateRules& rules, const study::Study& study,
                              const std::string& manifest) {
  if (study.goals.empty() && comparison::names_goal_measure(rules)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its manifest has no goal, by whose measures it is to be planned; expected one "
                    "such as goal: {{band: 1, within: 0.05, moves: 0.99}}",
                    manifest));
  }
  std::vector<std::string> names;
  for (const study::Goal& goal : study.goals) names.push_back(goal.name);
  comparison::require_named_goals(rules, names, manifest);
}

/// Simulates the first `trials` trials of a design point. Returns the measures of their moves.
/// @param study study in one setting (condition at an age)
comparison::PointTrials run_point(const study::Study& study, std::int64_t point, std::int64_t trials) {
  const auto draw = [&](std::int64_t index) { return study::study_trial(study, point, index).parameters; };
  std::vector<trial::MoveOutcome> outcomes;
  for (const std::vector<trial::MoveOutcome>& moves : trials::results_of(
           trials, pilot_block, draw, {}, [](const trial::TrialOutcome& outcome) { return outcome.moves; }))
    outcomes.insert(outcomes.end(), moves.begin(), moves.end());
  comparison::AlsoRead also;
  also.machines = study.machines;
  const std::vector<measures::MoveCriterion> counted = measures::criteria_of_goals(study);
  for (std::size_t i = 0; i < study.goals.size(); ++i) {
    also.judged.push_back({study.goals[i], counted[i], study.machines});
    also.judged.back().counts = measures::CellCounts({study.machines, study.worlds, 0});
  }
  return comparison::gather_trials(outcomes, std::ssize(outcomes) / trials, also);
}

/// A measure at a design point of the pilot study, and the number of trials with which two equal studies are
/// shown to be equivalent in it.
struct PlannedMeasure {
  std::string point;    ///< Label of the design point, with the setting (condition at an age).
  std::string setting;  ///< Name of the setting (condition at an age); empty without settings.
  comparison::Judgement found;
  /// Number of trials per design point that each of the two studies needs for this measure alone. Nothing if
  /// even the maximum number of trials does not decide the margin.
  std::optional<std::int64_t> trials{};
  /// Text of `trials`; without a number, the margin that the maximum number of trials decides.
  std::string trials_text{};

  std::string text(double value) const { return comparison::value_text(value, found.measure, found.unit); }
};

/// Plan of a comparison with enough trials to show that two equal studies are equivalent in their measures,
/// within margins.
struct EquivalencePlan {
  comparison::GateRules rules;
  double power{comparison::decision_probability};
  /// Number of pilot trials of each design point in each setting (condition at an age).
  std::int64_t pilot{0};
  std::int64_t settings{1};  ///< Number of settings (conditions at ages) in which each design point is run.
  comparison::Forecast forecast;
  std::int64_t machines{1};  ///< Number of machines of each design point; 1: no trials share a machine.
  std::vector<PlannedMeasure> measures;
  /// Measures for which too few pilot trials have a value to plan the number of trials.
  std::vector<PlannedMeasure> unplanned;
};

/// Adds to the plan the measures of a design point in a setting (condition at an age). The pilot's sample
/// represents both studies that are to be compared.
/// @param trials pilot trials of the point in this setting
void add_point(EquivalencePlan& plan, comparison::ForecastSamples& samples, const std::string& design_point,
               const std::string& setting, const comparison::PointTrials& trials) {
  const std::string label = study::label_under(design_point, setting);
  const comparison::BothTrials both{trials, trials, false};
  const auto found = comparison::compare_measures(plan.rules, label, both);
  const auto of_measures = comparison::measure_samples(plan.rules, found, both);
  samples.add_point(plan.pilot, plan.pilot);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const comparison::Judgement& one = found[k];
    const bool is_planned = comparison::has_finite_bounds(one);
    (is_planned ? plan.measures : plan.unplanned).push_back({label, setting, one});
    if (is_planned) samples.add(one, of_measures[k]);
  }
}

/// Number of trials of a design point in all settings (conditions at ages) together. It is rounded up so that
/// each machine has equally many trials in each setting.
/// @param each trials of the point in each setting
std::int64_t trials_of_point(const EquivalencePlan& plan, double each) {
  const double on_machine = std::ceil(each / static_cast<double>(plan.machines));
  return plan.settings * plan.machines * static_cast<std::int64_t>(on_machine);
}

/// Text of the number that trials_of_point() gives. The text is rounded up if any number of trials can be
/// run.
std::string trials_text(const EquivalencePlan& plan, double each) {
  const std::int64_t trials = trials_of_point(plan, each);
  return plan.settings * plan.machines > 1 ? std::to_string(trials)
                                           : comparison::trials_text(static_cast<double>(trials));
}

void take_forecast(const EquivalencePlan& plan, PlannedMeasure& measure,
                   const comparison::JudgementForecast& forecast) {
  if (forecast.trials) {
    measure.trials = trials_of_point(plan, *forecast.trials);
    measure.trials_text = trials_text(plan, *forecast.trials);
  } else {
    measure.trials_text = fmt::format("{} decide a margin of {}", trials_text(plan, plan.forecast.max_trials),
                                      measure.text(forecast.margin));
  }
}

EquivalencePlan plan_of(const command_line::Arguments& arguments) {
  EquivalencePlan plan;
  plan.rules = rules_of(arguments);
  plan.power = command_line::probability_option(arguments, "power").value_or(plan.power);
  const study::Study study = planned_study(arguments);
  require_goals_of_margins(plan.rules, study, arguments.operands()[0]);
  plan.settings = study.settings.total();
  plan.machines = std::max<std::int64_t>(study.machines, 1);
  std::vector<study::Study> under;  // [setting]
  for (std::int64_t i = 0; i < plan.settings; ++i) under.push_back(study::in_setting(study, i));
  const std::int64_t trials = under.front().trials;
  plan.pilot = study.machines > 0 ? trials : std::min(trials, pilot_trials);
  const std::int64_t units = study.machines > 0 ? study.machines : plan.pilot;
  comparison::ForecastSamples samples({units, units}, true);
  status::Progress progress(study::point_count(study) * plan.settings * plan.pilot, 0,
                            trials::samples_per_trial(study), false);
  std::int64_t done = 0;
  for (std::int64_t i = 0; i < study::point_count(study); ++i) {
    for (std::size_t setting = 0; setting < under.size(); ++setting) {
      add_point(plan, samples, study.points.labels[static_cast<std::size_t>(i)],
                study::label_of(study.settings, static_cast<std::int64_t>(setting)),
                run_point(under[setting], i, plan.pilot));
      progress.update(done += plan.pilot);
    }
  }
  if (plan.measures.empty()) {
    throw Failure(
        ExitCode::inconclusive,
        fmt::format("{}: fewer than {} of {} trials of the pilot have a value; nothing can be planned",
                    arguments.operands()[0], comparison::min_values, plan.pilot));
  }
  comparison::ForecastOptions options;
  options.confidence = plan.rules.confidence;
  options.probability = plan.power;
  options.min_factor = min_planned_trials / static_cast<double>(plan.pilot);
  options.max_factor = std::max(2.0, max_planned_trials / static_cast<double>(plan.pilot));
  plan.forecast = comparison::forecast_equivalence(samples, options);
  for (std::size_t k = 0; k < plan.measures.size(); ++k)
    take_forecast(plan, plan.measures[k], plan.forecast.judgements[k]);
  return plan;
}

using Measure = const PlannedMeasure&;

document::Description<PlannedMeasure> place_columns() {
  return document::Description<PlannedMeasure>()
      .value(everywhere("point", "point", "label of the design point, with the condition"),
             &PlannedMeasure::point)
      .value(in_data("condition", "its trials are under it; absent without conditions"),
             [](Measure one) { return one.setting.empty() ? std::nullopt : std::optional(one.setting); })
      .value(everywhere("measure", "measure", "name of the measure"),
             [](Measure one) { return one.found.measure; });
}

document::Description<PlannedMeasure> measure_columns() {
  const auto shown = [](const char* key, const char* heading, const char* meaning) {
    document::Item item = everywhere(key, heading, meaning);
    item.numeric = true;
    return item;
  };
  return place_columns()
      .value(in_data("unit", "its unit"), [](Measure one) { return one.found.unit; })
      .value(shown("value", "pilot", "its value in the pilot, in its unit"),
             [](Measure one) { return one.found.current; })
      .shown_as([](Measure one) { return one.text(one.found.current); })
      .value(shown("margin", "margin", "largest accepted difference, in its unit"),
             [](Measure one) { return one.found.margin; })
      .shown_as([](Measure one) { return "± " + one.text(one.found.margin); })
      .value(shown("trials", "trials", "trials of each study per design point for this measure alone"),
             &PlannedMeasure::trials)
      .shown_as(&PlannedMeasure::trials_text);
}

std::string equivalence_headline(const EquivalencePlan& plan) {
  return fmt::format(
      "{} trials per design point{} in each of the two studies{} show with a probability of {} that all "
      "these "
      "measures are equivalent",
      trials_text(plan, plan.forecast.trials.value_or(plan.forecast.max_trials)),
      plan.settings > 1 ? ", under all conditions together," : "", plan.forecast.trials ? "" : " do not",
      text::percent(plan.power));
}

std::string aim_sentence(const EquivalencePlan& plan) {
  return fmt::format(
      "equivalent: two equal studies with different random numbers differ by less than the margins (bounds: "
      "{} "
      "each), by a pilot of {} trials per design point",
      text::percent(plan.rules.confidence), plan.settings * plan.pilot);
}

document::AnswerDescription<EquivalencePlan> equivalence_answer() {
  document::AnswerDescription<EquivalencePlan> answer{
      {.name = "plan-equivalence",
       .meaning = "trials that show that two equal studies are equivalent",
       .csv_table = "measures"},
      {}};
  answer.items.headline(equivalence_headline)
      .sentence(aim_sentence)
      .value(in_data("confidence", "confidence of each bound", "1"),
             [](const EquivalencePlan& plan) { return plan.rules.confidence; })
      .value(in_data("power", "probability with which equivalence is shown", "1"), &EquivalencePlan::power)
      .value(in_data("pilot_trials", "trials of the pilot per design point"),
             [](const EquivalencePlan& plan) { return plan.settings * plan.pilot; })
      .value(in_data("trials", "trials of each study per design point; unknown if max_trials do not suffice"),
             [](const EquivalencePlan& plan) {
               const std::optional<double>& trials = plan.forecast.trials;
               return trials ? std::optional(trials_of_point(plan, *trials)) : std::nullopt;
             })
      .value(in_data("max_trials", "the most trials that were tried"),
             [](const EquivalencePlan& plan) { return trials_of_point(plan, plan.forecast.max_trials); })
      .table({.key = "measures", .meaning = "measures at the design points"}, measure_columns(),
             &EquivalencePlan::measures)
      .table(everywhere("unplanned", "Not planned: too few trials of the pilot have a value",
                        "measures of which too few trials of the pilot have a value"),
             place_columns(), &EquivalencePlan::unplanned);
  return answer;
}

}  // namespace

document::Answer equivalence_plan(const command_line::Arguments& arguments) {
  const EquivalencePlan plan = plan_of(arguments);
  return equivalence_answer().of(plan, plan.forecast.trials ? ExitCode::success : ExitCode::inconclusive);
}

document::AnswerType equivalence_plan_type() {
  return equivalence_answer().complete_type();
}

}  // namespace zerocount::design_commands
