#include "runners/design_commands/tune_answer.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "runners/design_commands/limits_command.hpp"
#include "runners/design_commands/tune_figures.hpp"
#include "runners/design_commands/worst_command.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using document::Shown;
using document::with_words;
using text::short_number;
using tuning::Alternative;
using tuning::NearestPoint;
using tuning::Proof;
using tuning::SmallestMargins;
using tuning::TriedPoint;
using tuning::TuneAnswer;
using tuning::TuneBudget;

using Of = const Tuning&;

constexpr goal::Status all_statuses[] = {goal::Status::met, goal::Status::missed, goal::Status::undecided};

NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values) {
  NamedValues named;
  for (std::size_t i = 0; i < values.size(); ++i) named.emplace_back(free[i].name, values[i]);
  return named;
}

std::string_view tune_status(goal::Status status) {
  return status == goal::Status::missed ? "unreachable" : goal::text_of(status);
}

std::vector<std::string> tune_statuses() {
  std::vector<std::string> words;
  for (const goal::Status status : all_statuses) words.emplace_back(tune_status(status));
  return words;
}

/// The worst goal of a verdict, and its worst condition.
tuning::ClaimPlace worst_claim(const goal::Verdict& verdict) {
  return {verdict.goal, verdict.condition};
}

/// The goal of which most of the answer is: the worst by the proof.
const study::Goal& worst_goal(Of tuning) {
  const std::optional<Proof>& proof = tuning.answer.proof;
  return tuning.study.goals[proof ? proof->verdict.goal : 0];
}

// The margins.

struct NamedMargin {
  std::string_view name;
  std::string_view unit;
  double found;
  std::optional<double> wanted;
};

std::vector<NamedMargin> margins_beside(const SmallestMargins& found, const study::LoopMargins& wanted) {
  return {{"gain", "dB", found.gain, wanted.gain},
          {"phase", "degrees", found.phase, wanted.phase},
          {"delay", "samples", found.delay, wanted.delay}};
}

