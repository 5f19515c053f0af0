#include "runners/rare/rare_answer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/text/percent.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/text/shell_word.hpp"

namespace zerocount::rare {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using document::Shown;
using document::with_words;

using Of = const RareReading&;

constexpr double min_shift = 0.3;  // of an input that is shown
constexpr std::size_t max_inputs = 8;
constexpr std::size_t max_replays = 3;

bool is_estimated(const RareAnswer& answer) {
  return answer.estimate.status == EstimateStatus::estimated;
}

/// Whether failures were found and weighted, so that there is a number.
bool has_probability(const RareAnswer& answer) {
  return !answer.state.drawn.empty() && answer.estimate.probability > 0.0;
}

/// Whether the answer rests on what was learned.
bool is_learned(const RareAnswer& answer) {
  return is_estimated(answer) && !answer.state.proposal.is_natural();
}

std::int64_t failures_drawn(const EstimatorState& state) {
  return std::ranges::count_if(state.drawn, [](const WeightedTrial& trial) { return trial.failed > 0.0; });
}

std::string event_text(const Question& question) {
  if (!question.event.text.empty()) return fmt::format("has {}", question.event.text);
  return goal::missing_text(goal::question_of(question.study));
}

std::string_view reason_of(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::estimated:
      return "the bounds are as narrow as asked";
    case EstimateStatus::no_failure:
      return "no score leads to a failure, and no plain trial failed";
    case EstimateStatus::not_covered:
      return "there are failures that the learned distribution does not foresee; another seed may help";
    case EstimateStatus::too_many:
      return "the bounds are too wide after as many trials as the file can hold";
    case EstimateStatus::budget:
      return "the budget ended first";
  }
  return "";
}

/// Plain trials with bounds that have the same ratio: of k failures high/low is about exp(2·z/√k).
double plain_trials_for(const Estimate& estimate, double confidence) {
  const double z = numerics::normal_quantile(0.5 + 0.5 * confidence);
  const double failures = std::pow(2.0 * z / std::log(estimate.bounds.high / estimate.bounds.low), 2.0);
  return failures / estimate.probability;
}

