#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace zerocount::report {
namespace {

constexpr std::size_t max_factors = 12;

/// Sensitivities of one output at one design point, in each setting (condition at an age).
struct OutputAtPoint {
  std::vector<const sensitivity::PointSensitivity*> points;
  /// [setting] Sensitivity of the output at the point.
  std::vector<const sensitivity::OutputSensitivity*> outputs;
};

std::vector<OutputAtPoint> outputs_at_points(const sensitivity::StudySensitivity& study) {
  std::vector<OutputAtPoint> found;
  for (const sensitivity::PointSensitivity& point : study.points) {
    for (const sensitivity::OutputSensitivity& output : point.outputs) {
      if (!output.estimated) continue;
      auto same = std::ranges::find_if(found, [&](const OutputAtPoint& one) {
        return one.points.front()->point == point.point && one.outputs.front()->output == output.output;
      });
      if (same == found.end()) same = found.insert(found.end(), OutputAtPoint{});
      same->points.push_back(&point);
      same->outputs.push_back(&output);
    }
  }
  return found;
}

void add_index(FigureData& data, const sensitivity::FactorSensitivity& factor, const char* index,
               const sensitivity::BoundedNumber& number, const std::string& setting) {
  if (!std::isfinite(number.value)) return;
  data.rows.push_back(ordered_json::array(
      {factor.name, index, datum(number.value), datum(number.low), datum(number.high), setting}));
}

/// A measure's name as a label in a figure: "arrival time" for "arrival_time".
std::string label_text(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// The label of a design point, without the name of the setting (condition at an age).
std::string label_of_point(const sensitivity::PointSensitivity& point) {
  const std::string under = point.setting ? ", " + *point.setting : "";
  return point.label.ends_with(under) ? point.label.substr(0, point.label.size() - under.size())
                                      : point.label;
}

/// The names of the settings (conditions at ages) of the study, in order.
std::vector<std::string> settings_of(const sensitivity::StudySensitivity& study) {
  std::vector<std::string> names;
  for (const sensitivity::PointSensitivity& point : study.points) {
    if (point.setting && std::ranges::find(names, *point.setting) == names.end())
      names.push_back(*point.setting);
  }
  return names;
}

Figure figure_for(const sensitivity::StudySensitivity& study, const OutputAtPoint& shown,
                  bool several_points) {
  const bool total = study.from_saltelli;
  const std::string level = text::percent(study.confidence);
  const sensitivity::PointSensitivity& point = *shown.points.front();
  const std::string& name = shown.outputs.front()->output;
  FigureData data{"factors",
                  {{"factor", "parameter", ""},
                   {"index", "index", ""},
                   {"value", "value", "1"},
                   {"low", fmt::format("lower {} bound", level), "1"},
                   {"high", fmt::format("upper {} bound", level), "1"},
                   {"condition", point.setting ? "condition" : "", ""}}};
  std::string caption = fmt::format(
      "Sobol' indices of {} at point {} (dots) with {} bounds (bars){}, for each random parameter, strongest "
      "first: the proportion of the variance that the parameter {}. A parameter influences the output if its "
      "lower bound{} is above {}. Bounds that include {} leave it open. ",
      label_text(name), label_of_point(point), level, point.setting ? ", under each condition" : "",
      total ? "explains alone (first order), or has a part in, alone or with others (total)"
            : "explains alone",
      total ? " of the total index" : "", text::percent(sensitivity::relevant_index),
      text::percent(sensitivity::relevant_index));
  caption += total ? "What several parameters do only together counts in the total of each, so totals need "
                     "not add up to 100 %. "
                   : "What a parameter does only together with others does not show in this design. ";
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < shown.outputs.size(); ++i) {
    const sensitivity::OutputSensitivity& output = *shown.outputs[i];
    const std::string setting = shown.points[i]->setting.value_or("");
    const std::size_t factors = std::min(max_factors, output.factors.size());
    for (std::size_t k = 0; k < factors; ++k) {
      const sensitivity::FactorSensitivity& factor = output.factors[k];
      add_index(data, factor, "first order: alone", factor.first_order, setting);
      add_index(data, factor, "total: with all others", factor.total, setting);
    }
    if (i == 0 && factors < output.factors.size())
      caption += fmt::format("Shown are {} of {}. ", factors, output.factors.size());
    for (const std::string& note : output.notes)
      if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  }
  for (std::string& note : notes) {
    note.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(note.front())));
    caption += note + (note.ends_with('.') ? " " : ". ");
  }
  const std::string of_point = several_points ? fmt::format("-{}", point.point) : "";
  Figure figure = figure_of(
      "sensitivity", fmt::format("sensitivity-{}{}", name, of_point),
      fmt::format("Which parameters decide {}{}?", name == "success" ? "" : "the ", label_text(name)),
      caption, {std::move(data)});
  figure.parameters["colour"] = !total && point.setting ? "condition" : "index";
  figure.parameters["conditions"] = settings_of(study);
  return figure;
}

std::vector<Figure> sensitivity_figures(const sensitivity::StudySensitivity& study) {
  std::vector<Figure> figures;
  const std::vector<OutputAtPoint> shown = outputs_at_points(study);
  for (const OutputAtPoint& one : shown) {
    const bool several = one.points.front()->point != shown.front().points.front()->point ||
                         shown.back().points.front()->point != shown.front().points.front()->point;
    Figure figure = figure_for(study, one, several);
    if (!figure.data.front().rows.empty()) figures.push_back(std::move(figure));
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
  return figures_first(sensitivity_section_name, "Which parameters matter", sensitivity_answer().of(found));
}

}  // namespace zerocount::report
