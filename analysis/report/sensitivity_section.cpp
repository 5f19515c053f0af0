#include "analysis/report/sensitivity_section.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/report/escaping.hpp"
#include "analysis/sensitivity/sensitivity.hpp"

namespace zerocount {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_factors = 12;

void add_index(FigureData& data, const FactorSensitivity& factor, const char* index,
               const BoundedNumber& number) {
  if (!std::isfinite(number.value)) return;
  data.rows.push_back(
      ordered_json::array({factor.name, index, datum(number.value), datum(number.low), datum(number.high)}));
}

/// "settling time" for "settling_time".
std::string label_text(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Figure figure_for(const OutputSensitivity& output, const std::string& label, bool total) {
  FigureData data{"factors",
                  {{"factor", "parameter", ""},
                   {"index", "index", ""},
                   {"value", "value", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"}}};
  const std::size_t shown = std::min(max_factors, output.factors.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const FactorSensitivity& factor = output.factors[i];
    add_index(data, factor, "first order: alone", factor.first_order);
    add_index(data, factor, "total: with all others", factor.total);
  }
  std::string caption = fmt::format(
      "Share of the variance of {} at point {} that each random parameter explains, strongest first, with 95 "
      "% bounds. "
      "What has bounds that exclude zero matters; what has not, need not be known better. ",
      label_text(output.output), label);
  if (total)
    caption +=
        "A total index well above the first-order one means that the parameter acts together with others. ";
  if (shown < output.factors.size())
    caption += fmt::format("Shown are {} of {}. ", shown, output.factors.size());
  for (const std::string& note : output.notes) caption += note + (note.ends_with('.') ? " " : ". ");
  Figure figure = figure_of("sensitivity", "sensitivity-" + output.output,
                            "What decides " + label_text(output.output), caption);
  if (!total) figure.specification["encoding"]["color"]["legend"] = nullptr;
  set_rows(figure, shown, 28);
  figure.data.push_back(std::move(data));
  return figure;
}

}  // namespace

std::optional<PageSection> sensitivity_section(const ReportedStudy& reported) {
  if (reported.study.open_loop) return std::nullopt;
  SensitivityQuestion question;
  question.points = {most_telling_point(reported.summary.points)};
  const StudySensitivity answer = study_sensitivity(reported.file, question);
  if (!any_estimated(answer)) return std::nullopt;
  const PointSensitivity& point = answer.points.front();
  PageSection section{sensitivity_section_name, "Which parameters matter", "", {}};
  for (const OutputSensitivity& output : point.outputs) {
    if (!output.estimated) continue;
    section.html += fmt::format("<p>{}</p>\n", html_prose(output.conclusion));
    section.figures.push_back(figure_for(output, point.label, answer.from_saltelli));
  }
  return section;
}

}  // namespace zerocount
