#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/chosen_summary.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/status/progress.hpp"

namespace zerocount::design_commands {
namespace {

using document::everywhere;
using document::in_data;
using document::to_people;
using document::Visibility;
using document::with_words;

constexpr std::string_view other_plans = ", or --success, --halfwidth or --margin";

/// Size of a study that decides or can meet a goal, and the time that it takes with all cores of this
/// computer, s; nothing if it was not measured.
struct PlannedStudy : goal::Needs {
  std::optional<double> seconds{};
};

bool is_on_machines(const study::Study& study) {
  return std::ranges::any_of(study.goals, [](const study::Goal& goal) { return goal.machines.has_value(); });
}

/// The study sizes with their computing times. Times are measured only for goals on machines, which leave a
/// choice between many machines and many trials on each.
std::vector<PlannedStudy> with_times(const std::vector<goal::Needs>& studies, const study::Study& study) {
  std::vector<PlannedStudy> planned;
  planned.reserve(studies.size());
  for (const goal::Needs& one : studies) planned.push_back({one});
  if (studies.empty() || !is_on_machines(study)) return planned;
  const double seconds_per_trial =
      forecast::measure_cost(study).seconds() / static_cast<double>(study.trials);  // of all points
  for (PlannedStudy& one : planned) one.seconds = seconds_per_trial * static_cast<double>(one.trials);
  return planned;
}

document::Description<PlannedStudy> study_columns() {
  return document::Description<PlannedStudy>()
      .value(everywhere("machine_count", "machines", "number of machines; 0 without machines"),
             &PlannedStudy::machines)
      .value(to_people("trials on each"),
             [](const PlannedStudy& one) {
               return one.machines > 0 ? std::optional(one.trials / one.machines) : std::nullopt;
             })
      .value(everywhere("trials", "trials", "trials of a design point"), &PlannedStudy::trials)
      .value({.heading = "time here", .shown = Visibility::to_people, .numeric = true},
             [](const PlannedStudy& one) {
               return one.seconds ? status::duration_text(*one.seconds) : std::string();
             })
      .value({.key = "seconds",
              .meaning = "computing time with all cores of this machine; of goals on machines",
              .unit = "s",
              .shown = Visibility::in_data,
              .optional = true},
             &PlannedStudy::seconds);
}

/// The smallest studies with which the goals of a manifest can be shown to be met.
struct GoalPlans {
  const study::Study& study;
  std::vector<PlannedStudy> smallest;
};

std::string smallest_headline(const GoalPlans& plans) {
  if (plans.smallest.empty()) return "no study of up to 10⁹ trials can meet the goal";
  const goal::Needs& first = plans.smallest.front();
  const bool on_machines = plans.study.machines > 0;
  return fmt::format("{} can be met from {} {} on, if no move misses {}",
                     plans.study.goals.size() > 1 ? "the goals" : "the goal",
                     on_machines ? first.machines : first.trials, on_machines ? "machines" : "trials",
                     plans.study.goals.size() > 1 ? "them" : "it");
}

/// Sentence about the worlds (draws of the values that all machines share), settings (conditions at ages) and
/// design points to which the numbers refer.
std::string extent_sentence(const GoalPlans& plans) {
  std::string lines;
  if (plans.study.worlds > 0)
    lines += fmt::format("in all {} worlds together, each with as many as the others\n", plans.study.worlds);
  if (!plans.study.settings.empty())
    lines += fmt::format("under the conditions {} together, each with as many trials as the others\n",
                         fmt::join(study::labels_of(plans.study.settings), ", "));
  if (const std::size_t points = plans.study.points.labels.size(); points > 1)
    lines += fmt::format("at the best of the {} points\n", points);
  return lines +
         "Moves that miss it take more: 'zerocount plan PILOT' says how many, from the results of a small "
         "study";
}

document::AnswerDescription<GoalPlans> goal_answer() {
  document::AnswerDescription<GoalPlans> answer{
      {.name = "plan-goal",
       .meaning = "the smallest studies that can meet the goal of a manifest",
       .csv_table = "plans"},
      {}};
  answer.items.headline(smallest_headline)
      .value(everywhere("goal", "goal", "the goal in words"),
             [](const GoalPlans& plans) { return goal::claim_sentence(goal::question_of(plans.study)); })
      .value(in_data("worlds", "worlds; 0 without worlds"),
             [](const GoalPlans& plans) { return plans.study.worlds; })
      .table(everywhere("plans", "the smallest studies with which it can be met",
                        "studies, if no move misses the goal"),
             study_columns(), &GoalPlans::smallest)
      .sentence(extent_sentence);
  return answer;
}

/// Verdict on the goal from the results of a pilot study, and the studies that would decide it.
struct Pilot {
  const summary::StudySummary& summary;
  summary::JudgedPoint judged;
  /// Sizes of studies that decide the goal, if they are a choice between machines and trials on each;
  /// otherwise empty.
  std::vector<PlannedStudy> studies{};
};

document::AnswerDescription<Pilot> pilot_answer() {
  document::AnswerDescription<Pilot> answer{
      {.name = "plan-pilot", .meaning = "the study that decides the goal, by the results of a small one"},
      {}};
  document::Item studies =
      everywhere("studies", "studies that decide it", "studies that decide it; of goals on machines");
  studies.optional = true;
  answer.items.headline([](const Pilot& p) { return summary::judgement_headline(p.summary, p.judged); })
      .value(everywhere("goal", "goal", "the goal in words"),
             [](const Pilot& p) { return goal::claim_sentence(p.summary.question); })
      .value(with_words(in_data("status", "verdict on the goal"), goal::status_words()),
             [](const Pilot& p) { return goal::text_of(p.judged.verdict.status); })
      .sentence([](const Pilot& p) { return summary::judgement_details(p.summary, p.judged); })
      .sentence([](const Pilot& p) { return p.judged.needs ? "" : "  decided by these trials"; })
      .object(in_data("needed", "study that would decide the goal"), goal::needs_description(),
              [](const Pilot& p) { return goal::practicable(p.judged.needs); })
      .value(in_data("probability", "probability with which it decides", "1"),
             [](const Pilot&) { return goal::probability_of_needs; })
      .table(std::move(studies), study_columns(), &Pilot::studies);
  return answer;
}

/// Goals of the study, each with the number of a trial's moves that it judges.
std::vector<goal::AskedGoal> asked_goals(const study::Study& study) {
  std::vector<goal::AskedGoal> asked;
  const std::vector<measures::MoveCriterion> counted = measures::move_criteria_of(study);
  for (std::size_t i = 0; i < study.goals.size(); ++i)
    asked.push_back({study.goals[i], measures::asked_moves(counted[i], study.moves)});
  return asked;
}

document::Answer plan_of_manifest(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const study::Study study = commands::load_study(path, arguments);
  goal::require_claim(study, path, other_plans);
  const goal::StudyShape shape{study.machines > 0, study.worlds, study.settings.total()};
  const auto smallest = goal::smallest_studies(asked_goals(study), shape, study.points.labels.size());
  return goal_answer().of({study, with_times(smallest, study)});
}

document::Answer plan_of_pilot(const std::string& path) {
  const study::Study study = commands::described_study(path);
  const auto [summary, chosen, measures] = summary::summarise_chosen(path);
  if (!summary.question.goal()) goal::require_claim({}, path, other_plans);
  Pilot pilot{summary, summary::judge_point(summary, chosen), {}};
  if (pilot.judged.needs && study.machines > 0 && is_on_machines(study)) {
    pilot.studies = with_times(
        goal::deciding_studies(summary.question, summary.points[static_cast<std::size_t>(chosen.point)],
                               static_cast<std::size_t>(chosen.chosen_from)),
        study);
  }
  return pilot_answer().of(pilot);
}

}  // namespace

document::Answer goal_plan(const command_line::Arguments& arguments) {
  if (!commands::is_results_file(arguments.operands()[0])) return plan_of_manifest(arguments);
  if (arguments.has("set")) arguments.refuse("option '--set' needs a MANIFEST");
  return plan_of_pilot(arguments.operands()[0]);
}

std::vector<document::AnswerType> goal_plan_types() {
  return {goal_answer().complete_type(), pilot_answer().complete_type()};
}

}  // namespace zerocount::design_commands