/// "gain margin 7.2 dB (at least 6 wanted), phase margin …".
std::string margins_text(const SmallestMargins& found, const study::LoopMargins& wanted) {
  constexpr double longest_delay = 10.0;
  std::vector<std::string> texts;
  for (const NamedMargin& one : margins_beside(found, wanted)) {
    const bool is_longest = one.name == "delay" && one.found >= longest_delay;
    texts.push_back(fmt::format(
        "{} margin {} {}{} ({})", one.name, std::isfinite(one.found) ? short_number(one.found) : "∞",
        one.unit, is_longest ? " or more" : "",
        one.wanted ? fmt::format("at least {:g} wanted", *one.wanted) : std::string("none wanted")));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// The loops that were examined.
std::string_view loops_text(const SmallestMargins& margins) {
  if (!margins.sliding) return " before they slide";
  return margins.before_sliding ? " before they slide and while they slide" : " while they slide";
}

std::string margins_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known";
  if (!answer.margins) return "";
  const study::LoopMargins& wanted = tuning.study.tuning->margins;
  std::string text =
      fmt::format("smallest margins of {} machines{}: {}{}", answer.margins->machines,
                  loops_text(*answer.margins), margins_text(*answer.margins, wanted),
                  answer.margins->stable ? "" : "\n  the linear loop of a machine is unstable");
  for (std::size_t condition = 0; condition < answer.margins->conditions.size(); ++condition) {
    text += fmt::format("\n  under condition {}: {}", tuning.study.conditions[condition],
                        margins_text(answer.margins->conditions[condition], wanted));
  }
  return text;
}

Description<SmallestMargins> margins_description() {
  return Description<SmallestMargins>()
      .value(in_data("gain", "gain margin; unknown where no loop has a limit", "dB"), &SmallestMargins::gain)
      .value(in_data("phase", "phase margin; unknown where no loop has a limit", "degrees"),
             &SmallestMargins::phase)
      .value(in_data("delay", "samples of delay until a loop is unstable; 10 means 10 or more", "samples"),
             &SmallestMargins::delay)
      .value(in_data("stable", "whether no loop is unstable"), &SmallestMargins::stable)
      .value(in_data("machines", "machines that were examined"), &SmallestMargins::machines);
}

/// The margins that the nearest point lacks, and by how much.
std::vector<NamedMargin> lacking(const NearestPoint& nearest, const study::LoopMargins& wanted) {
  if (!nearest.margins.stable) return {};
  std::vector<NamedMargin> lacking = margins_beside(nearest.margins, wanted);
  std::erase_if(lacking, [](const NamedMargin& one) { return !one.wanted || one.found >= *one.wanted; });
  return lacking;
}

std::string nearest_sentence(Of tuning) {
  if (!tuning.answer.nearest) return "";
  const NearestPoint& nearest = *tuning.answer.nearest;
  const std::string at = values_text(named(tuning.answer.free, nearest.values));
  if (!nearest.margins.stable) {
    return fmt::format(
        "the loop of a machine is unstable at all of them; nearest, at {}, by {} of gain", at,
        std::isfinite(nearest.margins.gain) ? short_number(nearest.margins.gain) + " dB" : "any factor");
  }
  const study::LoopMargins& wanted = tuning.study.tuning->margins;
  std::string lines = fmt::format("nearest: {}, with {}\n", at, margins_text(nearest.margins, wanted));
  for (const NamedMargin& one : lacking(nearest, wanted))
    lines += fmt::format("  its {} margin is {} {} too small\n", one.name,
                         short_number(*one.wanted - one.found), one.unit);
  return lines;
}

struct NearestReading {
  const NearestPoint& nearest;
  Of tuning;
};

Description<NearestReading> nearest_description() {
  using Reading = const NearestReading&;
  return Description<NearestReading>()
      .value(in_data("gains", "its values, by parameter"),
             [](Reading r) { return named(r.tuning.answer.free, r.nearest.values); })
      .object(in_data("margins", "its smallest margins"), margins_description(),
              [](Reading r) { return r.nearest.margins; })
      .value(in_data("lacking", "by how much margins are too small: dB, degrees, samples"), [](Reading r) {
        NamedValues amounts;
        for (const NamedMargin& one : lacking(r.nearest, r.tuning.study.tuning->margins))
          amounts.emplace_back(one.name, *one.wanted - one.found);
        return amounts;
      });
}

// What is proven.

std::string unproven_headline(const TuneAnswer& answer) {
  return answer.status == goal::Status::undecided
             ? fmt::format(
                   "undecided: of {} points that were tried some keep the margins, but the search lost them "
                   "to faster ones that do not; a larger --budget may find them",
                   answer.examined)
             : fmt::format("unreachable in these ranges: none of {} points that were tried keeps the margins",
                           answer.examined);
}

/// "met: all 2 goals are met by these values under each of 2 conditions, 'small' under loaded by the least".
std::string met_headline(Of tuning) {
  const study::Study& study = tuning.study;
  std::string text = study.goals.size() > 1
                         ? fmt::format("met: all {} goals are met by these values", study.goals.size())
                         : std::string("met: the goal is met by these values");
  if (study.goals.size() * static_cast<std::size_t>(study::condition_count(study)) < 2) return text;
  const tuning::ClaimPlace worst = worst_claim(tuning.answer.proof->verdict);
  if (study.conditions.size() > 1)
    text += fmt::format(" under each of {} conditions", study.conditions.size());
  text += study.goals.size() > 1 ? fmt::format(", '{}'", *tuning::goal_name(study, worst)) : ", that";
  return text + study::condition_text(study, static_cast<std::int64_t>(worst.condition)) + " by the least";
}

std::string tune_headline(Of tuning) {
  if (!tuning.answer.proof) return unproven_headline(tuning.answer);
  const std::optional<double> machines = worst_goal(tuning).machines;
  const goal::Verdict& verdict = tuning.answer.proof->verdict;
  switch (tuning.answer.status) {
    case goal::Status::met:
      return met_headline(tuning);
    case goal::Status::missed:
      return fmt::format(
          "unreachable in these ranges: at the best values found {:.4g} % of the {}, and at least {:g} % are "
          "wanted",
          100.0 * (machines ? verdict.machines.value : verdict.moves.value),
          rated_words(tuning.study, tuning::claim_at(tuning.study, worst_claim(verdict))),
          100.0 * machines.value_or(worst_goal(tuning).moves));
    case goal::Status::undecided:
      break;
  }
  return "undecided: the trials of the proof do not decide whether the best values found meet the goal";
}

struct GainRow {
  const study::FreeParameter& free;
  double value;
};

std::vector<GainRow> gain_rows(Of tuning) {
  std::vector<GainRow> rows;
  for (std::size_t i = 0; i < tuning.answer.gains.size(); ++i)
    rows.push_back({tuning.answer.free[i], tuning.answer.gains[i]});
  return rows;
}

Description<GainRow> gain_columns() {
  using Row = const GainRow&;
  return Description<GainRow>()
      .value({.heading = "parameter"}, [](Row row) { return row.free.name; })
      .value({.heading = "tuned"}, &GainRow::value)
      .value({.heading = "unit"}, [](Row row) { return row.free.unit; })
      .value({.heading = "range"}, [](Row row) {
        return fmt::format("{} … {}", short_number(row.free.low), short_number(row.free.high));
      });
}

/// kp, ki and kd in the other system of units, of a PID.
std::string other_units_sentence(Of tuning) {
  if (!tuning.answer.proof) return "";
  const trial::TrialParameters p = study::study_trial(tuning.answer.proof->study, 0, 0).parameters;
  if (p.controller.blocks.structure != loop::ControlStructure::pid || p.controller.user.plugin) return "";
  const auto text = [](const char* system, double kp, double ki, double kd) {
    return fmt::format("  in {}: kp {}, ki {}, kd {}", system, short_number(kp), short_number(ki),
                       short_number(kd));
  };
  if (tuning.study.units.gains == parameters::GainUnits::si)
    return text("counts and samples", p.controller.kp, p.controller.ki, p.controller.kd);
  const theory::AnalogueGains analogue = theory::analogue_gains(p.controller, p.encoder);
  return text("SI units", analogue.kp, analogue.ki, analogue.kd);
}

std::string worlds_line(const goal::Verdict& verdict) {
  return fmt::format(
      "by world: met in {}, missed in {}, undecided in {} ('zerocount summary' of the proof says what the "
      "bad ones have in common)\n",
      goal::worlds_that(goal::Status::met, verdict).size(),
      goal::worlds_that(goal::Status::missed, verdict).size(),
      goal::worlds_that(goal::Status::undecided, verdict).size());
}

std::string proof_sentence(Of tuning) {
  if (!tuning.answer.proof) return "";
  const Proof& proof = *tuning.answer.proof;
  const study::Study& study = tuning.study;
  std::string lines = fmt::format(
      "proof: {} moves{} that the search never saw, of which {}{:.5g} % meet the goal, at least {:.5g} %\n",
      proof.study.trials * study.moves,
      study.rigs > 0 ? fmt::format(" on {} machines", proof.study.rigs) : std::string(),
      study.worlds > 0 ? fmt::format("in the worst of {} new worlds ", study.worlds) : std::string(),
      100.0 * proof.verdict.moves.value, 100.0 * proof.verdict.moves.low);
  if (tuning::has_named_claims(study)) {
    lines = fmt::format(
        "proof: {} moves{} that the search never saw; the worst{}: {}{:.5g} % of its moves meet it, at least "
        "{:.5g} %\n",
        proof.study.trials * study.moves,
        study.rigs > 0 ? fmt::format(" on {} machines", proof.study.rigs) : std::string(),
        tuning::text_of_claim(study, worst_claim(proof.verdict)),
        study.worlds > 0 ? fmt::format("in the worst of {} new worlds ", study.worlds) : std::string(),
        100.0 * proof.verdict.moves.value, 100.0 * proof.verdict.moves.low);
  }
  const study::Goal& goal = worst_goal(tuning);
  if (goal.machines) {
    lines += fmt::format("at least {:.5g} % of machines meet it in {:g} % of their moves\n",
                         100.0 * proof.verdict.machines.low, 100.0 * goal.moves);
    const std::int64_t trials = study::draw_count(proof.study) / proof.study.rigs;
    const measures::CountedGoal asked = measures::asked_of_moves(study)[proof.verdict.goal];
    lines += goal::one_machine_text(
        goal, {proof.study.rigs, trials, trials * measures::asked_moves(asked, study.moves)}, proof.verdict);
  }
  if (!proof.verdict.worlds.empty()) lines += worlds_line(proof.verdict);
  if (proof.attempts > 1)
    lines += fmt::format("it is attempt {}: the bounds allow for all of them\n", proof.attempts);
  if (proof.needs) lines += goal::needs_sentence(goal, *proof.needs, study.rigs > 0) + '\n';
  return lines;
}

/// A goal under a condition, by the proof.
struct ProvenClaimRow {
  std::optional<std::string> goal;
  std::optional<std::string> condition;
  const goal::Verdict& verdict;
  bool is_of_machines;
};

/// Every goal under every condition, where there are several.
std::vector<ProvenClaimRow> proven_claim_rows(Of tuning) {
  std::vector<ProvenClaimRow> rows;
  if (!tuning.answer.proof || !tuning::has_named_claims(tuning.study)) return rows;
  const goal::Verdict& whole = tuning.answer.proof->verdict;
  for (std::size_t goal = 0; goal < tuning.study.goals.size(); ++goal) {
    const goal::Verdict& of_goal = whole.goals.empty() ? whole : whole.goals[goal];
    const auto add = [&](const goal::Verdict& verdict, std::size_t condition) {
      const tuning::ClaimPlace place{goal, condition};
      rows.push_back({tuning::goal_name(tuning.study, place), tuning::condition_name(tuning.study, place),
                      verdict, tuning.study.goals[goal].machines.has_value()});
    };
    if (of_goal.conditions.empty()) add(of_goal, 0);
    for (std::size_t condition = 0; condition < of_goal.conditions.size(); ++condition)
      add(of_goal.conditions[condition], condition);
  }
  return rows;
}

/// The goal and the condition of a row that has only some.
template <class Row, class GoalOf, class ConditionOf>
void add_claim(Description<Row>& columns, const std::string& which, GoalOf goal, ConditionOf condition) {
  columns
      .value({.key = "goal",
              .heading = which + "goal",
              .meaning = "name of the " + which + "goal, of several",
              .optional = true},
             goal)
      .value({.key = "condition",
              .heading = which + "condition",
              .meaning = "name of the " + which + "condition, with conditions",
              .optional = true},
             condition);
}

Description<ProvenClaimRow> proven_claim_columns() {
  using Row = const ProvenClaimRow&;
  Description<ProvenClaimRow> columns;
  add_claim(columns, "", &ProvenClaimRow::goal, &ProvenClaimRow::condition);
  return columns
      .value({.key = "status",
              .heading = "verdict",
              .meaning = "verdict on the goal under the condition",
              .words = goal::status_words()},
             [](Row row) { return goal::text_of(row.verdict.status); })
      .value({.key = "rate",
              .heading = "moves that meet it",
              .meaning = "proportion of moves that meet the goal, with one-sided bounds",
              .unit = "1",
              .notation = Notation::percent},
             [](Row row) { return goal::bounded(row.verdict.moves); })
      .value({.key = "machines",
              .heading = "machines that meet it",
              .meaning = "proportion of machines that meet the goal, with one-sided bounds",
              .unit = "1",
              .notation = Notation::percent,
              .optional = true},
             [](Row row) {
               return row.is_of_machines ? std::optional(goal::bounded(row.verdict.machines)) : std::nullopt;
             });
}

std::string criterion_text(double value) {
  return std::isfinite(value) ? short_number(value) : "not within the hold";
}

/// "band_settling_time.p95 by the proof: 0.0385 s".
std::string criterion_sentence(Of tuning) {
  if (!tuning.answer.proof) return "";
  const study::Study& study = tuning.study;
  const bool is_proportion = tuning::is_proportion_of_allowed(study);
  const std::string unit = is_proportion ? "of the time that its goal allows"
                                         : tuning::criteria_of(study).front().measure->field.column.unit;
  const bool has_unit = std::isfinite(tuning.answer.criterion) && unit != "1" && !unit.empty();
  return fmt::format("{} by the proof{}{}: {}{}", study.tuning->minimise,
                     study.worlds > 0 ? ", of all worlds together" : "",
                     tuning::has_named_claims(study) ? ", the largest of all goals and conditions" : "",
                     criterion_text(tuning.answer.criterion), has_unit ? " " + unit : "");
}

/// The time after which the wanted proportion of moves are within the band for good.
std::string late_sentence(Of tuning) {
  if (!tuning.answer.proof || tuning.answer.status == goal::Status::met ||
      !tuning.study.tuning->minimise.starts_with("band_settling_time"))
    return "";
  const std::string moves =
      fmt::format("{:g} % of the moves{}{}", 100.0 * worst_goal(tuning).moves,
                  tuning::text_of_claim(tuning.study, worst_claim(tuning.answer.proof->verdict)),
                  tuning.study.worlds > 0 ? " of all worlds together" : "");
  if (!std::isfinite(tuning.answer.late_limit))
    return fmt::format("  fewer than {} are within the band for good at the end of the hold", moves);
  return fmt::format("  {} are within the band for good after {} s", moves,
                     short_number(tuning.answer.late_limit));
}

std::string edges_sentence(Of tuning) {
  std::string lines;
  for (const std::string& edge : tuning.answer.at_edges) lines += edge + ": values beyond may be better\n";
  return lines;
}

std::string worst_machine_sentence(Of tuning) {
  if (!tuning.answer.worst) return "";
  return "worst machine: " + worst_machine_text(*tuning.answer.worst, tuning.study);
}

std::string file_sentence(Of tuning) {
  if (tuning.answer.proof)
    return fmt::format("wrote {}: the proof, with the tuned manifest", tuning.output.string());
  return "no results file is written: there are no values to prove\n"
         "tune.margins: {gain: …, phase: …, delay: …} makes the margins smaller, or off";
}

Description<goal::Verdict> worlds_of_proof() {
  Description<goal::Verdict> worlds;
  for (const goal::Status status : all_statuses) {
    const std::string word(goal::text_of(status));
    worlds.value(
        {.key = word, .meaning = "worlds in which the goal is " + word},
        [status](const goal::Verdict& verdict) { return goal::worlds_that(status, verdict).size(); });
  }
  return worlds;
}

Description<Tuning> proof_description() {
  Description<Tuning> proof;
  const auto worst = [](Of t) { return worst_claim(t.answer.proof->verdict); };
  add_claim(
      proof, "worst ",
      [worst](Of t) {
        return tuning::has_named_claims(t.study) ? tuning::goal_name(t.study, worst(t)) : std::nullopt;
      },
      [worst](Of t) { return tuning::condition_name(t.study, worst(t)); });
  return proof
      .value(in_data("rate", "proportion of moves that meet the goal, with one-sided bounds", "1"),
             [](Of t) { return goal::bounded(t.answer.proof->verdict.moves); })
      .value(in_data("machines_low",
                     "lower bound of the proportion of machines that meet the goal, if it is about machines",
                     "1"),
             [](Of t) -> std::optional<double> {
               if (!worst_goal(t).machines) return {};
               return t.answer.proof->verdict.machines.low;
             })
      .value(in_data("rigs", "machines; 0 without rigs"), [](Of t) { return t.answer.proof->study.rigs; })
      .value(in_data("trials", "trials"), [](Of t) { return t.answer.proof->study.trials; })
      .value(in_data("seed", "seed of the proof"), [](Of t) { return t.answer.proof->study.seed; })
      .value(in_data("attempts", "candidates or sizes that were proven"),
             [](Of t) { return t.answer.proof->attempts; })
      .value(in_data("criterion", "quantity that is minimised; unknown for never"),
             [](Of t) { return t.answer.criterion; })
      .object({.key = "worlds", .meaning = "verdicts by world", .optional = true}, worlds_of_proof(),
              [](Of t) -> const goal::Verdict* {
                const goal::Verdict& verdict = t.answer.proof->verdict;
                return verdict.worlds.empty() ? nullptr : &verdict;
              });
}

void add_proven(Description<Tuning>& items) {
  items.headline(tune_headline)
      .value({.key = "goal", .heading = "goal", .meaning = "the goal in words"},
             [](Of t) { return goal::claim_sentence(goal::question_of(t.study)); })
      .value(with_words(in_data("status", "whether the goal is met; unreachable: not in the ranges"),
                        tune_statuses()),
             [](Of t) { return tune_status(t.answer.status); })
      .value(in_data("gains", "tuned values by parameter; none where no values keep the margins"),
             [](Of t) { return named(t.answer.free, t.answer.gains); })
      .table({.shown = Shown::to_people}, gain_columns(), gain_rows)
      .sentence(other_units_sentence)
      .sentence(nearest_sentence)
      .sentence(proof_sentence)
      .table({.key = "claims",
              .heading = "each goal under each condition, by the proof",
              .meaning = "verdicts on each goal under each condition, where there are several",
              .optional = true},
             proven_claim_columns(), proven_claim_rows)
      .object(in_data("proof", "trials of the tuned values on machines that the search never saw"),
              proof_description(), [](Of t) { return t.answer.proof ? &t : nullptr; })
      .object(in_data("needed", "study that would decide the goal"), goal::needs_description(),
              [](Of t) { return t.answer.proof ? goal::practicable(t.answer.proof->needs) : nullptr; })
      .sentence(criterion_sentence)
      .sentence(late_sentence)
      .value(in_data("at_edges", "free parameters at an end of their range"),
             [](Of t) { return t.answer.at_edges; })
      .sentence(edges_sentence)
      .object(in_data("worst", "the worst machine of the proof"), worst_description(),
              [](Of t) { return t.answer.worst; })
      .sentence(worst_machine_sentence)
      .object(in_data("nearest", "the point that comes nearest to the margins, where none keeps them"),
              nearest_description(),
              [](Of t) -> std::optional<NearestReading> {
                if (!t.answer.nearest) return {};
                return NearestReading{*t.answer.nearest, t};
              })
      .sentence(file_sentence);
}

// What it rests on.

std::string wider_band_sentence(Of tuning) {
  if (!tuning.answer.wider_band_rate) return "";
  const study::Goal& goal = worst_goal(tuning);
  return fmt::format("within ±{} counts {:.4g} % of the {} would meet the goal{}", goal.band + 1,
                     100.0 * *tuning.answer.wider_band_rate, goal.machines ? "machines" : "moves",
                     tuning.study.goals.size() > 1 ? fmt::format(" '{}'", goal.name) : std::string());
}

/// " 'small'", of several goals.
std::string lost_goal_text(const study::Study& study, std::size_t claim) {
  if (study.goals.size() < 2) return "";
  return fmt::format(" '{}'", study.goals[tuning::place_of_claim(study, claim).goal].name);
}

std::string delay_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (!answer.delay_sought) return "";
  if (answer.delay_lost && tuning.study.conditions.empty())
    return fmt::format("the goal{} seems lost at controller.delay = {:.3g} samples; it is {:g} here",
                       lost_goal_text(tuning.study, answer.delay_lost->claim), answer.delay_lost->delay,
                       answer.delay);
  if (answer.delay_lost)
    return fmt::format(
        "with {:.3g} samples more of controller.delay the goal{} seems lost, first{}",
        answer.delay_lost->delay - answer.delay, lost_goal_text(tuning.study, answer.delay_lost->claim),
        study::condition_text(tuning.study,
                              static_cast<std::int64_t>(
                                  tuning::place_of_claim(tuning.study, answer.delay_lost->claim).condition)));
  return fmt::format("the goal seems met up to 5 samples more of controller.delay; it is {:g} here",
                     answer.delay);
}

