#include "analysis/acceptance/acceptance_answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::acceptance {
namespace {

using document::Bounded;

/// A claim, with what decides on it.
struct JudgedClaim {
  const Claim& claim;
  double significance;
};

std::string_view word_of(Status status) {
  switch (status) {
    case Status::accepted:
      return "accepted";
    case Status::rejected:
      return "rejected";
    case Status::undecided:
      break;
  }
  return "undecided";
}

/// The words of Summary's comparison with what was observed.
std::string_view agreement_word(const JudgedClaim& c) {
  if (c.claim.agreement.p <= c.significance) return "differs";
  return c.claim.agreement.lowest_p <= c.significance ? "consistent" : "too_few";
}

/// "20 moves of 1 machine"; "20 to 40 moves" where the goals are about different moves.
std::string judged_text(const Acceptance& a) {
  const auto [least, most] = std::ranges::minmax(a.claims, {}, &Claim::moves);
  const std::string moves = least.moves == most.moves ? fmt::format("{}", most.moves)
                                                      : fmt::format("{} to {}", least.moves, most.moves);
  return fmt::format("{} moves of {} machine{}", moves, a.machines.size(), a.machines.size() == 1 ? "" : "s");
}

std::string name_of(const Claim& claim) {
  return claim.goal.name.empty() ? "the goal" : "goal " + claim.goal.name;
}

/// "missed: goal fast; met less often than predicted: goal near (80 % of the moves, predicted 97 %)".
std::string reasons_to_reject(const Acceptance& a) {
  std::vector<std::string> missed, fewer;
  for (const Claim& claim : a.claims) {
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

std::string headline_of(const AcceptanceReading& r) {
  const Acceptance& a = r.acceptance;
  const std::string of = judged_text(a);
  const std::string whose = a.judged == Judged::all_machines ? "all such machines" : "these machines";
  const std::string goals = a.claims.size() == 1 ? "the goal" : "every goal";
  switch (status_of(a)) {
    case Status::accepted:
      return fmt::format("accepted: {} show {} for {}, met as often as predicted", of, goals, whose);
    case Status::rejected:
      return fmt::format("rejected by {}: {}", of, reasons_to_reject(a));
    case Status::undecided:
      break;
  }
  const std::string needed =
      a.needed_machines == 0 ? "" : fmt::format("; about {} machines would decide", a.needed_machines);
  return fmt::format("undecided: {} are too few to show {} for {}{}", of, goals, whose, needed);
}

std::string goal_name(const JudgedClaim& c) {
  return c.claim.goal.name.empty() ? "goal" : c.claim.goal.name;
}

std::string sentences_of_goals(const AcceptanceReading& r) {
  std::string text;
  for (const Claim& claim : r.acceptance.claims)
    text += fmt::format("{}: {}\n", claim.goal.name.empty() ? "goal" : claim.goal.name,
                        goal::goal_sentence(claim.goal));
  return text;
}

std::string comparison_of(const JudgedClaim& c) {
  const Agreement& agreement = c.claim.agreement;
  return fmt::format("{} (p = {})", agreement_word(c) == "too_few" ? "too few to tell" : agreement_word(c),
                     text::short_number(agreement.p));
}

std::optional<Bounded> of_machines(const JudgedClaim& c, const goal::Verdict& verdict) {
  if (!c.claim.goal.machines) return std::nullopt;
  return goal::bounded(verdict.machines);
}

document::Description<JudgedClaim> claim_rows() {
  using document::in_data;
  using document::Notation;
  using document::Shown;
  using Of = const JudgedClaim&;
  const auto percent = [](std::string key, std::string heading, std::string meaning) {
    return document::Item{.key = std::move(key),
                          .heading = std::move(heading),
                          .meaning = std::move(meaning),
                          .unit = "1",
                          .notation = Notation::percent};
  };
  return document::Description<JudgedClaim>()
      .value({"goal", "goal", "name of the goal"}, goal_name)
      .value(with_words(document::everywhere("status", "status",
                                             "verdict on the machines by the goal and its prediction"),
                        {"accepted", "rejected", "undecided"}),
             [](Of c) { return word_of(status_of(c.claim)); })
      .value(with_words(in_data("goal_status", "verdict on the goal alone, whatever was predicted"),
                        goal::status_words()),
             [](Of c) { return goal::text_of(c.claim.status); })
      .value(percent("wanted", "wanted", "proportion of moves that should meet it"),
             [](Of c) { return c.claim.goal.moves; })
      .value(percent("predicted", "predicted",
                     "proportion of the simulated moves that meet it; bounds: of as many machines, in as "
                     "many moves as "
                     "are compared, with 95 %"),
             [](Of c) {
               return Bounded{c.claim.predicted.moves.value, c.claim.agreement.predicted.low,
                              c.claim.agreement.predicted.high};
             })
      .value(
          percent("measured", "measured",
                  "proportion of the measured moves that meet it, with one-sided bounds of these machines"),
          [](Of c) { return goal::bounded(c.claim.rate); })
      .value(in_data("met", "measured moves that meet it"), [](Of c) { return c.claim.met; })
      .value(in_data("moves", "measured moves"), [](Of c) { return c.claim.moves; })
      .value(with_words(in_data("agreement", "whether these machines are like those simulated"),
                        {"consistent", "differs", "too_few"}),
             agreement_word)
      .value(in_data("p_value", "two-sided p-value of that", "1"), [](Of c) { return c.claim.agreement.p; })
      .value(in_data("like_worlds", "worlds of the study that the machines are like; null: it has none"),
             [](Of c) { return c.claim.like_worlds; })
      .value(in_data("compared_moves", "first moves of each machine that are compared"),
             [](Of c) { return c.claim.agreement.moves; })
      .value(document::to_people("agreement"), comparison_of)
      .value(
          percent("all_machines", "of all such machines",
                  "proportion of moves of all machines of which these are a sample, with one-sided bounds"),
          [](Of c) { return goal::bounded(c.claim.measured.moves); })
      .value(percent("machines_predicted", "machines, predicted",
                     "proportion of machines that meet it in the wanted proportion of moves, with one-sided "
                     "bounds; null: "
                     "the goal does not ask for machines"),
             [](Of c) { return of_machines(c, c.claim.predicted); })
      .value(percent("machines_measured", "machines, measured", "likewise as measured"),
             [](Of c) { return of_machines(c, c.claim.measured); });
}

/// "20 of 20" for each goal.
std::string met_text(const MeasuredMachine& machine) {
  std::vector<std::string> goals;
  for (std::size_t goal = 0; goal < machine.met.size(); ++goal)
    goals.push_back(fmt::format("{} of {}", machine.met[goal], machine.moves[goal]));
  return fmt::format("{}", fmt::join(goals, ", "));
}

document::Description<MeasuredMachine> machine_rows() {
  return document::Description<MeasuredMachine>()
      .value({"machine", "machine", "its log"}, [](const MeasuredMachine& m) { return m.name; })
      .value(document::in_data("moves", "its moves that each goal is about, in the order of the goals"),
             &MeasuredMachine::moves)
      .value(document::in_data("met", "of these, those that meet it"), &MeasuredMachine::met)
      .value({.heading = "meet the goal", .shown = document::Shown::to_people, .numeric = true}, met_text);
}

/// "3 to 5", or one number.
std::optional<std::string> measured_text(const StandardValue& value) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double one : value.measured) {
    if (!std::isfinite(one)) continue;
    low = std::min(low, one);
    high = std::max(high, one);
  }
  if (low > high) return std::nullopt;
  if (low == high) return text::short_number(low);
  return fmt::format("{} to {}", text::short_number(low), text::short_number(high));
}

document::Description<StandardValue> standard_rows() {
  using document::Notation;
  return document::Description<StandardValue>()
      .value({"value", "value", "name of the value of the axis"},
             [](const StandardValue& v) { return v.name; })
      .value({"symbol", "symbol", "in the standard"}, [](const StandardValue& v) { return v.symbol; })
      .value({.key = "predicted",
              .heading = "predicted",
              .meaning = "median of the simulated runs",
              .unit = "count",
              .notation = Notation::three_digits},
             &StandardValue::median)
      .value({.key = "predicted_low",
              .heading = "95 % from",
              .meaning = "95 % of the simulated runs have more",
              .unit = "count",
              .notation = Notation::three_digits},
             &StandardValue::low)
      .value({.key = "predicted_high",
              .heading = "to",
              .meaning = "and less",
              .unit = "count",
              .notation = Notation::three_digits},
             &StandardValue::high)
      .value(document::in_data("measured", "of each measured run", "count"), &StandardValue::measured)
      .value({.heading = "measured", .shown = document::Shown::to_people, .numeric = true}, measured_text)
      .value({"within", "runs within", "measured runs in the predicted interval"}, &StandardValue::within)
      .value(document::in_data("runs", "measured runs"),
             [](const StandardValue& v) { return v.measured.size(); });
}

std::string worlds_sentence(const AcceptanceReading& r) {
  if (r.acceptance.worlds == 0) return "";
  std::string text;
  for (const Claim& claim : r.acceptance.claims)
    text += fmt::format(
        "{}: the machines are like those of {} of {} worlds; the prediction is that of the world "
        "that they are most like, with the interval of all\n",
        claim.goal.name.empty() ? "goal" : claim.goal.name, claim.like_worlds.value_or(0),
        r.acceptance.worlds);
  return text;
}

std::string assumed_sentence(const AcceptanceReading& r) {
  if (r.acceptance.assumed.empty()) return "";
  return fmt::format("the prediction assumes: {}", fmt::join(r.acceptance.assumed, ", "));
}

}  // namespace

