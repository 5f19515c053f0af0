#include "runners/design_commands/tune/tune_answer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "core/loop/encoder.hpp"
#include "core/text/text.hpp"
#include "core/theory/gains.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using document::Visibility;
using document::with_words;
using text::short_number;
using tuning::TriedPoint;
using tuning::TuneAnswer;

std::string_view tune_status(goal::Status status) {
  return status == goal::Status::missed ? "unreachable" : goal::text_of(status);
}

/// Text of the tuned values with their ranges: "controller.ki = 5000 N m/(rad s) in 3000 … 300000, …";
/// nothing without values.
std::optional<std::string> gains_text(const Tuning& tuning) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < tuning.answer.tuned.values.size(); ++i) {
    const study::FreeParameter& one = tuning.answer.free[i];
    texts.push_back(fmt::format("{} = {} {} in {} … {}", one.name,
                                short_number(tuning.answer.tuned.values[i]), one.unit, short_number(one.low),
                                short_number(one.high)));
  }
  return texts.empty() ? std::nullopt : std::optional(fmt::format("{}", fmt::join(texts, ", ")));
}

/// Sentence with the gains kp, ki and kd in the system of units that the manifest does not use (SI units, or
/// counts and samples). Empty unless the controller is a PID law.
std::string other_units_sentence(const Tuning& tuning) {
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

std::string file_sentence(const Tuning& tuning) {
  if (tuning.answer.proof)
    return fmt::format("{} {}: the proof, with the tuned manifest", tuning.is_of_file ? "read" : "wrote",
                       tuning.output.string());
  return "no results file is written: there are no values to prove\n"
         "tune.margins: {gain: …, phase: …, delay: …} makes the margins smaller, or off";
}

void add_proven(Description<Tuning>& items) {
  items.headline(tune_headline)
      .value({.key = "goal", .heading = "goal", .meaning = "the goal in words"},
             [](const Tuning& t) { return goal::claim_sentence(goal::question_of(t.study)); })
      .value(with_words(in_data("status", "whether the goal is met; unreachable: not in the ranges"),
                        {"met", "unreachable", "undecided"}),
             [](const Tuning& t) { return tune_status(t.answer.status); })
      .value(everywhere("gains", "tuned", "tuned values by parameter; none where no values keep the margins"),
             [](const Tuning& t) { return named(t.answer.free, t.answer.tuned.values); })
      .shown_as(gains_text)
      .sentence(other_units_sentence);
  add_refusals(items);
  add_nearest(items);
  add_proof(items);
  add_behaviour(items);
  add_margins(items);
  items.sentence(file_sentence);
}

std::vector<std::string> parts_left_out(const Tuning& tuning) {
  std::vector<std::string> parts;
  for (const tuning::LeftOut& one : tuning.answer.extras.left_out) parts.push_back(one.part);
  return parts;
}

std::string unfinished_sentence(const Tuning& tuning) {
  const tuning::SearchResult& search = tuning.answer.searched.result;
  const bool may_improve = !search.converged && search.points > 0 && !tuning.is_of_file;
  return may_improve ? "the last generation still improved, a larger --budget may find better values" : "";
}

/// Sentence that names the extras that were left out, and the command that computes them; empty if none was.
std::string left_out_sentence(const Tuning& tuning) {
  const TuneAnswer& answer = tuning.answer;
  const std::vector<tuning::LeftOut>& left_out = answer.extras.left_out;
  if (left_out.empty()) return "";
  std::vector<std::string_view> extras;
  for (const tuning::LeftOut& one : left_out) {
    if (!one.extra.empty() && std::ranges::find(extras, one.extra) == extras.end())
      extras.push_back(one.extra);
  }
  std::string line =
      fmt::format("left out{}: {}", answer.interrupted ? "" : ", because the budget is not enough",
                  fmt::join(parts_left_out(tuning), ", "));
  if (extras.empty() || !answer.proof) return line;
  if (answer.interrupted && !tuning.is_of_file) return line + "; the same command goes on with them";
  return line + fmt::format("; zerocount tune {} --extras {} makes them", text::shell_path(tuning.output),
                            fmt::join(extras, ","));
}

Description<Tuning> search_description() {
  return Description<Tuning>()
      .value(everywhere("points", "points", "points that were simulated"),
             [](const Tuning& t) { return t.answer.searched.result.points; })
      .value(in_data("telling_points",
                     "points at which some moves meet the worst goal, more than 1 %, and too few; "
                     "where hardly any point is one, the goal is not shown to be out of reach"),
             [](const Tuning& t) { return t.answer.searched.landscape.telling; })
      .value(everywhere("trials", "trials", "trials of the search, and of those for other controls"),
             [](const Tuning& t) { return t.answer.searched.result.trials; })
      .value(in_data("seconds", "time", "s"), [](const Tuning& t) { return t.answer.seconds; })
      .value(everywhere("converged", "converged", "whether the last generation improved no more"),
             [](const Tuning& t) { return t.answer.searched.result.converged; });
}

struct FrontierRow {
  const TriedPoint& point;
  const std::vector<study::FreeParameter>& free;
};

std::vector<FrontierRow> frontier_rows(const Tuning& tuning) {
  std::vector<FrontierRow> rows;
  for (const TriedPoint& one : tuning.answer.searched.frontier) rows.push_back({one, tuning.answer.free});
  return rows;
}

/// A few points of the frontier between success and speed, evenly spread over it, as rows of a table.
std::vector<FrontierRow> some_frontier_rows(const Tuning& tuning) {
  constexpr std::int64_t most = 6;
  const std::vector<FrontierRow> all = frontier_rows(tuning);
  std::vector<FrontierRow> some;
  if (all.size() < 2) return some;
  for (const std::int64_t i : statistics::spread_over(std::ssize(all), most))
    some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

Description<FrontierRow> frontier_columns() {
  return Description<FrontierRow>()
      .value({.key = "gains", .heading = "values", .meaning = "values by parameter"},
             [](const FrontierRow& row) { return named(row.free, row.point.values); })
      .value(proportion("rate", "rate of the goal",
                        "rate of the goal by the search, which is a little too good"),
             [](const FrontierRow& row) { return row.point.estimate.rate; })
      .value(criterion_item(), [](const FrontierRow& row) { return row.point.estimate.criterion; });
}

document::FigureData points_data(std::string name, const TuneAnswer& answer,
                                 const std::vector<TriedPoint>& points) {
  using nlohmann::ordered_json;
  using report::datum;
  return report::data_of<TriedPoint>(
      std::move(name), points,
      {{{"criterion", "criterion", ""}, [](const TriedPoint& one) { return datum(one.estimate.criterion); }},
       {{"rate", "rate of the goal", "1"}, [](const TriedPoint& one) { return datum(one.estimate.rate); }},
       {{"values", "values", ""},
        [&](const TriedPoint& one) { return ordered_json(values_text(named(answer.free, one.values))); }},
       {{"units", "machines or trials", "1"},
        [](const TriedPoint& one) { return ordered_json(one.estimate.machines); }}});
}

std::vector<document::Figure> frontier_figures(const Tuning& tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (!is_drawn(tuning) || answer.searched.result.tried.empty()) return {};
  std::vector<TriedPoint> tried = answer.searched.result.tried;
  std::erase_if(tried, [](const TriedPoint& one) { return !std::isfinite(one.estimate.criterion); });
  const goal::Verdict& verdict = answer.proof->verdict;
  const study::Goal& goal = worst_goal(tuning);
  TriedPoint tuned{answer.tuned.values, {}};
  tuned.estimate.criterion = answer.proof->criterion;
  tuned.estimate.rate = goal::judged_rate(goal, verdict).value;
  document::Figure figure = report::figure_of(
      "tuning-frontier", "tuning-frontier", "What does more speed cost?",
      "The points that the search tried, with a finite criterion; what the goal asks for is dashed. The line "
      "joins those that no other point with as many machines beats in both; their rates are those of the "
      "search, and so a little too good. The star is the tuned point by its proof.",
      {points_data("frontier", answer, answer.searched.frontier),
       points_data("tried", answer, tried),
       points_data("tuned", answer, {tuned}),
       {"asked",
        {{"rate", "asked for", "1"}},
        {nlohmann::ordered_json::array({study::demanded_proportion(goal)})}}});
  figure.parameters["criterion"] = criterion_title(tuning.study);
  return {std::move(figure)};
}

void add_closing(Description<Tuning>& items) {
  items
      .table(in_data("frontier", "points of the search that no other point beats in both rate and criterion"),
             frontier_columns(), frontier_rows)
      .table({.heading = "success and speed, by the search (its rates are a little too good)",
              .shown = Visibility::to_people},
             frontier_columns(), some_frontier_rows)
      .object(everywhere("searched", "searched", "size of the search"), search_description(), std::identity())
      .value(everywhere("spent_trials", "spent", "trials of all"),
             [](const Tuning& t) { return t.answer.spent_trials; })
      .shown_as([](const Tuning& t) {
        const auto& [trials, seconds] = t.answer.budget;
        return fmt::format("{}{} trials in {:.3g}{} s", t.answer.spent_trials,
                           trials ? fmt::format(" of {}", *trials) : "", t.answer.seconds,
                           seconds ? fmt::format(" of {:g}", *seconds) : "");
      })
      .value(in_data("left_out", "parts of the answer for which the budget was not enough"), parts_left_out)
      .value(in_data("interrupted", "whether Ctrl-C ended it after the proof"),
             [](const Tuning& t) { return t.answer.interrupted; })
      .sentence(unfinished_sentence)
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

const study::Goal& worst_goal(const Tuning& tuning) {
  const std::optional<tuning::Proof>& proof = tuning.answer.proof;
  return tuning.study.goals[proof ? proof->verdict.goal : 0];
}

document::Item criterion_item() {
  return document::everywhere("criterion", "criterion (–: never)",
                              "quantity that is minimised; unknown for never");
}

std::string criterion_title(const study::Study& study) {
  const std::string name = tuning::criterion_name(study);
  if (tuning::is_proportion_of_allowed(study)) return name + ", of the time that its goal allows";
  const std::string& unit = tuning::criteria_of(study).front().measure->field.column.unit;
  return unit == "1" || unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

bool is_drawn(const Tuning& tuning) {
  return tuning.drawn && tuning.answer.proof;
}

document::AnswerDescription<Tuning> proven_answer() {
  return described(add_proven);
}

document::AnswerDescription<Tuning> extra_answer(const tuning::Extra& extra) {
  return described(extra.describe);
}

document::AnswerDescription<Tuning> closing_answer() {
  return described(add_closing);
}

document::AnswerDescription<Tuning> tune_answer() {
  return described([](Description<Tuning>& items) {
    add_proven(items);
    for (const tuning::Extra& extra : all_extras()) extra.describe(items);
    add_closing(items);
  });
}

document::AnswerDescription<Tuning> margins_answer() {
  return described(add_margin_table);
}

document::AnswerDescription<Tuning> proof_answer() {
  return described([](Description<Tuning>& items) {
    add_refusals(items);
    add_proof_facts(items);
  });
}

tuning::Extra margins_extra();
tuning::Extra ages_extra();
tuning::Extra room_extra();
tuning::Extra robustness_extra();
tuning::Extra controls_extra();
tuning::Extra limits_extra();
tuning::Extra maps_extra();

const std::vector<tuning::Extra>& all_extras() {
  static const std::vector<tuning::Extra> extras{
      margins_extra(),     // what more delay loses; of a goal that is missed, what a wider band would change
      ages_extra(),        // at which each claim is lost, of a study with ages
      room_extra(),        // of each free parameter
      robustness_extra(),  // with other seeds, spreads and delays
      controls_extra(),    // others, each at its own best values
      limits_extra(),      // what stands between the values and the goal
      maps_extra()};       // over pairs of free parameters, for a page
  return extras;
}

}  // namespace zerocount::design_commands