/// What the rates of the tables are proportions of, where it is not the moves of all machines.
std::string rates_sentence(Of tuning) {
  const study::Study& study = tuning.study;
  const bool named = tuning::has_named_claims(study);
  const bool on_machines = study.goals.front().machines.has_value();
  if (tuning.answer.limits.empty() || !(named || on_machines || study.worlds > 0)) return "";
  if (study.goals.size() > 1)
    return fmt::format(
        "the rate of the goal, below, is of the worst goal{}{}: of machines where it is on machines, else of "
        "moves",
        study.conditions.empty() ? "" : " under its worst condition",
        study.worlds > 0 ? " in the worst world" : "");
  return fmt::format("the rate of the goal, below, is of {}{}{}", on_machines ? "machines" : "moves",
                     study.conditions.empty() ? "" : " under the worst condition",
                     study.worlds > 0 ? " in the worst world" : "");
}

struct RoomRow {
  const tuning::Room& room;
  const std::string& unit;
};

std::vector<RoomRow> room_rows(Of tuning) {
  std::vector<RoomRow> rows;
  for (std::size_t i = 0; i < tuning.answer.room.size(); ++i)
    rows.push_back({tuning.answer.room[i], tuning.answer.free[i].unit});
  return rows;
}

Description<RoomRow> room_columns() {
  using Row = const RoomRow&;
  return Description<RoomRow>()
      .value({.heading = "parameter"}, [](Row row) { return row.room.name; })
      .value({.heading = "goal seems met from"}, [](Row row) { return row.room.low; })
      .value({.heading = "to"}, [](Row row) { return row.room.high; })
      .value({.heading = "unit"}, [](Row row) { return row.unit; });
}

