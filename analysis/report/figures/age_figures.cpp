#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/summary/cells_of_point.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// A curve over the ages.
struct AgeSeries {
  std::string name;
  std::optional<goal::BoundedProportion> (*of)(const summary::CellOfPoint&);
  std::optional<double> asked;
};

FigureData data_of_ages(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages,
                        const std::vector<AgeSeries>& series) {
  FigureData data{"ages",
                  {{"series", "of", ""},
                   {"age", "age", question_of(reported).ages.unit},
                   {"rate", "proportion", "1"},
                   {"low", "lower bound", "1"},
                   {"high", "upper bound", "1"},
                   {"asked", "asked", "1"}}};
  for (const AgeSeries& one : series) {
    for (const summary::CellOfPoint& age : ages) {
      const std::optional<goal::BoundedProportion> rate = one.of(age);
      if (!rate) continue;
      data.rows.push_back(
          ordered_json::array({one.name, datum(age.age), datum(rate->value), datum(rate->low),
                               datum(rate->high), one.asked ? datum(*one.asked) : ordered_json()}));
    }
  }
  return data;
}

std::string bounds_text(const ReportedStudy& reported) {
  return fmt::format("one-sided bounds with {:.4g} % confidence each",
                     100.0 * goal::confidence_of(question_of(reported), reported.summary.confidence));
}

Figure rates_figure(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages) {
  const goal::Question& question = question_of(reported);
  std::vector<AgeSeries> series{{question.claim() ? "moves in the goal" : "trials that succeed",
                                 [](const summary::CellOfPoint& age) { return std::optional(age.rate); },
                                 std::nullopt}};
  const bool one_claim = question.claim() && !has_several(question);
  if (one_claim) series.front().asked = question.claim()->moves;
  if (question.claim())
    series.push_back({"machines in the goal", [](const summary::CellOfPoint& age) { return age.machines; },
                      one_claim ? question.claim()->machines : std::nullopt});
  Figure figure = figure_of(
      "ages", "ages", "How long does it hold?",
      fmt::format(
          "Proportions at each age, at {}: of moves those of the worst goal and condition{}; {}. Dashed: "
          "what is asked.",
          label_of(reported, reported.chosen.point),
          question.claim() ? "; of machines those that meet every goal under every condition" : "",
          bounds_text(reported)),
      {data_of_ages(reported, ages, series)});
  scale_ages(figure, question.ages.at, question.ages.unit);
  return figure;
}

Figure lives_figure(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages) {
  Figure figure = figure_of(
      "ages", "lives", "How long do the machines live?",
      fmt::format(
          "Proportion of the machines that meet every goal under every condition at each age up to one, "
          "at {}; Clopper-Pearson, {}.",
          label_of(reported, reported.chosen.point), bounds_text(reported)),
      {data_of_ages(
          reported, ages,
          {{"machines", [](const summary::CellOfPoint& age) { return age.living; }, std::nullopt}})});
  const study::Ages& of_study = question_of(reported).ages;
  scale_ages(figure, of_study.at, of_study.unit);
  ordered_json& layers = figure.specification["layer"];
  for (const int layer : {0, 2}) layers[layer]["mark"]["interpolate"] = "step-after";
  layers.erase(1);  // nothing is asked
  figure.specification["encoding"]["color"]["legend"] = nullptr;
  return figure;
}

}  // namespace

std::vector<Figure> age_figures(const ReportedStudy& reported) {
  const std::vector<summary::CellOfPoint> ages =
      summary::ages_of_point(reported.summary, reported.chosen.point);
  std::vector<Figure> figures;
  if (ages.empty()) return figures;
  figures.push_back(rates_figure(reported, ages));
  if (question_of(reported).claim()) figures.push_back(lives_figure(reported, ages));
  return figures;
}

}  // namespace zerocount::report
