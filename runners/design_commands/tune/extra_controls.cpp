#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/trials/goal/goal_text.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::design_commands {
namespace {

using document::in_data;
using tuning::OtherControl;
using tuning::TunedAxis;
using tuning::TunedValues;
using tuning::Values;

using Alternatives = std::vector<Alternative>;

constexpr std::int64_t trials_of_control = 125'000;

/// Cost of the searches for other control laws. They never fail to fit, because they take whatever effort
/// there is (usual_part is 0).
tuning::ExtraCost cost_of_controls(const TunedAxis& axis) {
  std::int64_t least = 0;
  std::int64_t searches = 0;
  for (const OtherControl& one : tuning::other_controls(axis.study)) {
    least += tuning::least_trials_of_other_search(axis.study, one.free);
    ++searches;
  }
  const trials::Effort each = axis.one_of_parts(static_cast<double>(searches), trials_of_control);
  return {.searches = least,
          .trials = searches * std::min(trials_of_control, tuning::affordable_trials(each, axis.speed)),
          .usual_part = 0.0};
}

TunedValues values_by_name(const std::vector<study::FreeParameter>& free, const Values& values) {
  TunedValues by_name;
  for (std::size_t i = 0; i < free.size(); ++i) by_name[free[i].name] = values[i];
  return by_name;
}

tuning::SearchResult search_control(TunedAxis& axis, const study::Study& study, const OtherControl& control,
                                    const trials::Effort& effort, std::span<const TunedValues> tuned) {
  const tuning::SearchPlan plan = tuning::plan_other_search(study, control.free, effort, axis.speed);
  tuning::StudySearch search(study, control.free, plan.size, axis.journal, effort);
  tuning::SearchSettings settings;
  settings.seed = study.seed;
  settings.begins_anew = axis.has_budget();
  settings.effort = plan.effort;
  tuning::SearchResult found = search.run(settings, tuning::starts_from(tuned, control.free));
  axis.searched.points += found.points;
  axis.searched.trials += found.trials;
  if (found.finalists.empty() && found.cut) throw trials::Spent{};
  return found;
}

/// Simulates the control law with its tuned values on fresh machines, and stores its verdict and criterion in
/// `alternative`.
void judge_control(const TunedAxis& axis, const study::Study& study, const OtherControl& control,
                   const Values& values, const trials::Effort& effort, Alternative& alternative) {
  alternative.gains = named(control.free, values);
  const trials::Replicates machines{tuning::machines_of_judgement(study, effort, axis.speed),
                                    tuning::trials_of_machine(study)};
  std::vector<std::string> fresh = tuning::overrides_of(control.free, values);
  fresh.push_back(fmt::format("seed={}", trials::fresh_seed(study.seed, "tuning, alternative")));
  for (const std::string& one : trials::overrides_for(study, machines)) fresh.push_back(one);
  tuning::Judged judged = tuning::judged(
      study, machines,
      tuning::results_of(trials::variant_of(study, fresh), machines, machines.count, nullptr, effort));
  alternative.criterion = judged.criterion;
  alternative.worst = tuning::names_of(study, {judged.verdict.goal, judged.verdict.setting});
  alternative.verdict = std::move(judged.verdict);
}

/// Tunes another control law and judges it on fresh machines.
/// @param tuned values of the control laws tuned so far, from which the search starts; the values found are
/// appended
Alternative find_control(TunedAxis& axis, const OtherControl& control, const trials::Effort& effort,
                         std::vector<TunedValues>& tuned) {
  const study::Study study = trials::variant_of(axis.study, control.overrides);
  const tuning::SearchResult found = search_control(axis, study, control, effort, tuned);
  Alternative alternative;
  alternative.name = control.name;
  for (const std::string& name : control.zero) alternative.fixed.emplace_back(name, 0.0);
  if (found.finalists.empty()) return alternative;
  const Values& best = found.finalists.front().values;
  judge_control(axis, study, control, best, effort, alternative);
  tuned.push_back(values_by_name(control.free, best));
  for (const std::string& name : control.zero) tuned.back()[name] = 0.0;
  return alternative;
}

std::any find_controls(TunedAxis& axis) {
  const std::vector<OtherControl> controls = tuning::other_controls(axis.study);
  std::vector<TunedValues> tuned{values_by_name(axis.free(), axis.values)};
  Alternatives found;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const trials::Effort part =
        axis.one_of_parts(static_cast<double>(controls.size() - i), trials_of_control);
    if (!tuning::ended(axis.effort, [&] { found.push_back(find_control(axis, controls[i], part, tuned)); }))
      axis.extras.left_out.push_back({fmt::format("controls ({})", controls[i].name), "controls"});
  }
  return found;
}