/// Discrete draws with more values than are tried one by one, as "a and b"; empty if there are none.
std::string untried_draws(const Question& question) {
  std::vector<std::string> names;
  for (const randomness::DiscreteDraw& draw : question.space.discrete) {
    if (draw.values() > max_tried_values) names.push_back(draw.name);
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

std::string premise_of(const Question& question) {
  const std::string untried = untried_draws(question);
  return "every kind of failure was reached by a plain trial or by a score" +
         (untried.empty()
              ? ""
              : fmt::format(", and none is at single values of {}, which are too many to be tried each",
                            untried));
}

// Sentences.

std::string rare_headline(Of r) {
  const Estimate& estimate = r.answer.estimate;
  const std::string number = has_probability(r.answer)
                                 ? fmt::format("{:.3g} [{:.3g}, {:.3g}]", estimate.probability,
                                               estimate.bounds.low, estimate.bounds.high)
                                 : fmt::format("at most {:.3g}", estimate.bounds.high);
  return fmt::format("the probability is {}, with {} confidence, that a move {}{}", number,
                     text::percent(r.answer.confidence), event_text(r.question),
                     study::condition_text(r.question.whole, r.question.of.condition.value_or(0)));
}

std::string status_sentence(Of r) {
  const RareAnswer& answer = r.answer;
  const std::string_view reason = reason_of(answer.estimate.status);
  if (is_estimated(answer)) return std::string(reason);
  std::string text = fmt::format("undecided: {}", reason);
  if (answer.estimate.status == EstimateStatus::budget ||
      answer.estimate.status == EstimateStatus::no_failure)
    text += answer.state.learned && !r.output.empty() ? "; the same command goes on"
                                                      : "; the search for failures needs a larger --budget";
  if (answer.max_seconds)
    text += "\na --budget in time makes this answer depend on the machine; one in trials does not";
  return text;
}

std::string plain_need_sentence(Of r) {
  const Estimate& estimate = r.answer.estimate;
  if (!has_probability(r.answer) || !is_estimated(r.answer) || estimate.probability >= 0.01) return "";
  return fmt::format("one in {:.3g} moves; by plain trials bounds as narrow take about {:.2g}",
                     1.0 / estimate.probability, plain_trials_for(estimate, r.answer.confidence));
}

std::string plain_sentence(Of r) {
  const EstimatorState& state = r.answer.state;
  std::string text;
  if (r.answer.estimate.plain_high < 1.0)
    text = fmt::format("of {} plain trials {} failed: that alone shows at most {:.2g}\n", state.plain_trials,
                       state.plain_failures == 0 ? "none" : std::to_string(state.plain_failures),
                       r.answer.estimate.plain_high);
  if (state.learned && state.proposal.is_natural())
    text +=
        "plain trials went on: failures are frequent, or depend too much on chance for a learned "
        "distribution, or none was found to learn from\n";
  return text;
}

std::string simulated_sentence(Of r) {
  return fmt::format(
      "simulated: {} trials, each on a machine of its own: {} plain ones, the others driven towards "
      "failures{}",
      r.answer.state.trials, r.answer.state.plain_trials,
      is_learned(r.answer) ? ", or drawn from what these showed and weighted" : "");
}

std::string premise_sentence(Of r) {
  if (!is_learned(r.answer)) return "";
  return fmt::format("the upper bound assumes that {}; the lower bound holds in any case",
                     premise_of(r.question));
}

std::string machines_sentence(Of r) {
  if (!r.answer.machines) return "";
  const CarryingMachines& machines = *r.answer.machines;
  std::string text =
      fmt::format("of {} machines that failed, with {} new moves each, the median fails in {:.3g} % of them",
                  machines.examined, machines.moves_each, 100.0 * machines.median_rate);
  if (machines.mostly_failing > 0.0)
    text += fmt::format(
        "; {:.3g} % of the failures are on machines that fail in most of their moves, about one machine in "
        "{:.2g}",
        100.0 * machines.mostly_failing, 1.0 / machines.probability_of_one);
  return text;
}

std::string replays_sentence(Of r) {
  const std::vector<WeightedTrial>& drawn = r.answer.state.drawn;
  std::vector<std::string> replays;
  for (std::size_t i = 0; i < drawn.size() && replays.size() < max_replays; ++i) {
    if (drawn[i].failed > 0.0) replays.push_back(fmt::format("--trial {}", i));
  }
  if (replays.empty() || r.output.empty()) return "";
  return fmt::format("{0} holds {1} drawn trials, {2} of them failures; for example\nzerocount trace {3} {4}",
                     r.output.string(), drawn.size(), failures_drawn(r.answer.state),
                     text::shell_path(r.output), fmt::join(replays, ", "));
}

// Tables.

struct SearchRow {
  const ScoreSearch& search;
  const Question& question;
};

std::vector<SearchRow> search_rows(Of r) {
  std::vector<SearchRow> rows;
  for (const ScoreSearch& search : r.answer.state.searches) rows.push_back({search, r.question});
  return rows;
}

Description<SearchRow> search_columns() {
  using Row = const SearchRow&;
  return Description<SearchRow>()
      .value({.key = "score", .heading = "score", .meaning = "quantity that leads towards failures"},
             [](Row row) {
               return measures::name_of(measures::move_scores[row.search.score], row.question.event);
             })
      .value({.key = "reached", .heading = "leads to failures", .meaning = "whether failures were reached"},
             [](Row row) { return row.search.reached; })
      .value({.key = "levels", .heading = "levels", .meaning = "levels of the search"},
             [](Row row) { return row.search.levels; })
      .value({.key = "probability",
              .heading = "probability",
              .meaning = "probability of the last level, without bounds",
              .unit = "1",
              .notation = Notation::two_digits},
             [](Row row) { return row.search.probability; })
      .value(in_data("trials", "trials of the search"), [](Row row) { return row.search.trials; });
}

struct ValueRow {
  PinnedValue pinned;
  const randomness::DiscreteDraw& draw;
};

/// The values of discrete draws at which failures are frequent, the most probable failure first.
std::vector<ValueRow> value_rows(Of r) {
  std::vector<PinnedValue> values = r.answer.state.proposal.values;
  std::ranges::stable_sort(values, std::greater<>(), &PinnedValue::weight);
  std::vector<ValueRow> rows;
  rows.reserve(values.size());
  for (const PinnedValue& one : values) rows.push_back({one, r.question.space.discrete[one.draw]});
  return rows;
}

Description<ValueRow> value_columns() {
  using Row = const ValueRow&;
  return Description<ValueRow>()
      .value({.key = "parameter", .heading = "parameter", .meaning = "parameter with single values"},
             [](Row row) { return row.draw.name; })
      .value({.key = "value", .heading = "value", .meaning = "value at which failures are frequent"},
             [](Row row) { return randomness::value_text(row.draw, row.pinned.value); })
      .value({.key = "probability",
              .heading = "its probability",
              .meaning = "probability of the value",
              .unit = "1",
              .notation = Notation::three_digits},
             [](Row row) { return row.pinned.probability; })
      .value({.key = "failures", .heading = "failures", .meaning = "trials at the value that failed"},
             [](Row row) { return row.pinned.failures; })
      .value({.key = "trials", .heading = "of trials", .meaning = "trials at the value"},
             [](Row row) { return row.pinned.trials; });
}

/// The first rows, for people.
template <class Row>
std::vector<Row> first_rows(std::vector<Row> rows) {
  while (rows.size() > max_inputs) rows.pop_back();
  return rows;
}

std::vector<FailureInput> shifted_inputs(Of r) {
  std::vector<FailureInput> inputs = r.answer.inputs;
  std::erase_if(inputs, [](const FailureInput& input) { return std::abs(input.shift) < min_shift; });
  return first_rows(std::move(inputs));
}

std::string range_text(const InputRange& range) {
  return fmt::format("{:.4g} ({:.4g} to {:.4g})", range.median, range.low, range.high);
}

Description<InputRange> range_description() {
  return Description<InputRange>()
      .value(in_data("low", "5 % quantile, in the unit of the parameter"), &InputRange::low)
      .value(in_data("median", "median"), &InputRange::median)
      .value(in_data("high", "95 % quantile"), &InputRange::high);
}

Description<FailureInput> input_columns() {
  using Input = const FailureInput&;
  return Description<FailureInput>()
      .value({.key = "parameter", .heading = "parameter", .meaning = "dotted path of the parameter"},
             &FailureInput::name)
      .value({.key = "unit", .heading = "unit", .meaning = "its unit"}, &FailureInput::unit)
      .value({.heading = "failures (5 to 95 %)", .shown = Shown::to_people},
             [](Input input) { return range_text(input.failures); })
      .value({.heading = "all trials", .shown = Shown::to_people},
             [](Input input) { return range_text(input.usual); })
      .value({.key = "shift",
              .heading = "shift",
              .meaning = "standard deviations by which failures lie above the median of all trials",
              .unit = "1",
              .notation = Notation::change},
             &FailureInput::shift)
      .object(in_data("failures", "quantiles in failures"), range_description(), &FailureInput::failures)
      .object(in_data("usual", "quantiles in all trials"), range_description(), &FailureInput::usual);
}

// Objects.

Description<RareAnswer> budget_description() {
  return Description<RareAnswer>()
      .value(in_data("trials", "trials of this run"), &RareAnswer::max_trials)
      .value(in_data("seconds", "time of this run", "s"), &RareAnswer::max_seconds);
}

Description<RareAnswer> plain_description() {
  using Answer = const RareAnswer&;
  return Description<RareAnswer>()
      .value(in_data("trials", "trials drawn from their own distribution"),
             [](Answer a) { return a.state.plain_trials; })
      .value(in_data("failures", "those with a move that failed"),
             [](Answer a) { return a.state.plain_failures; })
      .value(in_data("high", "upper bound by these alone", "1"),
             [](Answer a) { return a.estimate.plain_high; });
}

Description<CarryingMachines> machines_description() {
  using Machines = CarryingMachines;
  return Description<Machines>()
      .value(in_data("examined", "machines, drawn from the failures"), &Machines::examined)
      .value(in_data("moves_each", "new moves of each"), &Machines::moves_each)
      .value(in_data("median_rate", "median of their proportions of failing moves", "1"),
             &Machines::median_rate)
      .value(in_data("mostly_failing",
                     "proportion of the failures on machines that fail in most of their moves", "1"),
             &Machines::mostly_failing)
      .value(in_data("probability_of_one", "probability of such a machine", "1"),
             &Machines::probability_of_one);
}

void add_probability(Description<RareReading>& items) {
  items.headline(rare_headline)
      .value(in_data("probability",
                     "probability of the event in a move; unknown where no failure was weighted", "1"),
             [](Of r) {
               return has_probability(r.answer) ? std::optional(r.answer.estimate.probability) : std::nullopt;
             })
      .value(in_data("low", "its lower bound", "1"), [](Of r) { return r.answer.estimate.bounds.low; })
      .value(in_data("high", "its upper bound", "1"), [](Of r) { return r.answer.estimate.bounds.high; })
      .sentence(status_sentence)
      .sentence(plain_need_sentence)
      .value({.key = "trials", .heading = "trials", .meaning = "trials that were run"},
             [](Of r) { return r.answer.state.trials; })
      .value(with_words(in_data("status", "whether the bounds are as narrow as asked"),
                        {"estimated", "undecided"}),
             [](Of r) { return is_estimated(r.answer) ? "estimated" : "undecided"; })
      .value(in_data("reason", "why it ended"), [](Of r) { return reason_of(r.answer.estimate.status); })
      .value(in_data("premise", "what a bound assumes"),
             [](Of r) {
               return is_learned(r.answer) ? std::optional("high: " + premise_of(r.question)) : std::nullopt;
             })
      .object(in_data("budget", "what it could spend"), budget_description(),
              [](Of r) -> const RareAnswer& { return r.answer; })
      .value(in_data("confidence", "confidence of both bounds together", "1"),
             [](Of r) { return r.answer.confidence; });
}

void add_question(Description<RareReading>& items) {
  items
      .value(in_data("event", "the event; goal, success: it is missed"),
             [](Of r) {
               return r.question.event.text.empty()
                          ? std::string(goal::words_of(goal::question_of(r.question.study)).subject)
                          : r.question.event.text;
             })
      .value(in_data("point", "number of the design point"), [](Of r) { return r.question.of.point; })
      .value(
          in_data("label", "label of the design point"),
          [](Of r) { return r.question.study.points.labels[static_cast<std::size_t>(r.question.of.point)]; })
      .value(in_data("world", "the world, of a study with worlds"), [](Of r) { return r.question.of.world; })
      .value({.key = "condition",
              .meaning = "the condition, of a study with conditions",
              .shown = Shown::in_data,
              .optional = true},
             [](Of r) -> std::optional<std::string> {
               if (!r.question.of.condition) return {};
               return r.question.whole.conditions[static_cast<std::size_t>(*r.question.of.condition)];
             });
}

void add_failures(Description<RareReading>& items) {
  items.table(in_data("values", "single values at which failures are frequent"), value_columns(), value_rows)
      .table({.heading = "single values at which failures are frequent", .shown = Shown::to_people},
             value_columns(), [](Of r) { return first_rows(value_rows(r)); })
      .table(in_data("inputs", "inputs that differ between trials, the most shifted first"), input_columns(),
             [](Of r) -> const std::vector<FailureInput>& { return r.answer.inputs; })
      .table({.heading = "what failures have in common (shift in standard deviations of all trials)",
              .shown = Shown::to_people},
             input_columns(), shifted_inputs)
      .object(in_data("machines", "machines that carry the probability"), machines_description(),
              [](Of r) -> const std::optional<CarryingMachines>& { return r.answer.machines; })
      .sentence(machines_sentence)
      .value(in_data("drawn", "weighted trials in the file"),
             [](Of r) { return r.answer.state.drawn.size(); })
      .value(in_data("failures_drawn", "those that failed"),
             [](Of r) { return failures_drawn(r.answer.state); })
      .sentence(replays_sentence);
}

}  // namespace

Description<RareReading> rare_description() {
  Description<RareReading> items;
  add_probability(items);
  items.value({.key = "seconds",
               .heading = "time",
               .meaning = "time of all runs",
               .unit = "s",
               .notation = Notation::three_digits},
              [](Of r) { return r.answer.seconds; });
  add_question(items);
  items
      .object(in_data("plain", "what the plain trials show"), plain_description(),
              [](Of r) -> const RareAnswer& { return r.answer; })
      .sentence(plain_sentence)
      .sentence(simulated_sentence)
      .sentence(premise_sentence)
      .table(
          {.key = "scores",
           .heading =
               "searches for failures, each along a score; the probability of the last level has no bounds",
           .meaning = "searches for failures along scores"},
          search_columns(), search_rows);
  add_failures(items);
  return items;
}

std::string progress_text(const Estimate& estimate, const EstimatorState& state) {
  if (!state.learned) return fmt::format("learns where failures are: {} trials", state.trials);
  return fmt::format("{} trials: {:.2g} [{:.2g}, {:.2g}]", state.trials, estimate.probability,
                     estimate.bounds.low, estimate.bounds.high);
}

}  // namespace zerocount::rare
