#include "runners/design_commands/goal_plan.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/summary/judged_point.hpp"
#include "runners/commands/study_argument.hpp"

namespace zerocount::design_commands {
namespace {

using document::in_data;
using document::Shown;
using document::with_words;

constexpr std::string_view other_plans = ", or --success, --halfwidth or --margin";

/// The smallest studies that can meet the goal of a manifest.
struct GoalPlans {
  const study::Study& study;
  std::vector<goal::Needs> smallest;
};

std::string smallest_headline(const GoalPlans& plans) {
  if (plans.smallest.empty()) return "no study of up to 10⁹ trials can meet the goal";
  const goal::Needs& first = plans.smallest.front();
  const bool on_rigs = plans.study.rigs > 0;
  return fmt::format("the goal can be met from {} {} on, if no move misses it",
                     on_rigs ? first.rigs : first.trials, on_rigs ? "rigs" : "trials");
}

std::string extent_sentence(const GoalPlans& plans) {
  std::string lines;
  if (plans.study.worlds > 0)
    lines += fmt::format("in all {} worlds together, each with as many as the others\n", plans.study.worlds);
  if (const std::size_t points = plans.study.points.labels.size(); points > 1)
    lines += fmt::format("at the best of the {} points\n", points);
  return lines +
         "Moves that miss it take more: 'zerocount plan PILOT' says how many, from the results of a small "
         "study";
}

/// The studies for people, who see those on rigs as a table.
std::vector<goal::Needs> smallest_on_rigs(const GoalPlans& plans) {
  return plans.study.rigs > 0 ? plans.smallest : std::vector<goal::Needs>();
}

document::Description<goal::Needs> study_columns() {
  return document::Description<goal::Needs>()
      .value({.heading = "rigs"}, &goal::Needs::rigs)
      .value({.heading = "trials on each"}, [](const goal::Needs& one) { return one.trials / one.rigs; })
      .value({.heading = "trials"}, &goal::Needs::trials);
}

document::AnswerDescription<GoalPlans> goal_answer() {
  document::AnswerDescription<GoalPlans> answer{
      {.name = "plan-goal", .meaning = "the smallest studies that can meet the goal of a manifest"}, {}};
  answer.items.headline(smallest_headline)
      .value({.key = "goal", .heading = "goal", .meaning = "the goal in words"},
             [](const GoalPlans& plans) { return goal::goal_sentence(*study::first_goal(plans.study)); })
      .value(in_data("worlds", "worlds; 0 without worlds"),
             [](const GoalPlans& plans) { return plans.study.worlds; })
      .table(in_data("plans", "studies, if no move misses the goal"), goal::needs_description(),
             &GoalPlans::smallest)
      .table({.heading = "the fewest rigs with which it can be met", .shown = Shown::to_people},
             study_columns(), smallest_on_rigs)
      .sentence(extent_sentence);
  return answer;
}

/// The judgement of the results of a pilot.
struct Pilot {
  const summary::StudySummary& summary;
  summary::JudgedPoint judged;
};

document::AnswerDescription<Pilot> pilot_answer() {
  document::AnswerDescription<Pilot> answer{
      {.name = "plan-pilot", .meaning = "the study that decides the goal, by the results of a small one"},
      {}};
  answer.items.headline([](const Pilot& p) { return summary::judgement_headline(p.summary, p.judged); })
      .value({.key = "goal", .heading = "goal", .meaning = "the goal in words"},
             [](const Pilot& p) { return goal::claim_sentence(p.summary.question); })
      .value(with_words(in_data("status", "verdict on the goal"), goal::status_words()),
             [](const Pilot& p) { return goal::text_of(p.judged.verdict.status); })
      .sentence([](const Pilot& p) { return summary::judgement_details(p.summary, p.judged); })
      .sentence([](const Pilot& p) { return p.judged.needs ? "" : "  decided by these trials"; })
      .object(in_data("needed", "study that would decide the goal"), goal::needs_description(),
              [](const Pilot& p) { return goal::practicable(p.judged.needs); })
      .value(in_data("probability", "probability with which it decides", "1"),
             [](const Pilot&) { return goal::probability_of_needs; });
  return answer;
}

/// Number of moves of a trial that the goal is about.
std::int64_t asked_moves(const study::Study& study) {
  return measures::asked_moves(measures::asked_of_moves(study).front(), study.moves);
}

document::Answer plan_of_manifest(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const study::Study study = commands::load_study(path, arguments);
  study::refuse_conditions(study, "zerocount plan");
  goal::require_claim(study, path, other_plans);
  goal::require_one_goal(study, path);
  return goal_answer().of(
      {study, goal::smallest_studies(*study::first_goal(study), study.rigs > 0, asked_moves(study),
                                     study.points.labels.size(), study.worlds)});
}

document::Answer plan_of_pilot(const std::string& path) {
  study::refuse_conditions(commands::described_study(path), "zerocount plan");
  const summary::StudySummary summary = summary::summarise_file(path);
  if (!summary.question.claim()) goal::require_claim({}, path, other_plans);
  return pilot_answer().of({summary, summary::judge_point(summary, summary::choose_point(summary))});
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
