#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using text::short_number;
using tuning::Proof;
using tuning::Refusal;
using tuning::TuneAnswer;

std::string unproven_headline(const TuneAnswer& answer) {
  return answer.status == goal::Status::undecided
             ? fmt::format(
                   "undecided: of {} points that were tried some keep the margins, but the search lost them "
                   "to faster ones that do not; a larger --budget may find them",
                   answer.searched.examined)
         : !answer.unfound.refusal.empty()
             ? fmt::format("unreachable in these ranges: none of {} points that were tried is allowed: {}",
                           answer.searched.examined, answer.unfound.refusal)
             : fmt::format("unreachable in these ranges: none of {} points that were tried keeps the margins",
                           answer.searched.examined);
}

/// Text of the tuned values: "controller.ki = 5000, controller.kp = 0".
std::string tuned_text(const Tuning& tuning) {
  return values_text(named(tuning.answer.free, tuning.answer.tuned.values));
}

/// Worst goal of a verdict, with the setting (condition at an age) in which it is worst.
tuning::ClaimPlace worst_claim(const goal::Verdict& verdict) {
  return {verdict.goal, verdict.setting};
}

/// First line for a goal that is met: "met: all goals are met by controller.ki = 5000, least 'small' under
/// condition loaded".
std::string met_headline(const Tuning& tuning) {
  const goal::Verdict& verdict = tuning.answer.proof->verdict;
  const std::string least = claim_text(tuning.study, worst_claim(verdict));
  const std::vector<study::Goal>& goals = tuning.study.goals;
  const std::string met =
      goals.size() > 1 ? "all goals are" : "the goal" + goal::of_mass(goals.front()) + " is";
  return fmt::format("met: {} met by {}{}", met, tuned_text(tuning), least.empty() ? "" : ", least" + least);
}

/// Text for a goal that is missed: "at the best values found, controller.ki = 5000, 28.2 % of the moves meet
/// the goal, and at least 47.4 % are wanted".
std::string missed_by(const Tuning& tuning) {
  if (!tuning.answer.proof->keeps_margins)
    return fmt::format(
        "at the best values found, {}, machines of the proof slide, and their loop does not keep the margins "
        "while it slides",
        tuned_text(tuning));
  const study::Goal& goal = worst_goal(tuning);
  const goal::Verdict& verdict = tuning.answer.proof->verdict;
  return fmt::format("at the best values found, {}, {:.4g} % of the {}, and at least {:g} % are wanted",
                     tuned_text(tuning), 100.0 * goal::judged_rate(goal, verdict).value,
                     rated_words(tuning.study, tuning::claim_at(tuning.study, worst_claim(verdict))),
                     100.0 * study::demanded_proportion(goal));
}

/// Reason why a search whose best values miss the goal does not show that the goal is out of reach.
std::string why_undecided(const tuning::Searched& searched) {
  const tuning::Landscape& landscape = searched.landscape;
  if (landscape.points == 0) return "the file does not hold the search that found the values";
  if (!landscape.leads())
    return fmt::format(
        "at {} of {} points that were tried hardly any move meets the goal, so that good values in a narrow "
        "range between them would not be seen",
        landscape.points - landscape.telling, landscape.points);
  return searched.result.approaching ? "the effort ended while the search still came nearer to the goal"
                                     : "not all values that may meet the goal were tried on fresh machines";
}

std::vector<std::string> edges_in(const Tuning& tuning) {
  return tuning::edges_of(tuning.answer.free, tuning.answer.tuned.values);
}

std::vector<Refusal> refusals_of(const Tuning& tuning) {
  return tuning::refusals_of(tuning.answer.moves(), tuning.answer.tuned.margins, tuning.study);
}

/// Proof of the tuning; an empty object if nothing was proven.
const Proof& proof_in(const Tuning& tuning) {
  static const Proof none{};
  return tuning.answer.proof ? *tuning.answer.proof : none;
}