/// What several goals and conditions lose beyond the room: "controller.kp above its room: the goal 'small' is
/// lost under condition loaded".
std::string ends_of_room_sentence(Of tuning) {
  const study::Study& study = tuning.study;
  if (!tuning::has_named_claims(study)) return "";
  std::vector<std::string> ends;
  for (const tuning::Room& one : tuning.answer.room) {
    for (const auto& [lost, side] :
         {std::pair(one.lost_below, "below"), std::pair(one.lost_above, "above")}) {
      if (!lost) continue;
      const auto condition = static_cast<std::int64_t>(tuning::place_of_claim(study, *lost).condition);
      ends.push_back(fmt::format("{} {} its room: the goal{} is lost{}", one.name, side,
                                 lost_goal_text(study, *lost), study::condition_text(study, condition)));
    }
  }
  return fmt::format("{}", fmt::join(ends, "\n"));
}

std::vector<std::pair<std::string, std::vector<double>>> ranges_of_room(Of tuning) {
  std::vector<std::pair<std::string, std::vector<double>>> ranges;
  for (const tuning::Room& one : tuning.answer.room)
    ranges.emplace_back(one.name, std::vector<double>{one.low, one.high});
  return ranges;
}

document::Item criterion_item() {
  return {.key = "criterion",
          .heading = "criterion (–: never)",
          .meaning = "quantity that is minimised; unknown for never"};
}

