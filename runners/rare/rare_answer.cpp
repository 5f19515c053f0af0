#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/text/text.hpp"
#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using document::Notation;
using document::Visibility;
using document::with_words;

constexpr std::size_t max_replays = 3;

bool is_estimated(const RareAnswer& answer) {
  return answer.estimate.status == EstimateStatus::estimated;
}

/// Whether the answer has an estimate of the probability: failures were found and weighted.
bool has_probability(const RareAnswer& answer) {
  return !answer.state.drawn.empty() && answer.estimate.probability > 0.0;
}

std::string_view reason_of(const RareAnswer& answer) {
  switch (answer.estimate.status) {
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

/// Assumption under which the upper bound of the probability holds; nothing if the answer does not depend on
/// a learned proposal.
std::optional<std::string> premise_of(const RareAnswer& answer) {
  if (!is_estimated(answer) || answer.state.proposal.is_natural()) return std::nullopt;
  std::vector<std::string> untried;
  for (const randomness::DiscreteDraw& draw : answer.question.space.discrete) {
    if (draw.values() > max_tried_values) untried.push_back(draw.name);
  }
  return "high: every kind of failure was reached by a plain trial or by a score" +
         (untried.empty()
              ? ""
              : fmt::format(", and none is at single values of {}, which are too many to be tried each",
                            fmt::join(untried, " and ")));
}

// Sentences.

std::string headline(const RareAnswer& answer) {
  const Question& question = answer.question;
  const ProbabilityEstimate& estimate = answer.estimate;
  const std::string number = has_probability(answer)
                                 ? fmt::format("{:.3g} [{:.3g}, {:.3g}]", estimate.probability,
                                               estimate.bounds.low, estimate.bounds.high)
                                 : fmt::format("at most {:.3g}", estimate.bounds.high);
  const std::string event = !question.event.is_about_measure()
                                ? goal::missing_text(goal::question_of(question.study))
                                : "has " + question.event.text;
  return fmt::format("the probability is {}, with {} confidence, that a move {}{}", number,
                     text::percent(answer.settings.confidence), event,
                     study::setting_phrase(question.whole.settings, question.of.setting.value_or(0)));
}

std::string undecided_sentence(const RareAnswer& answer) {
  if (is_estimated(answer)) return "";
  std::string text = fmt::format("undecided: {}", reason_of(answer));
  if (answer.estimate.status == EstimateStatus::budget ||
      answer.estimate.status == EstimateStatus::no_failure)
    text += answer.state.learned && !answer.settings.output.empty()
                ? "; the same command goes on"
                : "; the search for failures needs a larger --budget";
  if (answer.settings.seconds)
    text += "\na --budget in time makes this answer depend on the machine; one in trials does not";
  return text;
}

/// Sentence that says how many moves there are per failure, and how many plain trials would give equally
/// narrow bounds. Empty without an estimate, or for a probability of 1 % and more. With k failures, plain
/// trials give a ratio high/low of about exp(2·z/√k).
std::string plain_need_sentence(const RareAnswer& answer) {
  const auto& [low, high] = answer.estimate.bounds;
  const double probability = answer.estimate.probability;
  if (!has_probability(answer) || !is_estimated(answer) || probability >= 0.01) return "";
  const double z = numerics::normal_quantile(0.5 + 0.5 * answer.settings.confidence);
  return fmt::format("one in {:.3g} moves; by plain trials bounds as narrow take about {:.2g}",
                     1.0 / probability, std::pow(2.0 * z / std::log(high / low), 2.0) / probability);
}

std::string plain_sentence(const RareAnswer& answer) {
  if (!answer.state.learned || !answer.state.proposal.is_natural()) return "";
  return "plain trials went on: failures are frequent, or depend too much on chance for a learned "
         "distribution, or none was found to learn from";
}

std::string replays_sentence(const RareAnswer& answer) {
  const std::vector<Trial>& drawn = answer.state.drawn;
  const std::filesystem::path& output = answer.settings.output;
  std::vector<std::string> replays;
  for (std::size_t i = 0; i < drawn.size() && replays.size() < max_replays; ++i) {
    if (drawn[i].failed > 0.0) replays.push_back(fmt::format("--trial {}", i));
  }
  if (replays.empty() || output.empty()) return "";
  return fmt::format("{} holds {} drawn trials, {} of them failures; for example\nzerocount trace {} {}",
                     output.string(), drawn.size(), answer.state.failures(), text::shell_path(output),
                     fmt::join(replays, ", "));
}

// Tables and objects.

/// One item of a list in an answer, together with the question that gives the names of its scores or draws.
template <class Part>
struct PartOf {
  Part part;
  const Question& question;
};

template <class Part>
std::vector<PartOf<Part>> parts_of(const std::vector<Part>& parts, const Question& question) {
  std::vector<PartOf<Part>> rows;
  rows.reserve(parts.size());
  for (const Part& part : parts) rows.push_back({part, question});
  return rows;
}

Description<PartOf<ScoreSearch>> search_columns() {
  return Description<PartOf<ScoreSearch>>()
      .value(everywhere("score", "score", "quantity that leads towards failures"),
             [](const PartOf<ScoreSearch>& row) {
               return measures::name_of(measures::move_scores[row.part.score], row.question.event);
             })
      .value(everywhere("reached", "leads to failures", "whether failures were reached"),
             [](const PartOf<ScoreSearch>& row) { return row.part.reached; })
      .value(everywhere("levels", "levels", "levels of the search"),
             [](const PartOf<ScoreSearch>& row) { return row.part.levels; })
      .value({.key = "probability",
              .heading = "probability",
              .meaning = "probability of the last level, without bounds",
              .unit = "1",
              .notation = Notation::two_digits},
             [](const PartOf<ScoreSearch>& row) { return row.part.probability; })
      .value(in_data("trials", "trials of the search"),
             [](const PartOf<ScoreSearch>& row) { return row.part.trials; });
}

/// The discrete draws' values at which failures are frequent, sorted by decreasing probability of the
/// failure.
std::vector<PartOf<PinnedValue>> value_rows(const RareAnswer& answer) {
  std::vector<PinnedValue> values = answer.state.proposal.values;
  std::ranges::stable_sort(values, std::greater<>(), &PinnedValue::weight);
  return parts_of(values, answer.question);
}

Description<PartOf<PinnedValue>> value_columns() {
  const auto draw_of = [](const PartOf<PinnedValue>& row) -> const randomness::DiscreteDraw& {
    return row.question.space.discrete[row.part.draw];
  };
  return Description<PartOf<PinnedValue>>()
      .value(everywhere("parameter", "parameter", "parameter with single values"),
             [draw_of](const PartOf<PinnedValue>& row) { return draw_of(row).name; })
      .value(everywhere("value", "value", "value at which failures are frequent"),
             [draw_of](const PartOf<PinnedValue>& row) {
               return randomness::value_text(draw_of(row), row.part.value);
             })
      .value({.key = "probability",
              .heading = "its probability",
              .meaning = "probability of the value",
              .unit = "1",
              .notation = Notation::three_digits},
             [](const PartOf<PinnedValue>& row) { return row.part.probability; })
      .value(everywhere("failures", "failures", "trials at the value that failed"),
             [](const PartOf<PinnedValue>& row) { return row.part.failures; })
      .value(everywhere("trials", "of trials", "trials at the value"),
             [](const PartOf<PinnedValue>& row) { return row.part.trials; });
}

std::string range_text(const InputRange& range) {
  return fmt::format("{:.4g} ({:.4g} to {:.4g})", range.median, range.low, range.high);
}

Description<FailureInput> input_columns() {
  const auto range =
      Description<InputRange>()
          .value(in_data("low", "5 % quantile, in the unit of the parameter"), &InputRange::low)
          .value(in_data("median", "median"), &InputRange::median)
          .value(in_data("high", "95 % quantile"), &InputRange::high);
  return Description<FailureInput>()
      .value(everywhere("parameter", "parameter", "dotted path of the parameter"), &FailureInput::name)
      .value(everywhere("unit", "unit", "its unit"), &FailureInput::unit)
      .value({.key = "shift",
              .heading = "shift",
              .meaning = "standard deviations by which failures lie above the median of all trials",
              .unit = "1",
              .notation = Notation::change},
             &FailureInput::shift)
      .object(everywhere("failures", "failures (5 to 95 %)", "quantiles in failures"), range,
              &FailureInput::failures)
      .shown_as([](const FailureInput& input) { return range_text(input.failures); })
      .object(everywhere("usual", "all trials", "quantiles in all trials"), range, &FailureInput::usual)
      .shown_as([](const FailureInput& input) { return range_text(input.usual); });
}

Description<RareAnswer> plain_description() {
  return Description<RareAnswer>()
      .value(everywhere("trials", "trials", "trials drawn from their own distribution"),
             [](const RareAnswer& a) { return a.state.plain_trials; })
      .value(everywhere("failures", "failures", "those with a move that failed"),
             [](const RareAnswer& a) { return a.state.plain_failures; })
      .value(everywhere("high", "that alone shows at most", "upper bound by these alone", "1"),
             [](const RareAnswer& a) { return a.estimate.plain_high; })
      .sentence(plain_sentence);
}

Description<CarryingMachines> machines_description() {
  using Machines = CarryingMachines;
  const auto proportion = [](std::string key, std::string heading, std::string meaning) {
    document::Item item = everywhere(std::move(key), std::move(heading), std::move(meaning), "1");
    item.notation = Notation::percent;
    return item;
  };
  return Description<Machines>()
      .value(everywhere("examined", "machines", "machines, drawn from the failures"), &Machines::examined)
      .value(everywhere("moves_each", "new moves of each", "new moves of each"), &Machines::moves_each)
      .value(
          proportion("median_rate", "failing moves, median", "median of their proportions of failing moves"),
          &Machines::median_rate)
      .value(proportion("mostly_failing", "failures on machines that fail in most moves",
                        "proportion of the failures on machines that fail in most of their moves"),
             &Machines::mostly_failing)
      .value(everywhere("probability_of_one", "probability of such a machine",
                        "probability of such a machine", "1"),
             &Machines::probability_of_one);
}

/// Adds the probability with its bounds, and how it was found, to the description of the answer.
void add_probability(Description<RareAnswer>& items) {
  items.headline(headline)
      .value(in_data("probability",
                     "probability of the event in a move; unknown where no failure was weighted", "1"),
             [](const RareAnswer& a) {
               return has_probability(a) ? std::optional(a.estimate.probability) : std::nullopt;
             })
      .value(in_data("low", "its lower bound", "1"),
             [](const RareAnswer& a) { return a.estimate.bounds.low; })
      .value(in_data("high", "its upper bound", "1"),
             [](const RareAnswer& a) { return a.estimate.bounds.high; })
      .sentence(undecided_sentence)
      .sentence(plain_need_sentence)
      .value({.key = "trials", .heading = "trials", .meaning = "trials that were run"},
             [](const RareAnswer& a) { return a.state.trials; })
      .value(with_words(in_data("status", "whether the bounds are as narrow as asked"),
                        {"estimated", "undecided"}),
             [](const RareAnswer& a) { return is_estimated(a) ? "estimated" : "undecided"; })
      .value(in_data("reason", "why it ended"), reason_of)
      .value({.key = "premise", .heading = "assumed", .meaning = "what a bound assumes"}, premise_of)
      .object(in_data("budget", "what it could spend"),
              Description<RareSettings>()
                  .value(in_data("trials", "trials of this run"), &RareSettings::max_trials)
                  .value(in_data("seconds", "time of this run", "s"), &RareSettings::seconds),
              &RareAnswer::settings)
      .value(in_data("confidence", "confidence of both bounds together", "1"),
             [](const RareAnswer& a) { return a.settings.confidence; })
      .value({.key = "seconds",
              .heading = "time",
              .meaning = "time of all runs",
              .unit = "s",
              .notation = Notation::three_digits},
             &RareAnswer::seconds);
}

void add_question(Description<RareAnswer>& items) {
  items
      .value(in_data("event", "the event; goal, success: it is missed"),
             [](const RareAnswer& a) {
               const Question& question = a.question;
               return !question.event.is_about_measure()
                          ? std::string(goal::question_of(question.study).goal() ? "goal" : "success")
                          : question.event.text;
             })
      .value(in_data("point", "number of the design point"),
             [](const RareAnswer& a) { return a.question.of.point; })
      .value(in_data("label", "label of the design point"),
             [](const RareAnswer& a) {
               return a.question.study.points.labels[static_cast<std::size_t>(a.question.of.point)];
             })
      .value(in_data("world", "the world, of a study with worlds"),
             [](const RareAnswer& a) { return a.question.of.world; })
      .value({.key = "condition",
              .meaning = "the condition, of a study with conditions",
              .shown = Visibility::in_data,
              .optional = true},
             [](const RareAnswer& a) -> std::optional<std::string> {
               if (!a.question.of.setting) return {};
               return study::label_of(a.question.whole.settings, *a.question.of.setting);
             });
}

void add_failures(Description<RareAnswer>& items) {
  items
      .object(everywhere("plain", "plain trials", "what the plain trials show"), plain_description(),
              [](const RareAnswer& a) -> const RareAnswer& { return a; })
      .table(
          {.key = "scores",
           .heading =
               "searches for failures, each along a score; the probability of the last level has no bounds",
           .meaning = "searches for failures along scores"},
          search_columns(), [](const RareAnswer& a) { return parts_of(a.state.searches, a.question); })
      .table({.key = "values",
              .heading = "single values at which failures are frequent",
              .meaning = "single values at which failures are frequent"},
             value_columns(), value_rows)
      .table(everywhere("inputs", "what failures have in common (shift in standard deviations of all trials)",
                        "inputs that differ between trials, the most shifted first"),
             input_columns(), &RareAnswer::inputs)
      .object(everywhere("machines", "machines that failed", "machines that carry the probability"),
              machines_description(), &RareAnswer::machines)
      .value(in_data("drawn", "weighted trials in the file"),
             [](const RareAnswer& a) { return a.state.drawn.size(); })
      .value(in_data("failures_drawn", "those that failed"),
             [](const RareAnswer& a) { return a.state.failures(); })
      .sentence(replays_sentence)
      .figures([](const RareAnswer& a) { return rare_figures(a.inputs); });
}

}  // namespace

document::AnswerDescription<RareAnswer> rare_answer() {
  document::AnswerDescription<RareAnswer> answer{
      {.name = "rare", .meaning = "the probability of a rare failure", .csv_table = "inputs"}, {}};
  add_probability(answer.items);
  add_question(answer.items);
  add_failures(answer.items);
  return answer;
}

std::vector<document::Figure> rare_figures(const std::vector<FailureInput>& inputs) {
  using report::datum;
  document::FigureData data{"inputs",
                            {{"parameter", "parameter", ""},
                             {"trials", "of", ""},
                             {"low", "5 %", ""},
                             {"median", "median", ""},
                             {"high", "95 %", ""},
                             {"unit", "unit", ""},
                             {"low_place", "", ""},
                             {"median_place", "", ""},
                             {"high_place", "", ""}}};
  for (const FailureInput& input : inputs) {
    const double size = input.usual.high - input.usual.low;
    if (!(size > 0.0)) continue;
    const auto place = [&](double value) { return datum((value - input.usual.low) / size); };
    for (const auto& [trials, of] : {std::pair("all trials", input.usual), {"failures", input.failures}})
      data.rows.push_back({input.name, trials, datum(of.low), datum(of.median), datum(of.high), input.unit,
                           place(of.low), place(of.median), place(of.high)});
  }
  if (data.rows.empty()) return {};
  return {report::figure_of("rare-inputs", "rare-inputs", "What failures have in common",
                            "Medians and 5 % to 95 % of the inputs in failures and in all "
                            "trials. 0 % and 100 % are the ends of the "
                            "range of all trials.",
                            {std::move(data)})};
}

}  // namespace zerocount::rare
