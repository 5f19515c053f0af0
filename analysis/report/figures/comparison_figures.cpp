#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/report/figures/answer_figures.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_bars = 60;

/// The comparison of one measure (a success rate or a time, say) at one design point.
struct ComparedMeasure {
  const comparison::PointComparison* point{nullptr};
  const comparison::Judgement* measure{nullptr};
};

std::vector<ComparedMeasure> worst_first(const comparison::StudyComparison& comparison) {
  std::vector<ComparedMeasure> all;
  for (const comparison::PointComparison& point : comparison.points) {
    for (const comparison::Judgement& one : point.judgements) {
      if (one.is_measure()) all.push_back({&point, &one});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const ComparedMeasure& a, const ComparedMeasure& b) {
    return std::pair(a.measure->verdict, a.measure->change) <
           std::pair(b.measure->verdict, b.measure->change);
  });
  return all;
}

/// Figure of the changes of all measures between two studies, each as a multiple of the margin that a change
/// must not exceed.
Figure margins_figure(const comparison::StudyComparison& comparison,
                      const std::vector<ComparedMeasure>& measures) {
  FigureData data{"effects",
                  {{"label", "point and measure", ""},
                   {"effect", "change for the worse, in margins", "1"},
                   {"low", "lower bound, in margins", "1"},
                   {"high", "upper bound, in margins", "1"},
                   {"verdict", "verdict", ""},
                   {"size", "change for the worse", ""},
                   {"margin", "margin", ""}}};
  std::size_t drawable = 0;
  for (const ComparedMeasure& one : measures) {
    const comparison::Judgement& measure = *one.measure;
    if (!(measure.margin > 0.0) || std::isnan(measure.effect)) continue;
    if (++drawable > max_bars) continue;
    const auto text = [&](double value) {
      return comparison::value_text(value, measure.measure, measure.unit);
    };
    data.rows.push_back(ordered_json::array(
        {fmt::format("{}: {}", one.point->label, measure.measure), datum(measure.effect / measure.margin),
         datum(measure.bounds.low / measure.margin), datum(measure.bounds.high / measure.margin),
         std::string(comparison::to_string(measure.change)), text(measure.effect), text(measure.margin)}));
  }
  std::string caption = fmt::format(
      "Change of every measure for the worse (dot) with its bounds, {:.4g} % each (bar), in units of its "
      "margin. A bar between −1 and +1 shows that the measure is equivalent; one left of +1 that it is not "
      "worse. What lies beyond ± 4 margins is drawn at the edge. ",
      100.0 * comparison.confidence);
  if (drawable > max_bars)
    caption += fmt::format("Shown are {} of {} measures, the worst verdicts first. ", max_bars, drawable);
  if (drawable < measures.size()) caption += "Measures without a margin or without values are not shown. ";
  return figure_of("margins", "margins", "All measures against their margins", caption, {std::move(data)});
}

/// Figure of the change of the success rate, or of the proportion of moves that meet the goal, at each design
/// point.
Figure success_change(const comparison::StudyComparison& comparison,
                      const std::vector<ComparedMeasure>& measures) {
  const bool by_goal = !comparison.goals.empty();
  const std::string_view rate = by_goal ? "goal_rate" : "success_rate";
  FigureData data{"changes",
                  {{"label", "point", ""},
                   {"change", "change", "percentage points"},
                   {"low", "lower bound", "percentage points"},
                   {"high", "upper bound", "percentage points"},
                   {"verdict", "verdict", ""},
                   {"margin", "margin", "percentage points"}}};
  for (const ComparedMeasure& one : measures) {
    const std::string& measure = one.measure->measure;
    if (comparison::without_goal(measure) != rate || data.rows.size() == max_bars) continue;
    data.rows.push_back(ordered_json::array(
        {measure == rate ? one.point->label : fmt::format("{} {}", one.point->label, measure),
         datum(-100.0 * one.measure->effect), datum(-100.0 * one.measure->bounds.high),
         datum(-100.0 * one.measure->bounds.low), std::string(comparison::to_string(one.measure->change)),
         datum(-100.0 * one.measure->margin)}));
  }
  std::string caption = fmt::format(
      "{} of each point minus that of the baseline (dot), with {:.0f} % bounds (bar). The tick is the "
      "margin: the largest accepted loss. A point passes if its whole bar lies right of the tick. ",
      by_goal ? "Proportion of moves that meet the goal" : "Success rate", 100.0 * comparison.confidence);
  if (comparison.points.size() > max_bars)
    caption += fmt::format("Shown are the {} of {} points with the worst verdicts. ", max_bars,
                           comparison.points.size());
  return figure_of("success-change", "success-change",
                   by_goal ? "The goal against the baseline" : "Success against the baseline", caption,
                   {std::move(data)});
}

std::vector<Figure> comparison_figures(const comparison::StudyComparison& comparison) {
  const std::vector<ComparedMeasure> measures = worst_first(comparison);
  std::vector<Figure> figures;
  for (const auto make : {margins_figure, success_change}) {
    Figure figure = make(comparison, measures);
    if (!figure.data.front().rows.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace

document::AnswerDescription<comparison::StudyComparison> comparison_answer() {
  document::AnswerDescription<comparison::StudyComparison> answer = comparison::comparison_answer();
  answer.items.figures(comparison_figures);
  return answer;
}

}  // namespace zerocount::report
