#include "runners/design_commands/tune_answer.hpp"

#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/encoder.hpp"
#include "core/text/shell_word.hpp"
#include "core/theory/gains.hpp"
#include "runners/design_commands/tune_figures.hpp"
#include "runners/design_commands/tune_parts.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Shown;
using document::with_words;
using text::short_number;
using tuning::Extra;
using tuning::TuneAnswer;
using tuning::TuneBudget;

std::string_view tune_status(goal::Status status) {
  return status == goal::Status::missed ? "unreachable" : goal::text_of(status);
}

std::vector<std::string> tune_statuses() {
  std::vector<std::string> words;
  for (const goal::Status status : all_statuses) words.emplace_back(tune_status(status));
  return words;
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

std::string file_sentence(Of tuning) {
  if (tuning.answer.proof)
    return fmt::format("{} {}: the proof, with the tuned manifest", tuning.is_of_file ? "read" : "wrote",
                       tuning.output.string());
  return "no results file is written: there are no values to prove\n"
         "tune.margins: {gain: …, phase: …, delay: …} makes the margins smaller, or off";
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
      .sentence(other_units_sentence);
  add_refusals(items);
  add_nearest(items);
  add_proof(items);
  add_behaviour(items);
  add_margins(items);
  items.sentence(file_sentence);
}

void add_extra(Description<Tuning>& items, Extra extra) {
  switch (extra) {
    case Extra::margins:
      return add_delay(items);
    case Extra::ages:
      return add_lost_ages(items);
    case Extra::room:
      return add_room(items);
    case Extra::robustness:
      return add_robustness(items);
    case Extra::retuning:
      return add_retuning(items);
    case Extra::controls:
      return add_controls(items);
    case Extra::limits:
      return add_limits(items);
    case Extra::maps:
      items.figures(map_figures);
      return;
  }
}

/// "19986 of 20000 trials in 21 s", "14688 trials in 4 of 4 s".
std::string spent_text(const TuneAnswer& answer) {
  const TuneBudget& budget = answer.budget;
  return fmt::format("{}{} trials in {:.3g}{} s", answer.spent_trials,
                     budget.trials ? fmt::format(" of {}", *budget.trials) : "", answer.seconds,
                     budget.seconds ? fmt::format(" of {:g}", *budget.seconds) : "") +
         (answer.default_seconds ? fmt::format("; no --budget: the search may take {:.3g} s on this machine",
                                               *answer.default_seconds)
                                 : std::string());
}

/// Names the extras that were left out, and the command that makes them.
std::string left_out_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (answer.left_out.empty()) return "";
  std::string line =
      fmt::format("left out{}: {}", answer.interrupted ? "" : ", because the budget is not enough",
                  fmt::join(answer.left_out, ", "));
  if (answer.left_extras.empty() || !answer.proof) return line;
  if (answer.interrupted && !tuning.is_of_file) return line + "; the same command goes on with them";
  std::vector<std::string_view> names;
  for (const Extra extra : answer.left_extras) names.push_back(tuning::name_of(extra));
  const std::string interval =
      answer.retuning ? fmt::format(" --retune-every {}", answer.retuning->every) : std::string();
  return line + fmt::format("; zerocount tune {} --extras {}{} makes them", text::shell_path(tuning.output),
                            fmt::join(names, ","), interval);
}

std::string effort_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  const bool may_improve = !answer.converged && answer.points > 0 && !tuning.is_of_file;
  return fmt::format(
      "searched: {} points, {} trials{}\nspent: {}", answer.points, answer.trials,
      may_improve ? "; the last generation still improved, a larger --budget may find better values" : "",
      spent_text(answer));
}

Description<TuneAnswer> search_description() {
  return Description<TuneAnswer>()
      .value(in_data("points", "points that were simulated"), &TuneAnswer::points)
      .value(
          in_data("telling_points",
                  "points at which some moves meet the worst goal, more than 1 %, and too few; where hardly "
                  "any point is one, the goal is not shown to be out of reach"),
          [](const TuneAnswer& answer) { return answer.missed.landscape.telling; })
      .value(in_data("trials", "trials of the search, and of those for other controls"), &TuneAnswer::trials)
      .value(in_data("seconds", "time", "s"), &TuneAnswer::seconds)
      .value(in_data("converged", "whether the last generation improved no more"), &TuneAnswer::converged);
}

void add_closing(Description<Tuning>& items) {
  add_frontier(items);
  items
      .object(in_data("searched", "size of the search"), search_description(),
              [](Of t) -> const TuneAnswer& { return t.answer; })
      .value(in_data("spent_trials", "trials of all"), [](Of t) { return t.answer.spent_trials; })
      .value(in_data("left_out", "parts of the answer for which the budget was not enough"),
             [](Of t) { return t.answer.left_out; })
      .value(in_data("interrupted", "whether Ctrl-C ended it after the proof"),
             [](Of t) { return t.answer.interrupted; })
      .sentence(effort_sentence)
      .sentence(left_out_sentence)
      .figures(frontier_figures);
}

document::AnswerDescription<Tuning> described(const std::function<void(Description<Tuning>&)>& add) {
  document::AnswerDescription<Tuning> answer{
      {.name = "tune", .meaning = "values of the free parameters with which the axis meets its goal"}, {}};
  add(answer.items);
  return answer;
}

}  // namespace

NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values) {
  NamedValues named;
  for (std::size_t i = 0; i < values.size(); ++i) named.emplace_back(free[i].name, values[i]);
  return named;
}

const study::Goal& worst_goal(Of tuning) {
  const std::optional<tuning::Proof>& proof = tuning.answer.proof;
  return tuning.study.goals[proof ? proof->verdict.goal : 0];
}

document::AnswerDescription<Tuning> proven_answer() {
  return described(add_proven);
}

document::AnswerDescription<Tuning> extra_answer(Extra extra) {
  return described([extra](Description<Tuning>& items) { add_extra(items, extra); });
}

document::AnswerDescription<Tuning> closing_answer() {
  return described(add_closing);
}

document::AnswerDescription<Tuning> tune_answer() {
  return described([](Description<Tuning>& items) {
    add_proven(items);
    for (const Extra extra : tuning::all_extras) add_extra(items, extra);
    add_closing(items);
  });
}

document::AnswerDescription<Tuning> margins_answer() {
  return described(add_margin_table);
}

document::AnswerDescription<Tuning> proof_answer() {
  return described([](Description<Tuning>& items) {
    add_refusals(items);
    add_proof_sentences(items);
  });
}

}  // namespace zerocount::design_commands
