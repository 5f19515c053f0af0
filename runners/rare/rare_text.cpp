#include "runners/rare/rare_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::rare {
namespace {

using Json = nlohmann::ordered_json;

constexpr double least_shift = 0.3;  // of an input that is shown
constexpr std::size_t most_inputs = 8;
constexpr std::int64_t most_replays = 3;

bool is_estimated(const RareAnswer& answer) {
  return answer.estimate.status == EstimateStatus::estimated;
}

/// Whether failures were found and weighted, so that there is a number.
bool has_probability(const RareAnswer& answer) {
  return !answer.state.drawn.empty() && answer.estimate.probability > 0.0;
}

std::int64_t failures_drawn(const EstimatorState& state) {
  return std::ranges::count_if(state.drawn, [](const WeightedTrial& trial) { return trial.failed > 0.0; });
}

std::string event_text(const Question& question) {
  if (!question.event.text.empty()) return fmt::format("of a move with {}", question.event.text);
  return "that a move " + goal::missing_text(goal::question_of(question.study));
}

/// In JSON: the text of the event, or "goal" or "success", which is missed.
std::string event_name(const Question& question) {
  if (!question.event.text.empty()) return question.event.text;
  return std::string(words_of(goal::question_of(question.study)).subject);
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
  for (const study::DiscreteDraw& draw : question.space.discrete) {
    if (draw.values() > max_tried_values) names.push_back(draw.name);
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

std::string premise_of(const Question& question) {
  const std::string untried = untried_draws(question);
  return untried.empty() ? "no failures hide where neither a plain trial nor a score led"
                         : fmt::format(
                               "no failures hide where neither a plain trial nor a score led, nor at single "
                               "values of {}, which are too many to be tried each",
                               untried);
}

std::string status_text(const RareAnswer& answer) {
  const std::string_view reason = reason_of(answer.estimate.status);
  if (is_estimated(answer)) return fmt::format("{}\n", reason);
  std::string text = fmt::format("undecided: {}", reason);
  if (answer.estimate.status == EstimateStatus::budget ||
      answer.estimate.status == EstimateStatus::no_failure)
    text += answer.state.learned ? "; the same command goes on"
                                 : "; the search for failures needs a larger --budget";
  if (answer.max_seconds)
    text += "\na --budget in time makes this answer depend on the machine; one in trials does not";
  return text + '\n';
}

std::string probability_text(const RareAnswer& answer, const Question& question) {
  const Estimate& estimate = answer.estimate;
  const std::string trials = fmt::format("{} trials, {:.3g} s", answer.state.trials, answer.seconds);
  const std::string confidence = fmt::format("{:.4g} %", 100.0 * answer.confidence);
  if (!has_probability(answer))
    return fmt::format("probability {}:\n  at most {:.3g} with {} confidence ({})\n", event_text(question),
                       estimate.bounds.high, confidence, trials) +
           status_text(answer);
  std::string text = fmt::format("probability {}:\n  {:.3g} [{:.3g}, {:.3g}] with {} confidence ({})\n",
                                 event_text(question), estimate.probability, estimate.bounds.low,
                                 estimate.bounds.high, confidence, trials);
  if (is_estimated(answer) && estimate.probability < 0.01)
    text += fmt::format("  one in {:.3g} moves; by plain trials bounds as narrow take about {:.2g}\n",
                        1.0 / estimate.probability, plain_trials_for(estimate, answer.confidence));
  return text + status_text(answer);
}

std::string premise_text(const RareAnswer& answer, const Question& question) {
  const EstimatorState& state = answer.state;
  std::string text;
  if (answer.estimate.plain_high < 1.0)
    text = fmt::format("of {} plain trials {} failed: that alone shows at most {:.2g}\n", state.plain_trials,
                       state.plain_failures == 0 ? "none" : std::to_string(state.plain_failures),
                       answer.estimate.plain_high);
  if (state.learned && state.proposal.is_natural())
    text +=
        "plain trials went on: failures are frequent, or depend too much on chance for a learned "
        "distribution, or none was found to learn from\n";
  if (is_estimated(answer) && !state.proposal.is_natural())
    text += fmt::format("the upper bound assumes that {}; the lower bound holds in any case\n",
                        premise_of(question));
  return text;
}

double rate_of(const PinnedValue& value) {
  return static_cast<double>(value.failures) / static_cast<double>(value.trials);
}

/// The values of discrete draws at which failures are frequent, the most probable failure first.
std::vector<PinnedValue> failing_values(const RareAnswer& answer) {
  std::vector<PinnedValue> values = answer.state.proposal.values;
  std::ranges::stable_sort(values, std::greater<>(), &PinnedValue::weight);
  return values;
}

std::string values_table(const RareAnswer& answer, const Question& question) {
  std::vector<text::TextColumn> columns{
      {"parameter", false, {}}, {"value", true, {}}, {"its probability", true, {}}, {"fails in", true, {}}};
  for (const PinnedValue& one : failing_values(answer)) {
    if (columns[0].cells.size() == most_inputs) break;
    const study::DiscreteDraw& draw = question.space.discrete[one.draw];
    columns[0].cells.push_back(draw.name);
    columns[1].cells.push_back(study::value_text(draw, one.value));
    columns[2].cells.push_back(fmt::format("{:.3g}", one.probability));
    columns[3].cells.push_back(fmt::format("{:.3g} % of {} trials", 100.0 * rate_of(one), one.trials));
  }
  if (columns[0].cells.empty()) return "";
  return "\nsingle values at which failures are frequent:\n\n" + text::aligned_table(columns);
}

std::string scores_table(const RareAnswer& answer, const Question& question) {
  std::vector<text::TextColumn> columns{{"score", false, {}},
                                        {"leads to failures", false, {}},
                                        {"levels", true, {}},
                                        {"probability", true, {}}};
  for (const ScoreSearch& search : answer.state.searches) {
    columns[0].cells.push_back(measures::name_of(measures::move_scores[search.score], question.event));
    columns[1].cells.emplace_back(search.reached ? "yes" : "no");
    columns[2].cells.push_back(std::to_string(search.levels));
    columns[3].cells.push_back(fmt::format("{:.2g}", search.probability));
  }
  if (answer.state.searches.empty()) return "";
  return "\nsearches for failures, each along a score; the probability of the last level has no bounds:\n\n" +
         text::aligned_table(columns);
}

std::string range_text(const InputRange& range) {
  return fmt::format("{:.4g} ({:.4g} to {:.4g})", range.median, range.low, range.high);
}

std::string inputs_table(const RareAnswer& answer) {
  std::vector<text::TextColumn> columns{{"parameter", false, {}},
                                        {"unit", false, {}},
                                        {"failures (5 to 95 %)", false, {}},
                                        {"all trials", false, {}},
                                        {"shift", true, {}}};
  for (const FailureInput& input : answer.inputs) {
    if (std::abs(input.shift) < least_shift || columns[0].cells.size() == most_inputs) break;
    columns[0].cells.push_back(input.name);
    columns[1].cells.push_back(input.unit);
    columns[2].cells.push_back(range_text(input.failures));
    columns[3].cells.push_back(range_text(input.usual));
    columns[4].cells.push_back(fmt::format("{:+.1f}", input.shift));
  }
  if (columns[0].cells.empty()) return "";
  return "\nwhat failures have in common (shift in standard deviations of all trials):\n\n" +
         text::aligned_table(columns);
}

std::string machines_text(const RareAnswer& answer) {
  if (!answer.machines) return "";
  const CarryingMachines& machines = *answer.machines;
  std::string text = fmt::format(
      "\nof {} machines that failed, with {} new moves each, the median fails in {:.3g} % of them",
      machines.examined, machines.moves_each, 100.0 * machines.median_rate);
  if (machines.mostly_failing > 0.0)
    text += fmt::format(
        ";\n{:.3g} % of the failures are on machines that fail in most of their moves, about one "
        "machine in {:.2g}",
        100.0 * machines.mostly_failing, 1.0 / machines.probability_of_one);
  return text + "\n";
}

std::string replays_text(const RareAnswer& answer, const std::string& output) {
  std::string text;
  std::int64_t shown = 0;
  for (std::size_t i = 0; i < answer.state.drawn.size() && shown < most_replays; ++i) {
    if (!(answer.state.drawn[i].failed > 0.0)) continue;
    text += fmt::format("{} --trial {}", shown == 0 ? fmt::format("zerocount trace {}", output) : ",", i);
    ++shown;
  }
  if (shown == 0) return "";
  return fmt::format("\n{} holds {} drawn trials, {} of them failures; for example\n{}\n", output,
                     answer.state.drawn.size(), failures_drawn(answer.state), text);
}

Json range_json(const InputRange& range) {
  return {{"low", range.low}, {"median", range.median}, {"high", range.high}};
}

Json scores_json(const RareAnswer& answer, const Question& question) {
  Json scores = Json::array();
  for (const ScoreSearch& search : answer.state.searches)
    scores.push_back({{"score", measures::name_of(measures::move_scores[search.score], question.event)},
                      {"reached", search.reached},
                      {"probability", search.probability},
                      {"levels", search.levels},
                      {"trials", search.trials}});
  return scores;
}

Json values_json(const RareAnswer& answer, const Question& question) {
  Json values = Json::array();
  for (const PinnedValue& one : failing_values(answer)) {
    const study::DiscreteDraw& draw = question.space.discrete[one.draw];
    values.push_back({{"parameter", draw.name},
                      {"value", study::value_text(draw, one.value)},
                      {"probability", one.probability},
                      {"failures", one.failures},
                      {"trials", one.trials}});
  }
  return values;
}

Json machines_json(const RareAnswer& answer) {
  if (!answer.machines) return {};
  const CarryingMachines& machines = *answer.machines;
  return {{"examined", machines.examined},
          {"moves_each", machines.moves_each},
          {"median_rate", machines.median_rate},
          {"mostly_failing", machines.mostly_failing},
          {"probability_of_one", machines.probability_of_one}};
}

}  // namespace

std::string json_of(const RareAnswer& answer, const Question& question) {
  const Estimate& estimate = answer.estimate;
  Json inputs = Json::array();
  for (const FailureInput& input : answer.inputs)
    inputs.push_back({{"parameter", input.name},
                      {"unit", input.unit},
                      {"shift", input.shift},
                      {"failures", range_json(input.failures)},
                      {"usual", range_json(input.usual)}});
  return text::json_text({{"probability", has_probability(answer) ? Json(estimate.probability) : Json()},
                          {"low", estimate.bounds.low},
                          {"high", estimate.bounds.high},
                          {"trials", answer.state.trials},
                          {"status", is_estimated(answer) ? "estimated" : "undecided"},
                          {"reason", reason_of(estimate.status)},
                          {"premise", is_estimated(answer) && !answer.state.proposal.is_natural()
                                          ? Json("high: " + premise_of(question))
                                          : Json()},
                          {"budget",
                           {{"trials", answer.max_trials ? Json(*answer.max_trials) : Json()},
                            {"seconds", answer.max_seconds ? Json(*answer.max_seconds) : Json()}}},
                          {"confidence", answer.confidence},
                          {"event", event_name(question)},
                          {"point", question.point},
                          {"label", question.study.point_labels[static_cast<std::size_t>(question.point)]},
                          {"world", question.world ? Json(*question.world) : Json()},
                          {"plain",
                           {{"trials", answer.state.plain_trials},
                            {"failures", answer.state.plain_failures},
                            {"high", estimate.plain_high}}},
                          {"scores", scores_json(answer, question)},
                          {"drawn", answer.state.drawn.size()},
                          {"failures_drawn", failures_drawn(answer.state)},
                          {"values", values_json(answer, question)},
                          {"inputs", std::move(inputs)},
                          {"machines", machines_json(answer)},
                          {"seconds", answer.seconds}});
}

std::string text_of(const RareAnswer& answer, const Question& question, const std::string& output) {
  return probability_text(answer, question) + premise_text(answer, question) +
         scores_table(answer, question) + values_table(answer, question) + inputs_table(answer) +
         machines_text(answer) + replays_text(answer, output);
}

std::string progress_text(const Estimate& estimate, const EstimatorState& state) {
  if (!state.learned) return fmt::format("learns where failures are: {} trials", state.trials);
  return fmt::format("{} trials: {:.2g} [{:.2g}, {:.2g}]", state.trials, estimate.probability,
                     estimate.bounds.low, estimate.bounds.high);
}

}  // namespace zerocount::rare
