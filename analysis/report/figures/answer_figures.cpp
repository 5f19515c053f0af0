#include "analysis/report/figures/answer_figures.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/report/report_sections.hpp"

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

namespace {

using history::Series;
using history::SeriesChange;
using history::SeriesRun;
std::string short_commit(const std::string& commit) {
  return commit.substr(0, 10);
}

FigureData runs_data(const Series& series) {
  return data_of<SeriesRun>(
      "runs", series.runs,
      {{{"date", "", ""}, [](const SeriesRun& one) { return one.run->created; }},
       {{"run", "run", ""}, [](const SeriesRun& one) { return one.run->created; }},
       {{"commit", "commit", ""}, [](const SeriesRun& one) { return short_commit(one.run->git_commit); }},
       {{"seed", "seed", ""}, [](const SeriesRun& one) { return one.run->seed; }},
       {{"trials", "trials per point", "1"}, [](const SeriesRun& one) { return one.run->trials; }},
       {{"value", series.measure, series.unit}, [](const SeriesRun& one) { return datum(one.value.value); }},
       {{"low", "lower 95 % bound", series.unit},
        [](const SeriesRun& one) { return datum(one.value.bounds.low); }},
       {{"high", "upper 95 % bound", series.unit},
        [](const SeriesRun& one) { return datum(one.value.bounds.high); }},
       {{"verdict", "against the baseline", ""}, [](const SeriesRun& one) {
          return one.value.comparison ? one.value.comparison->verdict : std::string();
        }}});
}

FigureData changes_data(const Series& series) {
  return data_of<SeriesChange>(
      "changes", series.changes,
      {{{"date", "", ""}, [&](const SeriesChange& one) { return series.runs[one.first].run->created; }},
       {{"commit", "", ""},
        [&](const SeriesChange& one) { return short_commit(series.runs[one.first].run->git_commit); }},
       {{"sentence", "", ""}, [](const SeriesChange& one) { return one.sentence; }}});
}

std::string caption_of(const Series& series) {
  std::string caption = fmt::format(
      "{} runs, with the 95 % bounds of each (bars){}. ", series.runs.size(),
      series.test == history::SeriesTest::baseline
          ? ". The runs share their random numbers, and so their errors; they are judged by their paired "
            "comparison with the baseline"
          : "");
  if (series.changes.empty()) return caption + "No change is significant. ";
  for (const SeriesChange& change : series.changes) caption += fmt::format("It {}. ", change.sentence);
  return caption + "A dashed line stands at the first run after a change, with its commit. ";
}

Figure history_figure(const Series& series, std::size_t number) {
  Figure figure = figure_of("history", fmt::format("history-{}", number),
                            fmt::format("{}, {}: {} over time", series.study, series.point, series.measure),
                            caption_of(series), {runs_data(series), changes_data(series)});
  if (series.runs.front().value.kind == statistics::MeasurementKind::proportion)
    figure.parameters["format"] = "~p";
  return figure;
}

std::vector<Figure> history_figures(const history::History& history, std::size_t max_figures) {
  std::vector<const Series*> ordered;
  for (const Series& series : history.series) ordered.push_back(&series);
  std::stable_partition(ordered.begin(), ordered.end(),
                        [](const Series* series) { return !series->changes.empty(); });
  ordered.resize(std::min(ordered.size(), max_figures));
  std::vector<Figure> figures;
  figures.reserve(ordered.size());
  for (const Series* const series : ordered) figures.push_back(history_figure(*series, figures.size() + 1));
  if (history.series.size() > max_figures && !figures.empty()) {
    figures.front().caption += fmt::format(
        "Figures stand here for {} of {} series, those that changed first. 'zerocount history plot' draws "
        "others with --study, --point and --measure. ",
        max_figures, history.series.size());
  }
  return figures;
}

}  // namespace

document::AnswerDescription<history::History> history_answer(std::size_t max_figures) {
  document::AnswerDescription<history::History> answer = history::history_answer();
  answer.items.figures(
      [max_figures](const history::History& history) { return history_figures(history, max_figures); });
  return answer;
}

PageSection history_section(const history::History& history, std::size_t max_figures) {
  if (history.series.empty())
    return {"history", "Over time", "<p>The history has fewer than two runs of this study.</p>\n", {}};
  return answer_section("history", "Over time", history_answer(max_figures).of(history));
}

}  // namespace zerocount::report
