#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/document/markup.hpp"
#include "analysis/report/html.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_factors = 12;

void add_index(FigureData& data, const sensitivity::FactorSensitivity& factor, const char* index,
               const sensitivity::BoundedNumber& number) {
  if (!std::isfinite(number.value)) return;
  data.rows.push_back(
      ordered_json::array({factor.name, index, datum(number.value), datum(number.low), datum(number.high)}));
}

/// "settling time" for "settling_time".
std::string label_text(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Figure figure_for(const sensitivity::OutputSensitivity& output, const std::string& label, bool total) {
  FigureData data{"factors",
                  {{"factor", "parameter", ""},
                   {"index", "index", ""},
                   {"value", "value", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"}}};
  const std::size_t shown = std::min(max_factors, output.factors.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const sensitivity::FactorSensitivity& factor = output.factors[i];
    add_index(data, factor, "first order: alone", factor.first_order);
    add_index(data, factor, "total: with all others", factor.total);
  }
  std::string caption = fmt::format(
      "Sobol' indices of {} at point {} (dots) with 95 % bounds (bars), for each random parameter, strongest "
      "first: the proportion of the variance that the parameter {}. A parameter influences the output if its "
      "lower bound{} is above {}. Bounds that include {} leave it open. ",
      label_text(output.output), label,
      total ? "explains alone (first order), or has a part in, alone or with others (total)"
            : "explains alone",
      total ? " of the total index" : "", text::percent(sensitivity::relevant_index),
      text::percent(sensitivity::relevant_index));
  caption += total ? "What several parameters do only together counts in the total of each, so totals need "
                     "not add up to 100 %. "
                   : "What a parameter does only together with others does not show in this design. ";
  if (shown < output.factors.size())
    caption += fmt::format("Shown are {} of {}. ", shown, output.factors.size());
  for (const std::string& note : output.notes) caption += note + (note.ends_with('.') ? " " : ". ");
  Figure figure = figure_of("sensitivity", "sensitivity-" + output.output,
                            "Sensitivity of " + label_text(output.output), caption, {std::move(data)});
  if (!total) figure.specification["encoding"]["color"]["legend"] = nullptr;
  set_rows(figure, shown, 28);
  return figure;
}

}  // namespace

std::optional<PageSection> sensitivity_section(const ReportedStudy& reported) {
  if (reported.study.open_loop) return std::nullopt;
  sensitivity::SensitivityQuestion question;
  question.points = {reported.chosen.point};
  const sensitivity::StudySensitivity answer = sensitivity::study_sensitivity(reported.file, question);
  PageSection section{sensitivity_section_name, "Which parameters matter", "", {}};
  const measures::PointSummary& chosen = point_of(reported, reported.chosen.point);
  if (!sensitivity::any_estimated(answer)) {
    if (chosen.outcomes.zero_count < chosen.trials) return std::nullopt;
    section.html = fmt::format("<p>All trials of {} succeed: no parameter explains a failure.</p>\n",
                               document::markup(label_of(reported, reported.chosen.point)));
    return section;
  }
  const sensitivity::PointSensitivity& point = answer.points.front();
  for (const sensitivity::OutputSensitivity& output : point.outputs) {
    if (!output.estimated) continue;
    const std::string within = output.of_worlds            ? "Between worlds: "
                               : reported.study.worlds > 0 ? "Within worlds: "
                                                           : "";
    section.html += fmt::format("<p>{}{}</p>\n", within, document::prose_markup(output.conclusion));
    section.figures.push_back(figure_for(output, point.label, answer.from_saltelli));
  }
  return section;
}

}  // namespace zerocount::report