Description<Alternative> alternative_columns() {
  using Row = const Alternative&;
  return Description<Alternative>()
      .value({.heading = "control", .shown = Shown::to_people}, &Alternative::name)
      .value(in_data("fixed", "parameters that are not tuned, with their values"), &Alternative::fixed)
      .value(in_data("gains", "its best values by parameter; none if none keeps the margins"),
             &Alternative::gains)
      .value({.heading = "best values", .shown = Shown::to_people},
             [](Row row) { return row.verdict ? values_text(row.gains) : "none keeps the margins"; })
      .value({.key = "status",
              .heading = "goal",
              .meaning = "verdict on the goal",
              .words = goal::status_words()},
             [](Row row) {
               return row.verdict ? std::optional(goal::text_of(row.verdict->status)) : std::nullopt;
             })
      .value({.key = "rate",
              .heading = "moves that meet it",
              .meaning = "proportion of moves that meet the goal, with one-sided bounds",
              .unit = "1",
              .notation = Notation::percent},
             [](Row row) {
               return row.verdict ? std::optional(goal::bounded(row.verdict->moves)) : std::nullopt;
             })
      .value({.key = "goal_name",
              .heading = "worst goal",
              .meaning = "name of the worst goal, of several",
              .optional = true},
             &Alternative::worst_goal)
      .value({.key = "condition",
              .heading = "worst condition",
              .meaning = "name of the worst condition, with conditions",
              .optional = true},
             &Alternative::worst_condition)
      .value(criterion_item(),
             [](Row row) { return row.verdict ? std::optional(row.criterion) : std::nullopt; });
}

