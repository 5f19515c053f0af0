#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/sensitivity/sensitivity.hpp"
#include "core/text/text.hpp"

namespace zerocount::sensitivity {
namespace {

std::string joined(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  const std::vector<std::string> first(words.begin(), words.end() - 1);
  return fmt::format("{} and {}", fmt::join(first, ", "), words.back());
}

/// Name and Sobol' index of a factor, with the lower bound, as text: "friction.k1 (23 %, at least 17.2 %)".
std::string influential_text(const std::string& name, const BoundedNumber& index) {
  return fmt::format("{} ({:.0f} %, at least {})", name, 100.0 * index.value,
                     text::percent_at_least(index.low));
}

std::string why_nothing(const OutputSensitivity& sensitivity) {
  if (sensitivity.trials == 0) return fmt::format("No trial has a value of {}.", sensitivity.output);
  if (sensitivity.standard_deviation > 0.0) {
    return fmt::format(
        "There are too few trials, or nothing varies in them: nothing can be said of what influences {}.",
        sensitivity.output);
  }
  return fmt::format(
      "{} is {} in all {} trials: it has no variance, and nothing can be said of what influences it.",
      sensitivity.output, text::short_number(sensitivity.mean), sensitivity.trials);
}

using document::Description;
using document::everywhere;
using document::in_data;
using document::Visibility;

Description<FactorSensitivity> factor_description() {
  Description<FactorSensitivity> description;
  description
      .value(everywhere("name", "factor", "dotted path of the parameter, or what is drawn within trials"),
             &FactorSensitivity::name)
      .value(everywhere("matters", "matters", "whether it is shown to have an influence"),
             &FactorSensitivity::matters);
  const auto add = [&](const char* key, const char* heading, const char* meaning,
                       BoundedNumber FactorSensitivity::*number) {
    description.value({.key = key,
                       .heading = heading,
                       .meaning = meaning,
                       .unit = "1",
                       .notation = document::Notation::three_digits},
                      number);
  };
  add("total", "total", "total Sobol' index", &FactorSensitivity::total);
  add("first_order", "first order", "first-order Sobol' index", &FactorSensitivity::first_order);
  add("rank_correlation", "rank corr.", "Spearman's rank correlation", &FactorSensitivity::rank_correlation);
  add("partial_rank_correlation", "partial rank corr.",
      "rank correlation after the effect of the other factors is removed",
      &FactorSensitivity::partial_rank_correlation);
  add("log_odds", "log odds per sd",
      "change of ln(p/(1 - p)) over one standard deviation of the factor, p the proportion of yes",
      &FactorSensitivity::log_odds);
  return description;
}

std::string notes_sentences(const OutputSensitivity& output) {
  return output.notes.empty() ? "" : fmt::format("note: {}", fmt::join(output.notes, "\nnote: "));
}

std::optional<std::string> number_with_unit(double number, const std::string& unit) {
  if (std::isnan(number)) return {};
  return text::short_number(number) + (unit == "1" ? "" : " " + unit);
}

Description<OutputSensitivity> output_description() {
  using Output = const OutputSensitivity&;
  return Description<OutputSensitivity>()
      .title([](Output o) { return o.unit == "1" ? o.output : fmt::format("{} ({})", o.output, o.unit); })
      .value(in_data("output", "name of the output"), &OutputSensitivity::output)
      .value(in_data("unit", "unit of the mean and the standard deviation"), &OutputSensitivity::unit)
      .value({.key = "meaning",
              .heading = "meaning",
              .meaning = "what the output is",
              .shown = Visibility::not_in_csv},
             &OutputSensitivity::meaning)
      .value(in_data("estimated", "whether the factors could be estimated"), &OutputSensitivity::estimated)
      .value({.key = "conclusion",
              .heading = "conclusion",
              .meaning = "which factors matter, which do not, and what stays open",
              .shown = Visibility::not_in_csv},
             &OutputSensitivity::conclusion)
      .sentence(notes_sentences)
      .value(in_data("notes", "what limits these numbers"), &OutputSensitivity::notes)
      .value(everywhere("trials", "computed from", "trials, or worlds, that are used"),
             &OutputSensitivity::trials)
      .shown_as([](Output o) { return text::counted(o.trials, o.of_worlds ? "world" : "trial"); })
      .value(everywhere("mean", "mean", "mean of the output, in its unit"), &OutputSensitivity::mean)
      .shown_as([](Output o) { return number_with_unit(o.mean, o.unit); })
      .value(everywhere("standard_deviation", "standard deviation",
                        "standard deviation of the output, in its unit"),
             &OutputSensitivity::standard_deviation)
      .shown_as([](Output o) { return number_with_unit(o.standard_deviation, o.unit); })
      .table({.key = "factors", .meaning = "what varies in the trials, strongest first"},
             factor_description(), &OutputSensitivity::factors)
      .table(everywhere("left_out", "Left out", "factors without numbers"),
             Description<FactorLeftOut>()
                 .value(everywhere("name", "factor", "name of the factor"), &FactorLeftOut::name)
                 .value(everywhere("reason", "reason", "why it has no numbers"), &FactorLeftOut::reason),
             &OutputSensitivity::left_out);
}

Description<PointSensitivity> point_description() {
  return Description<PointSensitivity>()
      .title([](const PointSensitivity& p) {
        return fmt::format("Point {}: {}", p.point, text::printable(p.label));
      })
      .include(measures::name_of_point(),
               [](const PointSensitivity& p) -> const measures::PointInSetting& { return p; })
      .sections({.key = "outputs", .meaning = "outputs of the trials"}, output_description(),
                &PointSensitivity::outputs);
}

/// For each output at each point, the factors that matter to it, as text: "success at low: friction.k1; …".
std::vector<std::string> influences(const StudySensitivity& sensitivity) {
  std::vector<std::string> found;
  for (const PointSensitivity& point : sensitivity.points) {
    for (const OutputSensitivity& output : point.outputs) {
      std::vector<std::string> names;
      for (const FactorSensitivity& factor : output.factors) {
        if (factor.matters) names.push_back(text::printable(factor.name));
      }
      if (!names.empty())
        found.push_back(
            fmt::format("{} at {}: {}", output.output, text::printable(point.label), fmt::join(names, ", ")));
    }
  }
  return found;
}

std::string headline(const StudySensitivity& sensitivity) {
  constexpr std::size_t max_shown = 4;
  std::vector<std::string> found = influences(sensitivity);
  if (found.empty()) {
    return fmt::format("{}: {}", text::printable(sensitivity.name),
                       any_estimated(sensitivity) ? "no parameter is shown to matter"
                                                  : "nothing can be said of which parameters matter");
  }
  if (found.size() > max_shown) {
    found.resize(max_shown);
    found.emplace_back("more below");
  }
  return fmt::format("{}: what matters of {}", text::printable(sensitivity.name), fmt::join(found, "; "));
}

std::string legend(const StudySensitivity& sensitivity) {
  return fmt::format(
      "[,]: {} confidence bounds, each by itself. matters: those of {}.\n"
      "total, first order: proportions of the variance (Sobol' indices) in which the factor has a part, and "
      "that "
      "it explains alone. What several factors share counts in the total of each.\n"
      "rank corr.: whether the output rises (+) or falls (-) with the factor; partial rank corr.: the same "
      "after the effect of the other factors is removed. log odds per sd: what a standard deviation of the "
      "factor adds to ln(p/(1 - p)), p the proportion of yes.{}",
      text::percent(sensitivity.confidence),
      sensitivity.from_saltelli
          ? fmt::format("total are above {:g}", relevant_index)
          : fmt::format("first order are above {:g}, or those of partial rank corr. beyond ±{:g}",
                        relevant_index, relevant_correlation),
      sensitivity.from_saltelli ? " Where the output is the sum of a strongly skewed part and a symmetric "
                                  "one, bounds of 95 % of the "
                                  "indices hold in 79 to 86 % of the studies only."
                                : "");
}

}  // namespace

std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject) {
  if (!sensitivity.estimated) return why_nothing(sensitivity);
  std::vector<std::string> influential;  // the index is above relevant_index
  std::vector<std::string> correlated;   // only the partial rank correlation shows it
  std::vector<std::string> open;         // the bounds do not exclude relevant_index
  std::vector<std::string> negligible;   // the index is below relevant_index
  for (const FactorSensitivity& factor : sensitivity.factors) {
    const BoundedNumber& index = from_saltelli ? factor.total : factor.first_order;
    if (index.low > relevant_index)
      influential.push_back(influential_text(factor.name, index));
    else if (factor.matters)
      correlated.push_back(fmt::format("{} ({:+.2f})", factor.name, factor.partial_rank_correlation.value));
    else if (index.high < relevant_index)
      negligible.push_back(factor.name);
    else if (!std::isnan(index.high))
      open.push_back(fmt::format("{} (at most {})", factor.name, text::percent_at_most(index.high)));
    else if (!std::isnan(index.value))
      open.push_back(factor.name);
  }
  const std::string& output = sensitivity.output;
  const std::string part = text::percent(relevant_index);
  std::vector<std::string> parts;
  const auto add = [&](std::string_view begin, const std::vector<std::string>& names) {
    if (!names.empty()) parts.push_back(fmt::format("{} {}", begin, joined(names)));
  };
  add(fmt::format("these parameters influence {}, with their {}:", output,
                  from_saltelli
                      ? "total Sobol' index, the proportion of its variance that they have a part in, "
                        "alone or with others (shared parts count for each of them, so these need not "
                        "add up to 100 %)"
                      : "first-order Sobol' index, the proportion of its variance that they explain "
                        "alone"),
      influential);
  add(fmt::format("by their partial rank correlation, beyond ±{:g}, these influence {}:",
                  relevant_correlation, output),
      correlated);
  if (parts.empty())
    parts.push_back(fmt::format("no parameter is shown to {} {} or more of the variance of {}{}",
                                from_saltelli ? "have a part in" : "explain", part, output,
                                from_saltelli ? "" : " alone"));
  const std::string_view from = from_saltelli ? "comes from" : "is explained alone by";
  add(fmt::format("the study leaves open whether {} or more {}", part, from), open);
  add(fmt::format("less than {} {}", part, from), negligible);
  if (!from_saltelli)
    parts.push_back(fmt::format("what a parameter does only together with others these trials cannot show{}",
                                subject == Subject::trials ? " (a study with design: saltelli can)" : ""));
  return fmt::format("By {} bounds, each by itself: {}.", text::percent(confidence), fmt::join(parts, "; "));
}

document::AnswerDescription<StudySensitivity> sensitivity_answer() {
  document::AnswerDescription<StudySensitivity> answer{
      {.name = "sensitivity",
       .meaning = "which random parameters influence the outputs of the trials",
       .csv_table = "points.outputs.factors"},
      {}};
  answer.items.headline(headline)
      .value(in_data("name", "name of the study"), &StudySensitivity::name)
      .value(in_data("design_is_saltelli", "whether the design is saltelli, and there are total indices"),
             &StudySensitivity::from_saltelli)
      .value(in_data("confidence", "confidence of all bounds, each by itself", "1"),
             &StudySensitivity::confidence)
      .sections({.key = "points", .meaning = "the design points"}, point_description(),
                &StudySensitivity::points)
      .title([](const StudySensitivity&) { return "Legend"; })
      .sentence(legend);
  return answer;
}

}  // namespace zerocount::sensitivity
