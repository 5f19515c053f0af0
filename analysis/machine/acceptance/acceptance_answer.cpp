#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/machine/acceptance/acceptance.hpp"
#include "analysis/trials/goal/goal_text.hpp"

namespace zerocount::acceptance {
namespace {

using document::Bounded;
using document::Description;
using document::everywhere;
using document::in_data;
using document::Item;
using document::Notation;
using document::with_words;

/// The words for the values of Status, in the order of the enumerators.
std::vector<std::string> status_words() {
  return {"accepted", "rejected", "undecided"};
}

std::string word_of(Status status) {
  return status_words()[static_cast<std::size_t>(status)];
}

/// Word for the agreement of the measured machines with the prediction of a goal: "differs", "consistent", or
/// "too_few" if these numbers of machines could not show a difference. The command `summary` uses the same
/// words.
std::string_view agreement_word(const AcceptedGoal& c) {
  if (c.agreement.p <= c.significance) return "differs";
  return c.agreement.lowest_p <= c.significance ? "consistent" : "too_few";
}

std::string name_of(const AcceptedGoal& claim) {
  return claim.goal.name.empty() ? "goal" : claim.goal.name;
}

/// Text of the numbers of judged moves and measured machines: "20 moves of 1 machine". "20 to 40 moves of …"
/// if the goals judge different numbers of moves.
std::string judged_text(const Acceptance& a) {
  const auto [least, most] = std::ranges::minmax(a.claims, {}, &AcceptedGoal::moves);
  const std::string moves = least.moves == most.moves ? fmt::format("{}", most.moves)
                                                      : fmt::format("{} to {}", least.moves, most.moves);
  return fmt::format("{} moves of {} machine{}", moves, a.machines.size(), a.machines.size() == 1 ? "" : "s");
}

/// Text of the reasons for a rejection: "missed: fast; met less often than predicted: near (80 % of the
/// moves, predicted 97 %)". Empty if there is no reason.
std::string reasons_to_reject(const Acceptance& a) {
  std::vector<std::string> missed, fewer;
  for (const AcceptedGoal& claim : a.claims) {
    if (claim.status == goal::Status::missed) missed.push_back(name_of(claim));
    if (claim.is_below_prediction)
      fewer.push_back(fmt::format("{} ({} of the moves, predicted {})", name_of(claim),
                                  text::percent(claim.rate.value),
                                  text::percent(claim.predicted.moves.value)));
  }
  std::vector<std::string> reasons;
  if (!missed.empty()) reasons.push_back(fmt::format("missed: {}", fmt::join(missed, ", ")));
  if (!fewer.empty())
    reasons.push_back(fmt::format("met less often than predicted: {}", fmt::join(fewer, ", ")));
  return fmt::format("{}", fmt::join(reasons, "; "));
}

/// Total number of moves of these machines, including the moves already measured, that would show each
/// undecided goal if no further move misses it. 0 if a goal is about a proportion of machines, because each
/// machine then needs its own number of moves.
std::int64_t moves_needed(const Acceptance& a) {
  std::int64_t needed = 0;
  for (const AcceptedGoal& claim : a.claims) {
    if (claim.goal.machines) return 0;
    if (claim.status == goal::Status::undecided)
      needed = std::max(needed, statistics::trials_for_claim(claim.goal.moves, claim.goal.confidence,
                                                             claim.moves - claim.met));
  }
  return needed;
}

std::string headline_of(const Acceptance& a) {
  const std::string of = judged_text(a);
  const char* const whose = a.judged == Judged::all_machines ? "all such machines" : "these machines";
  const char* const goals = a.claims.size() > 1 ? "every goal" : "the goal";
  switch (status_of(a)) {
    case Status::accepted:
      return fmt::format("accepted: {} show that {} meet {}, as often as predicted", of, whose, goals);
    case Status::rejected:
      return fmt::format("rejected by {}: {}", of, reasons_to_reject(a));
    case Status::undecided:
      break;
  }
  const std::string needed =
      a.needed_machines > 0 ? fmt::format("; about {} machines would decide", a.needed_machines)
      : a.judged == Judged::these_machines && moves_needed(a) > 0
          ? fmt::format("; {} moves in all, without another miss, can", moves_needed(a))
          : "";
  return fmt::format("undecided: {} are too few to show {} for {}{}", of, goals, whose, needed);
}

std::string sentences_of_goals(const Acceptance& a) {
  std::string text;
  for (const AcceptedGoal& claim : a.claims)
    text += (claim.goal.name.empty() ? "goal: " : "") + goal::goal_sentence(claim.goal) + '\n';
  return text;
}

std::string comparison_of(const AcceptedGoal& c) {
  const std::string_view word = agreement_word(c);
  return fmt::format("{} (p = {})", word == "too_few" ? "too few to decide" : word,
                     text::short_number(c.agreement.p));
}

std::optional<Bounded> of_machines(const AcceptedGoal& c, const goal::ClaimVerdict& verdict) {
  if (!c.goal.machines) return std::nullopt;
  return goal::bounded(verdict.machines);
}

Item percent(std::string key, std::string heading, std::string meaning) {
  Item item = everywhere(std::move(key), std::move(heading), std::move(meaning), "1");
  item.notation = Notation::percent;
  return item;
}

Description<AcceptedGoal> claim_rows() {
  return Description<AcceptedGoal>()
      .value(everywhere("goal", "goal", "name of the goal"), name_of)
      .value(
          with_words(everywhere("status", "status", "verdict on the machines by the goal and its prediction"),
                     status_words()),
          [](const AcceptedGoal& c) { return word_of(status_of(c)); })
      .value(with_words(in_data("goal_status", "verdict on the goal alone, whatever was predicted"),
                        goal::status_words()),
             [](const AcceptedGoal& c) { return goal::text_of(c.status); })
      .value(percent("wanted", "wanted", "proportion of moves that should meet it"),
             [](const AcceptedGoal& c) { return c.goal.moves; })
      .value(
          percent(
              "predicted", "predicted",
              "proportion of the simulated moves that meet it; bounds: 95 % interval for as many machines and moves as are compared"),
          [](const AcceptedGoal& c) {
            return Bounded{c.predicted.moves.value, c.agreement.predicted.low, c.agreement.predicted.high};
          })
      .value(
          percent("measured", "measured",
                  "proportion of the measured moves that meet it, with one-sided bounds of these machines"),
          [](const AcceptedGoal& c) { return goal::bounded(c.rate); })
      .value(in_data("met", "measured moves that meet it"), &AcceptedGoal::met)
      .value(in_data("moves", "measured moves"), &AcceptedGoal::moves)
      .value(
          with_words(everywhere("agreement", "agreement", "whether these machines are like those simulated"),
                     {"consistent", "differs", "too_few"}),
          agreement_word)
      .shown_as(comparison_of)
      .value(in_data("p_value", "two-sided p-value of the agreement", "1"),
             [](const AcceptedGoal& c) { return c.agreement.p; })
      .value(everywhere("like_worlds", "like worlds",
                        "worlds of the study that agree with the machines; null: it has no worlds"),
             &AcceptedGoal::like_worlds)
      .value(in_data("compared_moves", "first moves of each machine that are compared"),
             [](const AcceptedGoal& c) { return c.agreement.moves; })
      .value(
          percent("all_machines", "all such machines",
                  "proportion of moves of all machines of which these are a sample, with one-sided bounds"),
          [](const AcceptedGoal& c) { return goal::bounded(c.measured.moves); })
      .value(
          percent(
              "machines_predicted", "machines, predicted",
              "proportion of machines that meet it in the wanted proportion of moves, with one-sided bounds; null: the goal does not ask for machines"),
          [](const AcceptedGoal& c) { return of_machines(c, c.predicted); })
      .value(percent("machines_measured", "machines, measured",
                     "that proportion of the measured machines, with one-sided bounds"),
             [](const AcceptedGoal& c) { return of_machines(c, c.measured); });
}

/// Text of the numbers of moves of the machine that meet each goal: "20 of 20" for a goal, in the order of
/// the goals.
std::string met_text(const MeasuredMachine& machine) {
  std::vector<std::string> goals;
  for (std::size_t goal = 0; goal < machine.met.size(); ++goal)
    goals.push_back(fmt::format("{} of {}", machine.met[goal], machine.moves[goal]));
  return fmt::format("{}", fmt::join(goals, ", "));
}

Description<MeasuredMachine> machine_rows() {
  return Description<MeasuredMachine>()
      .value(everywhere("machine", "machine", "its log"), &MeasuredMachine::name)
      .value(in_data("moves", "its moves that each goal is about, in the order of the goals"),
             &MeasuredMachine::moves)
      .value({.key = "met",
              .heading = "meet the goal",
              .meaning = "its moves that meet each goal, in the same order",
              .numeric = true},
             &MeasuredMachine::met)
      .shown_as(met_text);
}

/// Text of the range of the measured values: "3 to 5", or one number if they are equal.
std::string measured_text(const StandardValue& value) {
  std::vector<double> known;
  std::ranges::copy_if(value.measured, std::back_inserter(known),
                       [](double one) { return std::isfinite(one); });
  if (known.empty()) return "";
  const auto [low, high] = std::ranges::minmax(known);
  return low == high ? text::short_number(low)
                     : fmt::format("{} to {}", text::short_number(low), text::short_number(high));
}

Description<StandardValue> standard_rows() {
  const auto counts = [](const char* key, const char* heading, const char* meaning) {
    Item item = everywhere(key, heading, meaning, "count");
    item.notation = Notation::three_digits;
    return item;
  };
  return Description<StandardValue>()
      .value(everywhere("value", "value", "name of the value of the axis"), &StandardValue::name)
      .value(everywhere("symbol", "symbol", "in the standard"), &StandardValue::symbol)
      .value(counts("predicted", "predicted", "median of the simulated runs"), &StandardValue::median)
      .value(counts("predicted_low", "95 % from", "95 % of the simulated runs have more"),
             &StandardValue::low)
      .value(counts("predicted_high", "to", "and less"), &StandardValue::high)
      .value({.key = "measured",
              .heading = "measured",
              .meaning = "value of each measured run",
              .unit = "count",
              .numeric = true},
             &StandardValue::measured)
      .shown_as(measured_text)
      .value(everywhere("within", "runs within", "measured runs in the predicted interval"),
             &StandardValue::within)
      .value(in_data("runs", "measured runs"), [](const StandardValue& v) { return v.measured.size(); });
}

std::string worlds_sentence(const Acceptance& a) {
  if (a.worlds == 0) return "";
  return fmt::format(
      "with {} worlds, the prediction is that of the world that agrees best with the machines; the "
      "interval covers all worlds",
      a.worlds);
}

std::string assumed_sentence(const Acceptance& a) {
  if (a.assumed.empty()) return "";
  return fmt::format("the prediction assumes: {}", fmt::join(a.assumed, ", "));
}

}  // namespace

document::AnswerDescription<Acceptance> acceptance_answer() {
  document::AnswerDescription<Acceptance> answer{
      {.name = "accept",
       .meaning = "whether machines that were built meet the goal, and the prediction",
       .csv_table = "goals"},
      {}};
  answer.items.headline(headline_of)
      .value(with_words(in_data("status", "verdict on the machines"), status_words()),
             [](const Acceptance& a) { return word_of(status_of(a)); })
      .value(with_words(in_data("judged", "machines that the goals are judged for"),
                        {"all_machines", "these_machines"}),
             [](const Acceptance& a) {
               return a.judged == Judged::all_machines ? "all_machines" : "these_machines";
             })
      .value(in_data("needed_machines",
                     "machines, with as many moves each, that would decide the goals for all machines; "
                     "null: they are decided, or no number is known"),
             [](const Acceptance& a) {
               return a.needed_machines > 0 ? std::optional(a.needed_machines) : std::nullopt;
             })
      .value(everywhere("study", "study", "the results file of the prediction"), &Acceptance::study)
      .value(everywhere("point", "point", "label of the design point"), &Acceptance::point)
      .value(everywhere("simulated_machines", "simulated machines", "machines of the prediction"),
             &Acceptance::simulated)
      .sentence(sentences_of_goals)
      .table({.key = "goals", .meaning = "each goal"}, claim_rows(), &Acceptance::claims)
      .sentence(worlds_sentence)
      .table(
          everywhere(
              "standard", "ISO 230-2, by the encoder",
              "values of the axis; empty without a sequence, or without the columns final_error and move in every log"),
          standard_rows(), &Acceptance::standard_values)
      .value(
          in_data(
              "standard_lacks",
              "why there are no values of ISO 230-2: the column that a log lacks; empty: there are, or the study has no sequence"),
          &Acceptance::standard_lacks)
      .sentence([](const Acceptance& a) {
        return a.standard_lacks.empty() ? std::string()
                                        : fmt::format("the values of ISO 230-2 are not judged, because {}",
                                                      text::printable(a.standard_lacks));
      })
      .table(everywhere("machines", "machines", "each machine that was measured"), machine_rows(),
             &Acceptance::machines)
      .value({.key = "assumed",
              .meaning = "effects that the prediction leaves out because its manifest does not name them",
              .shown = document::Visibility::in_json},
             &Acceptance::assumed)
      .sentence(assumed_sentence)
      .sentence([](const Acceptance&) {
        return std::string(
            "measured bounds hold for moves that do not depend on each other; those of the measured machines "
            "hold for these machines alone, the others for all machines of which they are a sample");
      })
      .sentence([](const Acceptance&) { return std::string("date, name, signature: ____________________"); });
  return answer;
}

}  // namespace zerocount::acceptance