struct FrontierRow {
  const TriedPoint& point;
  const std::vector<study::FreeParameter>& free;
};

std::vector<FrontierRow> frontier_rows(Of tuning) {
  std::vector<FrontierRow> rows;
  for (const TriedPoint& one : tuning.answer.frontier) rows.push_back({one, tuning.answer.free});
  return rows;
}

/// A few points of the frontier, evenly spread over it.
std::vector<FrontierRow> some_frontier_rows(Of tuning) {
  constexpr std::int64_t most = 6;
  const std::vector<FrontierRow> all = frontier_rows(tuning);
  std::vector<FrontierRow> some;
  if (all.size() < 2) return some;
  for (const std::int64_t i : statistics::spread_over(std::ssize(all), most))
    some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

Description<FrontierRow> frontier_columns() {
  using Row = const FrontierRow&;
  return Description<FrontierRow>()
      .value({.key = "gains", .heading = "values", .meaning = "values by parameter"},
             [](Row row) { return named(row.free, row.point.values); })
      .value({.key = "rate",
              .heading = "rate of the goal",
              .meaning = "rate of the goal by the search, which is a little too good",
              .unit = "1",
              .notation = Notation::percent},
             [](Row row) { return row.point.estimate.rate; })
      .value(criterion_item(), [](Row row) { return row.point.estimate.criterion; });
}

/// "19986 of 20000 trials in 21 s", "14688 trials in 4 of 4 s".
std::string spent_text(const TuneAnswer& answer) {
  const TuneBudget& budget = answer.budget;
  return fmt::format("{}{} trials in {:.3g}{} s", answer.spent_trials,
                     budget.trials ? fmt::format(" of {}", *budget.trials) : "", answer.seconds,
                     budget.seconds ? fmt::format(" of {:g}", *budget.seconds) : "");
}

std::string effort_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  const bool may_improve = !answer.converged && answer.points > 0;
  std::string lines = fmt::format(
      "searched: {} points, {} trials{}\nspent: {}\n", answer.points, answer.trials,
      may_improve ? "; the last generation still improved, a larger --budget may find better values" : "",
      spent_text(answer));
  if (!answer.left_out.empty())
    lines += fmt::format("not found out, because the budget is not enough: {}\n",
                         fmt::join(answer.left_out, "; "));
  return lines;
}

