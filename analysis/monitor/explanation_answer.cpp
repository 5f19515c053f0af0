#include "analysis/monitor/explanation_answer.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/percent.hpp"

namespace zerocount::monitor {
namespace {

/// "12 to 20 %", "0.08 to 0.12 counts"; an end that is nothing is left out.
std::string interval_text(const ParameterChange& change, double least, double most, bool beyond) {
  const std::string unit = change.kind == ChangeKind::factor ? " %"
                           : change.unit.empty()             ? ""
                                                             : " " + change.unit;
  if (beyond) return fmt::format("at least {:.2g}{}", least, unit);
  return fmt::format("{:.2g} to {:.2g}{}", least, most, unit);
}

/// "friction.k1 lower by 12 to 20 %", "encoder.fine_errors.noise higher by 0.08 to 0.12 count".
std::string change_text(const ParameterChange& change) {
  const bool is_factor = change.kind == ChangeKind::factor;
  const auto off = [&](double end) { return is_factor ? 100.0 * std::abs(end - 1.0) : std::abs(end); };
  const double unchanged = unchanged_by(change.kind);
  const bool lower = change.high <= unchanged;
  if (!lower && change.low < unchanged) {
    const std::string unit = is_factor ? " %" : change.unit.empty() ? "" : " " + change.unit;
    return fmt::format("{} between {:.2g}{} lower and {:.2g}{} higher", change.parameter, off(change.low),
                       unit, off(change.high), unit);
  }
  return fmt::format(
      "{} {} by {}", change.parameter, lower ? "lower" : "higher",
      interval_text(change, off(lower ? change.high : change.low), off(lower ? change.low : change.high),
                    lower ? change.beyond_low : change.beyond_high));
}

/// Reads a member of a change of this kind; nothing for a change of another kind.
template <ChangeKind kind>
auto of_kind(double ParameterChange::*member) {
  return [member](const ParameterChange& change) {
    return change.kind == kind ? std::optional(change.*member) : std::nullopt;
  };
}

}  // namespace

std::string_view word_of(ChangeTold told) {
  switch (told) {
    case ChangeTold::one:
      return "one";
    case ChangeTold::several:
      return "several";
    case ChangeTold::none:
      return "none";
    case ChangeTold::unknown:
      break;
  }
  return "unknown";
}

std::string explanation_text(const ChangeExplanation& explanation) {
  std::vector<std::string> texts;
  for (const ParameterChange& change : explanation.parameters)
    texts.push_back(fmt::format("{} ({})", change_text(change), text::percent_near(change.probability)));
  const std::string compared =
      explanation.since > 1
          ? fmt::format("since move {}, compared with the machine's own moves before", explanation.since)
          : std::string("compared with the simulated machines, from the first move on");
  switch (explanation.told) {
    case ChangeTold::one:
      return fmt::format("if one parameter of the model differs, it is {}, {}",
                         change_text(explanation.parameters[0]), compared);
    case ChangeTold::several:
      return fmt::format("which parameter differs cannot be told from these measures: {}; {}",
                         fmt::join(texts, ", or "), compared);
    case ChangeTold::none:
      return fmt::format("no single parameter of those tried explains these moves; nearest: {}; {}",
                         fmt::join(texts, ", or "), compared);
    case ChangeTold::unknown:
      break;
  }
  return fmt::format("which parameter changed is not told: {}", explanation.reason);
}

document::Description<ParameterChange> parameter_description() {
  using document::Notation;
  const auto factor = of_kind<ChangeKind::factor>;
  const auto amount = of_kind<ChangeKind::amount>;
  const auto item = [](const char* key, const char* heading, const char* meaning) {
    return document::Item{
        .key = key, .heading = heading, .meaning = meaning, .notation = Notation::three_digits};
  };
  return document::Description<ParameterChange>()
      .value({"parameter", "parameter", "dotted path"}, &ParameterChange::parameter)
      .value(item("factor", "times", "most likely factor by which it changed; null: something was added"),
             factor(&ParameterChange::change))
      .value(item("low", "from", "low end of the 95 % interval of the factor"), factor(&ParameterChange::low))
      .value(item("high", "to", "high end of it"), factor(&ParameterChange::high))
      .value(
          item("amount", "plus", "most likely amount that was added, in its unit; null: it was multiplied"),
          amount(&ParameterChange::change))
      .value(item("amount_low", "from", "low end of the 95 % interval of the amount"),
             amount(&ParameterChange::low))
      .value(item("amount_high", "to", "high end of it"), amount(&ParameterChange::high))
      .value({.key = "probability",
              .heading = "probability",
              .meaning = "that it is this parameter, if it is one of those tried",
              .unit = "1",
              .notation = Notation::percent},
             &ParameterChange::probability);
}

}  // namespace zerocount::monitor
