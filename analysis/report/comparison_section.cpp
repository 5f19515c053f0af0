#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/document/markup.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/report/html.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_measures = 200;
constexpr std::size_t max_bars = 60;

/// A measure at a point.
struct ComparedMeasure {
  const comparison::PointComparison* point{nullptr};
  const comparison::MeasureComparison* measure{nullptr};
};

std::vector<ComparedMeasure> worst_first(const comparison::StudyComparison& comparison) {
  std::vector<ComparedMeasure> all;
  for (const comparison::PointComparison& point : comparison.points) {
    for (const comparison::MeasureComparison& measure : point.measures) all.push_back({&point, &measure});
  }
  std::stable_sort(all.begin(), all.end(), [](const ComparedMeasure& a, const ComparedMeasure& b) {
    return std::pair(a.measure->verdict, a.measure->change) <
           std::pair(b.measure->verdict, b.measure->change);
  });
  return all;
}

std::string table_of(const std::vector<ComparedMeasure>& measures) {
  std::vector<HtmlColumn> columns{
      {"point", "", true, {}},     {"measure", "", true, {}}, {"verdict", "", true, {}},
      {"baseline", "", false, {}}, {"now", "", false, {}},    {"worse by", "", false, {}},
      {"bounds", "", false, {}},   {"margin", "", false, {}}, {"adjusted p", "", false, {}}};
  for (std::size_t i = 0; i < std::min(measures.size(), max_measures); ++i) {
    const comparison::MeasureComparison& one = *measures[i].measure;
    const auto text = [&](double value) { return comparison::value_text(value, one.measure, one.unit); };
    add_row(columns, {measures[i].point->label, one.measure, std::string(comparison::to_string(one.change)),
                      text(one.baseline), text(one.current), text(one.effect),
                      fmt::format("{} … {}", text(one.bounds.low), text(one.bounds.high)), text(one.margin),
                      text::short_number(comparison::shown_p(one))});
  }
  std::string html = html_table(columns);
  if (measures.size() > max_measures) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} rows, the failed ones first; all are printed by "
        "<code>zerocount compare</code>.</p>\n",
        max_measures, measures.size());
  }
  return html;
}

std::string requirements_table(const comparison::StudyComparison& comparison) {
  std::vector<HtmlColumn> columns{{"point", "", true, {}},
                                  {"requirement", "", true, {}},
                                  {"value", "", false, {}},
                                  {"verdict", "", true, {}}};
  for (const comparison::PointComparison& point : comparison.points) {
    for (const comparison::RequirementResult& one : point.requirements)
      add_row(columns, {point.label, one.text, comparison::value_text(one.value, one.quantity, one.unit),
                        std::string(comparison::to_string(one.verdict))});
  }
  if (columns.front().cells.empty()) return "";
  return "<h3>Requirements</h3>\n" + html_table(columns);
}

std::string differences_table(const comparison::StudyComparison& comparison) {
  if (comparison.manifest_differences.empty()) return "<p>The manifests are the same.</p>\n";
  std::vector<HtmlColumn> columns{{"key", "", true, {}}, {"baseline", "", true, {}}, {"now", "", true, {}}};
  for (const manifest::ManifestDifference& difference : comparison.manifest_differences) {
    add_row(columns, {difference.key, difference.baseline.empty() ? "–" : difference.baseline,
                      difference.current.empty() ? "–" : difference.current});
  }
  return "<h3>Differences of the manifests</h3>\n" + html_table(columns);
}

std::string file_text(const comparison::ComparedFile& file) {
  const layout::Provenance& build = file.header.provenance;
  return fmt::format("{}: {}, made {} by zerocount {} ({}), {} trials per point", file.path, file.header.name,
                     build.created, build.zerocount_version, build.git_commit, file.header.trials);
}

/// Changes of all measures, as multiples of their margins.
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
    const comparison::MeasureComparison& measure = *one.measure;
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
  const std::size_t bars = data.rows.size();
  Figure figure =
      figure_of("margins", "margins", "All measures against their margins", caption, {std::move(data)});
  set_rows(figure, bars, 20);
  return figure;
}

/// Figure of the change at each point of the success rate, or of the proportion of moves that meet the goal.
Figure success_change(const comparison::StudyComparison& comparison,
                      const std::vector<ComparedMeasure>& measures) {
  const std::string_view rate = comparison.goal ? "goal_rate" : "success_rate";
  FigureData data{"changes",
                  {{"label", "point", ""},
                   {"change", "change", "percentage points"},
                   {"low", "lower bound", "percentage points"},
                   {"high", "upper bound", "percentage points"},
                   {"verdict", "verdict", ""},
                   {"margin", "margin", "percentage points"}}};
  for (const ComparedMeasure& one : measures) {
    if (one.measure->measure != rate || data.rows.size() == max_bars) continue;
    data.rows.push_back(ordered_json::array(
        {one.point->label, datum(-100.0 * one.measure->effect), datum(-100.0 * one.measure->bounds.high),
         datum(-100.0 * one.measure->bounds.low), std::string(comparison::to_string(one.measure->change)),
         datum(-100.0 * one.measure->margin)}));
  }
  std::string caption = fmt::format(
      "{} of each point minus that of the baseline (dot), with {:.0f} % bounds (bar). The tick is the "
      "margin: the largest accepted loss. A point passes if its whole bar lies right of the tick. ",
      comparison.goal ? "Proportion of moves that meet the goal" : "Success rate",
      100.0 * comparison.confidence);
  if (comparison.points.size() > max_bars)
    caption += fmt::format("Shown are the {} of {} points with the worst verdicts. ", max_bars,
                           comparison.points.size());
  const std::size_t bars = data.rows.size();
  Figure figure =
      figure_of("success-change", "success-change",
                comparison.goal ? "The goal against the baseline" : "Success against the baseline", caption,
                {std::move(data)});
  set_rows(figure, bars, 24);
  return figure;
}

}  // namespace

PageSection comparison_section(const comparison::StudyComparison& comparison) {
  const std::vector<ComparedMeasure> measures = worst_first(comparison);
  PageSection section{"baseline", "Against the baseline", "", {}};
  section.html = fmt::format("<div class=\"verdict\"><p class=\"headline\">{}</p><p>{}</p></div>\n",
                             document::prose_markup(comparison::verdict_sentence(comparison)),
                             document::markup(comparison.layer_reason)) +
                 html_facts({{"Baseline", file_text(comparison.baseline)},
                             {"This study", file_text(comparison.current)}});
  if (comparison.goal)
    section.html += fmt::format("<p>Goal: {}</p>\n", document::markup(goal::goal_sentence(*comparison.goal)));
  for (const std::string& note : comparison.notes)
    section.html += fmt::format("<p>{}</p>\n", document::markup(note));
  section.html += differences_table(comparison);
  if (!measures.empty()) {
    section.html += "<h3>Measures</h3>\n" + table_of(measures);
    for (const auto make : {margins_figure, success_change}) {
      Figure figure = make(comparison, measures);
      if (!figure.data.front().rows.empty()) section.figures.push_back(std::move(figure));
    }
  }
  section.html += requirements_table(comparison);
  return section;
}

}  // namespace zerocount::report
