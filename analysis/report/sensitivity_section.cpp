#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/report_sections.hpp"
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

Figure figure_for(const sensitivity::StudySensitivity& study, const sensitivity::PointSensitivity& point,
                  const sensitivity::OutputSensitivity& output) {
  const bool total = study.from_saltelli;
  const std::string level = text::percent(study.confidence);
  FigureData data{"factors",
                  {{"factor", "parameter", ""},
                   {"index", "index", ""},
                   {"value", "value", "1"},
                   {"low", fmt::format("lower {} bound", level), "1"},
                   {"high", fmt::format("upper {} bound", level), "1"}}};
  const std::size_t shown = std::min(max_factors, output.factors.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const sensitivity::FactorSensitivity& factor = output.factors[i];
    add_index(data, factor, "first order: alone", factor.first_order);
    add_index(data, factor, "total: with all others", factor.total);
  }
  std::string caption = fmt::format(
      "Sobol' indices of {} at point {} (dots) with {} bounds (bars), for each random parameter, strongest "
      "first: the proportion of the variance that the parameter {}. A parameter influences the output if its "
      "lower bound{} is above {}. Bounds that include {} leave it open. ",
      label_text(output.output), point.label, level,
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
  const std::string of_point = study.points.size() > 1 ? fmt::format("-{}", point.point) : "";
  Figure figure = figure_of("sensitivity", fmt::format("sensitivity-{}{}", output.output, of_point),
                            "Sensitivity of " + label_text(output.output), caption, {std::move(data)});
  if (!total) figure.specification["encoding"]["color"]["legend"] = nullptr;
  set_rows(figure, shown, 28);
  return figure;
}

std::vector<Figure> sensitivity_figures(const sensitivity::StudySensitivity& study) {
  std::vector<Figure> figures;
  for (const sensitivity::PointSensitivity& point : study.points) {
    for (const sensitivity::OutputSensitivity& output : point.outputs) {
      if (output.estimated) figures.push_back(figure_for(study, point, output));
    }
  }
  return figures;
}

}  // namespace

document::AnswerDescription<sensitivity::StudySensitivity> sensitivity_answer() {
  document::AnswerDescription<sensitivity::StudySensitivity> answer = sensitivity::sensitivity_answer();
  answer.items.figures(sensitivity_figures);
  return answer;
}

std::optional<PageSection> sensitivity_section(const ReportedStudy& reported) {
  if (reported.study.open_loop) return std::nullopt;
  sensitivity::SensitivityQuestion question;
  question.points = {reported.chosen.point};
  const sensitivity::StudySensitivity found = sensitivity::study_sensitivity(reported.file, question);
  const goal::QuestionRate rate = shown_rate(reported, reported.chosen.point);
  if (!sensitivity::any_estimated(found) && rate.hits < rate.events) return std::nullopt;
  return answer_section(sensitivity_section_name, "Which parameters matter", sensitivity_answer().of(found));
}

}  // namespace zerocount::report