Description<TuneAnswer> search_description() {
  return Description<TuneAnswer>()
      .value(in_data("points", "points that were simulated"), &TuneAnswer::points)
      .value(in_data("trials", "trials of the search, and of those for other controls"), &TuneAnswer::trials)
      .value(in_data("seconds", "time", "s"), &TuneAnswer::seconds)
      .value(in_data("converged", "whether the last generation improved no more"), &TuneAnswer::converged);
}

const TuneAnswer& answer_in(Of tuning) {
  return tuning.answer;
}

/// What is found after the proof, for data only: sentences say it.
Description<TuneAnswer> rest_data() {
  return Description<TuneAnswer>()
      .value(in_data("wider_band_rate", "rate of the goal with a band one count wider, where it is not met",
                     "1"),
             &TuneAnswer::wider_band_rate)
      .object(in_data("margins", "smallest margins of the tuned loops"), margins_description(),
              &TuneAnswer::margins)
      .value(in_data("delay_lost", "controller.delay from which on the goal seems lost", "samples"),
             [](const TuneAnswer& a) -> std::optional<double> {
               if (!a.delay_lost) return {};
               return a.delay_lost->delay;
             })
      .object(in_data("searched", "size of the search"), search_description(), std::identity())
      .value(in_data("spent_trials", "trials of all"), &TuneAnswer::spent_trials)
      .value(in_data("left_out", "parts of the answer for which the budget was not enough"),
             &TuneAnswer::left_out);
}