document::Description<Alternative> alternative_columns() {
  using document::Visibility;
  return document::Description<Alternative>()
      .value(document::to_people("control"), &Alternative::name)
      .value(in_data("fixed", "parameters that are not tuned, with their values"), &Alternative::fixed)
      .value(document::everywhere("gains", "best values",
                                  "its best values by parameter; none if none keeps the margins"),
             &Alternative::gains)
      .shown_as([](const Alternative& row) {
        return row.verdict ? values_text(row.gains) : "none keeps the margins";
      })
      .value({.key = "status",
              .heading = "goal",
              .meaning = "verdict on the goal",
              .words = goal::status_words()},
             [](const Alternative& row) {
               return row.verdict ? std::optional(goal::text_of(row.verdict->status)) : std::nullopt;
             })
      .value(proportion("rate", "moves that meet it",
                        "proportion of moves that meet the goal, with one-sided bounds"),
             [](const Alternative& row) {
               return row.verdict ? std::optional(goal::bounded(row.verdict->moves)) : std::nullopt;
             })
      .include(named_claim_columns("worst goal", "worst condition or age", "goal_name"), &Alternative::worst)
      .value(criterion_item(), [](const Alternative& row) {
        return row.verdict ? std::optional(row.criterion) : std::nullopt;
      });
}

/// Whether the control law, in which some parameters are 0, does clearly better than the proven values. Its
/// parameters are in their ranges, so the tuning could have found it.
bool is_better_within_ranges(const Alternative& one, const Tuning& tuning) {
  constexpr double clearly = 0.95;
  if (one.fixed.empty() || !one.verdict || !tuning.answer.proof) return false;
  const goal::Verdict& proven = tuning.answer.proof->verdict;
  if (one.verdict->status == goal::Status::met && proven.status == goal::Status::met)
    return one.criterion < clearly * tuning.answer.proof->criterion;
  if (one.verdict->status == goal::Status::met) return true;
  const study::Goal& goal = worst_goal(tuning);
  return goal::judged_rate(goal, *one.verdict).low > goal::judged_rate(goal, proven).high;
}

std::string better_control_sentence(const Tuning& tuning) {
  std::string lines;
  for (const Alternative& one : found_by_extra<Alternatives>(tuning)) {
    if (!is_better_within_ranges(one, tuning)) continue;
    lines += one.name + " seems to do better, and lies in the ranges too; begin there:";
    for (const auto* const values : {&one.fixed, &one.gains}) {
      for (const auto& [name, value] : *values) lines += fmt::format(" --set {}={}", name, value);
    }
    lines += '\n';
  }
  return lines;
}

void describe_controls(Items& items) {
  items
      .table({.key = "alternatives",
              .heading = "other controls, each at its own best values, on other machines than its search",
              .meaning = "simpler and other controls at their own best values"},
             alternative_columns(), found_by_extra<Alternatives>)
      .sentence(better_control_sentence);
}

}  // namespace

tuning::Extra controls_extra() {
  return {.name = "controls",
          .question = "Would another control do?",
          .cost = cost_of_controls,
          .run = find_controls,
          .describe = describe_controls};
}

}  // namespace zerocount::design_commands