/// Sentences about the limits of the proof: what the moves of one machine cannot show, and the size of a
/// study that would decide the goal. Empty without a proof.
std::string lacking_sentence(const Tuning& tuning) {
  if (!tuning.answer.proof) return "";
  const Proof& proof = *tuning.answer.proof;
  const study::Study& study = proof.study;
  const study::Goal& goal = study.goals[proof.verdict.goal];
  std::string lines;
  if (goal.machines) {
    const std::int64_t trials = study::draw_count(study) / study.machines;
    const measures::MoveCriterion asked = measures::move_criteria_of(tuning.study)[proof.verdict.goal];
    lines = goal::one_machine_text(
        goal, {study.machines, trials, trials * measures::asked_moves(asked, study.moves)}, proof.verdict);
  }
  return proof.needs ? lines + goal::needs_sentence(goal, *proof.needs, study.machines > 0) : lines;
}

/// Sentence with the time after which the wanted proportion of moves stays within the band. Empty if the goal
/// is met.
std::string late_sentence(const Tuning& tuning) {
  if (!tuning.answer.proof || tuning.answer.is_met() || !tuning::is_of_settling(tuning.study)) return "";
  const double limit = tuning.answer.proof->late_limit;
  return fmt::format("time until {:g} % of the moves stay within the {}: {}",
                     100.0 * worst_goal(tuning).moves, worst_goal(tuning).tolerance ? "tolerance" : "band",
                     std::isfinite(limit) ? short_number(limit) + " s" : "not within the hold");
}

Description<goal::Verdict> worlds_of_proof() {
  Description<goal::Verdict> worlds;
  for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided}) {
    const std::string word(goal::text_of(status));
    worlds.value(
        everywhere(word, word, "worlds in which the goal is " + word),
        [status](const goal::Verdict& verdict) { return goal::worlds_that(status, verdict).size(); });
  }
  return worlds;
}

Description<Tuning> proof_description() {
  return Description<Tuning>()
      .include(named_claim_columns("worst goal", "under"),
               [](const Tuning& t) { return tuning::names_of(t.study, worst_claim(proof_in(t).verdict)); })
      .value({.key = "status",
              .meaning = "verdict on the goal by the trials of the proof, which is that of judge",
              .shown = document::Visibility::in_data,
              .words = goal::status_words()},
             [](const Tuning& t) { return goal::text_of(proof_in(t).verdict.status); })
      .value(proportion("rate", "moves that meet it",
                        "proportion of moves that meet the goal, with one-sided bounds"),
             [](const Tuning& t) { return goal::bounded(proof_in(t).verdict.moves); })
      .value(
          proportion("machines_low", "machines that meet it, at least",
                     "lower bound of the proportion of machines that meet the goal, if it is about machines"),
          [](const Tuning& t) {
            return worst_goal(t).machines ? std::optional(proof_in(t).verdict.machines.low) : std::nullopt;
          })
      .value(everywhere("machine_count", "machines", "number of machines; 0 without machines"),
             [](const Tuning& t) { return proof_in(t).study.machines; })
      .value(everywhere("trials", "trials", "trials"),
             [](const Tuning& t) { return proof_in(t).study.trials; })
      .value(in_data("seed", "seed of the proof"), [](const Tuning& t) { return proof_in(t).study.seed; })
      .value(everywhere("attempts", "attempts", "candidates or sizes that were proven"),
             [](const Tuning& t) { return proof_in(t).attempts; })
      .value(everywhere("criterion", "minimised", "quantity that is minimised; unknown for never"),
             [](const Tuning& t) { return proof_in(t).criterion; })
      .shown_as([](const Tuning& t) {
        const double value = proof_in(t).criterion;
        return fmt::format(
            "{}{}: {}", criterion_title(t.study),
            tuning::has_named_claims(t.study) ? ", the largest of all goals and conditions" : "",
            std::isfinite(value) ? short_number(value) : "not within the hold");
      })
      .object(optional(everywhere("worlds", "worlds of the worst goal", "verdicts by world")),
              worlds_of_proof(), [](const Tuning& t) {
                const goal::Verdict& verdict = proof_in(t).verdict;
                return verdict.worlds.empty() ? nullptr : &verdict;
              });
}