document::AnswerDescription<AcceptanceReading> acceptance_answer() {
  using document::in_data;
  using Of = const AcceptanceReading&;
  document::AnswerDescription<AcceptanceReading> answer{
      {.name = "accept",
       .meaning = "whether machines that were built meet the goal, and the prediction",
       .csv_table = "goals"},
      {}};
  answer.items.headline(headline_of)
      .value(with_words(in_data("status", "verdict on the machines"), {"accepted", "rejected", "undecided"}),
             [](Of r) { return word_of(status_of(r.acceptance)); })
      .value(with_words(in_data("judged", "machines that the goals are judged for"),
                        {"all_machines", "these_machines"}),
             [](Of r) {
               return r.acceptance.judged == Judged::all_machines ? "all_machines" : "these_machines";
             })
      .value(in_data("needed_machines",
                     "machines, with as many moves each, that would decide the goals for all machines; null: "
                     "they are decided, or no number is known"),
             [](Of r) {
               const std::int64_t needed = r.acceptance.needed_machines;
               return needed > 0 ? std::optional(needed) : std::nullopt;
             })
      .value({.key = "study", .heading = "study", .meaning = "the results file of the prediction"},
             [](Of r) { return r.study; })
      .value({.key = "point", .heading = "point", .meaning = "label of the design point"},
             [](Of r) { return r.point; })
      .value({.key = "simulated_machines",
              .heading = "simulated machines",
              .meaning = "machines of the prediction"},
             [](Of r) { return r.acceptance.simulated; })
      .sentence(sentences_of_goals)
      .table({.key = "goals", .meaning = "each goal"}, claim_rows(),
             [](Of r) {
               std::vector<JudgedClaim> claims;
               for (const Claim& claim : r.acceptance.claims)
                 claims.push_back({claim, r.acceptance.significance});
               return claims;
             })
      .sentence(worlds_sentence)
      .table(
          {.key = "standard",
           .heading = "ISO 230-2, by the encoder",
           .meaning = "values of the axis; empty without a sequence, or without the columns final_error and "
                      "move in every log"},
          standard_rows(), [](Of r) { return r.acceptance.standard_values; })
      .table({.key = "machines", .heading = "machines", .meaning = "each machine that was measured"},
             machine_rows(), [](Of r) { return r.acceptance.machines; })
      .value({.key = "assumed",
              .meaning = "effects that the prediction is without, which its manifest does not name",
              .shown = document::Shown::in_json},
             [](Of r) { return r.acceptance.assumed; })
      .sentence(assumed_sentence)
      .sentence([](Of) {
        return std::string(
            "measured bounds are of moves that do not depend on each other; those of the measured machines "
            "are of "
            "these machines alone, the others of all machines of which they are a sample");
      })
      .sentence([](Of) { return std::string("date, name, signature: ____________________"); });
  return answer;
}

ExitCode exit_code_of(Status status) {
  switch (status) {
    case Status::accepted:
      return ExitCode::success;
    case Status::rejected:
      return ExitCode::regression;
    case Status::undecided:
      break;
  }
  return ExitCode::inconclusive;
}

}  // namespace zerocount::acceptance