void add_rest(Description<Tuning>& items) {
  items.include(rest_data(), answer_in)
      .sentence(wider_band_sentence)
      .sentence(margins_sentence)
      .sentence(delay_sentence)
      .sentence(rates_sentence)
      .value(in_data("room", "range of each parameter in which the goal seems met, the others as tuned"),
             ranges_of_room)
      .table({.heading = "room of each parameter, the others as tuned", .shown = Shown::to_people},
             room_columns(), room_rows)
      .sentence(ends_of_room_sentence)
      .table({.key = "alternatives",
              .heading = "other controls, each at its own best values, on other machines than its search",
              .meaning = "simpler and other controls at their own best values"},
             alternative_columns(),
             [](Of t) -> const std::vector<Alternative>& { return t.answer.alternatives; })
      .include(limits_description("what limits it, each by simulation on the machines of the search"),
               [](Of t) -> const std::vector<tuning::Limit>& { return t.answer.limits; })
      .table(in_data("frontier", "points of the search that no other point beats in both rate and criterion"),
             frontier_columns(), frontier_rows)
      .table({.heading = "success and speed, by the search (its rates are a little too good)",
              .shown = Shown::to_people},
             frontier_columns(), some_frontier_rows)
      .sentence(effort_sentence)
      .figures([](Of t) { return t.drawn ? tune_figures(t) : std::vector<document::Figure>(); });
}

document::AnswerDescription<Tuning> described(const std::function<void(Description<Tuning>&)>& add) {
  document::AnswerDescription<Tuning> answer{
      {.name = "tune", .meaning = "values of the free parameters with which the axis meets its goal"}, {}};
  add(answer.items);
  return answer;
}

}  // namespace

document::AnswerDescription<Tuning> proven_answer() {
  return described(add_proven);
}

document::AnswerDescription<Tuning> rest_answer() {
  return described(add_rest);
}

document::AnswerDescription<Tuning> tune_answer() {
  return described([](Description<Tuning>& items) {
    add_proven(items);
    add_rest(items);
  });
}

}  // namespace zerocount::design_commands