using document::Notation;
using summary::MoveBehaviour;
using summary::UpperValues;

using Moves = const MoveBehaviour&;

/// Adds two columns, the 95 % quantile ("<key>_p95") and the maximum ("<key>_max") of a quantity over the
/// moves. A column without a heading is in data only.
void add_upper(Description<MoveBehaviour>& columns, const document::Item& of,
               UpperValues MoveBehaviour::*values, const std::string& p95_heading,
               const std::string& max_heading) {
  const auto item = [&of](const std::string& key, const std::string& heading, const std::string& meaning) {
    document::Item one = of;
    one.key = of.key + key;
    one.heading = heading;
    one.meaning = meaning;
    return one;
  };
  columns
      .value(item("_p95", p95_heading, of.meaning + ", which 95 % of the moves do not exceed"),
             [values](Moves row) { return (row.*values).p95; })
      .value(item("_max", max_heading, "largest " + of.meaning),
             [values](Moves row) { return (row.*values).max; });
}

std::optional<double> of_rest(Moves row, double summary::RestTorque::*value) {
  return row.rest ? std::optional((*row.rest).*value) : std::nullopt;
}

Description<MoveBehaviour> behaviour_columns() {
  Description<MoveBehaviour> columns;
  columns
      .value(optional(everywhere("goal", "goal", "name of the goal that asks the moves")),
             &MoveBehaviour::goal)
      .value(optional(everywhere("condition", "condition", "the condition under which the machines run")),
             &MoveBehaviour::setting)
      .value(everywhere("moves", "moves", "moves of these trials"), &MoveBehaviour::moves);
  add_upper(columns, {.key = "overshoot", .meaning = "excursion beyond the target", .unit = "count"},
            &MoveBehaviour::overshoot, "overshoot p95 (counts)", "");
  add_upper(columns,
            {.key = "overshoot_length", .meaning = "excursion beyond the target, rad (m on a linear axis)"},
            &MoveBehaviour::overshoot_length, "(rad, m)", "");
  add_upper(columns,
            {.key = "overshoot_of_step",
             .meaning = "excursion beyond the target as a proportion of the move's step",
             .unit = "1",
             .notation = Notation::percent},
            &MoveBehaviour::overshoot_of_step, "(of the step)", "");
  add_upper(columns, {.key = "peak_torque", .meaning = "absolute torque decided, N m (N on a linear axis)"},
            &MoveBehaviour::peak_torque, "", "peak torque (N m, N)");
  add_upper(columns,
            {.key = "peak_of_range",
             .meaning = "absolute torque as a proportion of the converter's largest",
             .unit = "1",
             .notation = Notation::percent},
            &MoveBehaviour::peak_of_range, "", "of the range");
  columns
      .value(proportion("saturated", "moves that saturate",
                        "moves in which the converter clipped, as a proportion"),
             &MoveBehaviour::saturated)
      .value(everywhere("rest_torque_rms", "rms torque at rest",
                        "rms of the torque at rest, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::rms); })
      .value(everywhere("rest_torque_changes", "of its changes",
                        "rms of its changes from sample to sample, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::changes); })
      .value(in_data("rest_torque_changes_of_range",
                     "the same as a proportion of the converter's largest torque", "1"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::of_range); });
  return columns;
}

}  // namespace

std::string tune_headline(const Tuning& tuning) {
  if (!tuning.answer.proof) return unproven_headline(tuning.answer);
  switch (tuning.answer.status) {
    case goal::Status::met:
      return met_headline(tuning);
    case goal::Status::missed:
      return "unreachable in these ranges: " + missed_by(tuning);
    case goal::Status::undecided:
      break;
  }
  if (tuning.answer.proof->fails())
    return fmt::format("undecided: {}; {}; a larger --budget may find better ones",
                       why_undecided(tuning.answer.searched), missed_by(tuning));
  return fmt::format(
      "undecided: the trials of the proof do not decide whether the best values found, {}, meet the goal",
      tuned_text(tuning));
}

std::string page_headline(const Tuning& tuning) {
  if (!tuning.answer.is_met()) return tune_headline(tuning);
  const study::Study& proof = tuning.answer.proof->study;
  return fmt::format("met by the tuned values, proven on {} that the search never saw",
                     proof.machines > 0 ? fmt::format("{} machines", proof.machines)
                                        : fmt::format("{} trials", proof.trials));
}

void add_proof_facts(Items& items) {
  items
      .value(everywhere("obstacles", "in the way", "what theory says of a goal that is not met"),
             [](const Tuning& t) { return proof_in(t).obstacles; })
      .shown_where([](const Tuning& t) { return !proof_in(t).obstacles.empty(); })
      .object(everywhere("proof", "proof, on machines that the search never saw",
                         "trials of the tuned values on machines that the search never saw"),
              proof_description(), [](const Tuning& t) { return t.answer.proof ? &t : nullptr; })
      .object(in_data("needed", "study that would decide the goal"), goal::needs_description(),
              [](const Tuning& t) { return goal::practicable(proof_in(t).needs); })
      .sentence(lacking_sentence)
      .sentence(late_sentence)
      .value(in_data("at_edges", "free parameters at an end of their range"), edges_in)
      .sentence([](const Tuning& t) { return fmt::format("{}", fmt::join(edges_in(t), "\n")); })
      .object(in_data("worst", "the worst machine of the proof"), worst_description(),
              [](const Tuning& t) { return proof_in(t).worst; })
      .sentence([](const Tuning& t) {
        const std::optional<tuning::WorstMachine>& worst = proof_in(t).worst;
        return worst ? "worst machine: " + worst_machine_text(*worst, t.study) : std::string();
      });
}

void add_proof(Items& items) {
  items.table({.key = "claims",
               .heading = "each goal under each condition and at each age, by the proof",
               .meaning = "each goal under each condition, by the proof; the bounds allow for its attempts"},
              summary::cell_description({}, summary::CellsBy::claim),
              [](const Tuning& t) { return proof_in(t).claims; });
  add_proof_facts(items);
}

std::string sanity_line(const Tuning& tuning) {
  const tuning::TuneAnswer& answer = tuning.answer;
  const std::vector<Refusal> refusals = refusals_of(tuning);
  if (answer.moves().empty() && refusals.empty()) return "";
  std::vector<std::string> texts;
  for (const Refusal& one : refusals)
    texts.push_back(fmt::format("{}; to exclude it add {}", one.text, one.remedy));
  const std::string values = values_text(named(answer.free, answer.tuned.values));
  if (texts.empty()) return fmt::format("before the proof: nothing is found to object to in {}", values);
  return fmt::format("before the proof: a drive engineer would refuse this of {}: {}", values,
                     fmt::join(texts, "; "));
}

void add_refusals(Items& items) {
  items.table(
      {.key = "refusals",
       .heading = "a drive engineer would refuse this",
       .meaning = "what a drive engineer would refuse of the tuned values, although they may meet the goal"},
      Description<Refusal>()
          .value({.key = "finding",
                  .meaning = "what an engineer would refuse",
                  .words = {"overshoot", "saturation", "torque noise", "phase margin"}},
                 &Refusal::finding)
          .value(everywhere("text", "finding", "the finding in a sentence"), &Refusal::text)
          .value(in_data("value",
                         "proportion of the step, of the moves, of the converter's largest torque; degrees"),
                 &Refusal::value)
          .value(in_data("passes", "the value that passes"), &Refusal::largest)
          .value(everywhere("remedy", "to exclude it add", "what excludes it, as it stands in a manifest"),
                 &Refusal::remedy),
      refusals_of);
}

void add_behaviour(Description<Tuning>& items) {
  items.table(
      {.key = "behaviour",
       .heading = "what the moves of the proof do",
       .meaning = "what the moves of the proof do, by goal and condition; "
                  "the torque at rest is of machines of the search where the study does not measure it"},
      behaviour_columns(),
      [](const Tuning& t) -> const std::vector<MoveBehaviour>& { return t.answer.moves(); });
}

}  // namespace zerocount::design_commands
