#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_lines = 60;  ///< maximum number of points with a line of their own
constexpr std::int64_t max_series = 8;  ///< number of colours

/// The trials that a point has a row or line of its own for: of one goal, under one condition.
struct ShownLine {
  std::string goal;       ///< empty where the study has not several
  std::string condition;  ///< empty without conditions
  const ReportedStudy& study;
  goal::Question question;

  /// Proportion of machines or moves that the goal claims; without a goal, of trials.
  goal::QuestionRate rate(std::int64_t point) const {
    const measures::PointSummary& shown = point_of(study, point);
    if (!goal::is_of_machines(question)) return goal::rate_of(question, shown);
    const goal::Verdict verdict = verdict_on(question, shown);
    return {verdict.machines.value,
            {verdict.machines.low, verdict.machines.high},
            verdict.rigs_meeting,
            shown.goals.front().shape().rigs};
  }
  /// The proportion that is asked for.
  ordered_json asked() const {
    if (!question.claim()) return nullptr;
    return question.claim()->machines.value_or(question.claim()->moves);
  }
};

std::vector<ShownLine> shown_lines(const ReportedStudy& reported) {
  std::vector<ShownLine> lines;
  for (const goal::JudgedPart& part : question_of(reported).parts) {
    for (const ReportedPart& one : parts_of(reported)) {
      lines.push_back({has_several(question_of(reported)) ? part.claim->name : "", one.condition, one.study,
                       only(question_of(one.study), part.number)});
    }
  }
  return lines;
}

/// How the figure speaks of what it shows.
struct RateWords {
  std::string rate;     ///< "proportion of machines that meet the goal"
  std::string hits;     ///< "machines in goal"
  std::string events;   ///< "machines"
  std::string meeting;  ///< "machines that meet the goal"
};

RateWords words_of_rate(const ReportedStudy& reported) {
  const goal::Question& question = question_of(reported);
  const goal::QuestionWords& words = words_of(question);
  const auto of_machines = [](const goal::JudgedPart& part) { return part.claim && part.claim->machines; };
  if (std::ranges::none_of(question.parts, of_machines))
    return {std::string(words.rate), std::string(words.hits), std::string(words.events),
            std::string(words.meeting)};
  if (std::ranges::all_of(question.parts, of_machines))
    return {"proportion of machines that meet the goal", "machines in goal", "machines",
            "machines that meet the goal in its proportion of moves"};
  return {"proportion that the goal is about", "in goal", "of", "machines, or moves, that meet the goal"};
}

/// "kp=400 ★, large, loaded"; of the lines of a study with one point "large, loaded". @param with_goal
/// whether the goals have no panels of their own
std::string label_of_line(const ReportedStudy& reported, std::int64_t point, const ShownLine& line,
                          bool with_goal) {
  const bool alone = reported.names.size() == 1;
  std::string label = alone ? "" : marked_label_of(reported, point);
  for (const std::string& part : {with_goal ? line.goal : std::string(), line.condition})
    if (!part.empty()) label += (label.empty() ? "" : ", ") + part;
  return label.empty() ? label_of(reported, point) : label;
}

FigureData rates_data(const RateWords& words) {
  return {"points",
          {{"label", "point", ""},
           {"rate", words.rate, "1"},
           {"low", "lower bound", "1"},
           {"high", "upper bound", "1"},
           {"successes", words.hits, "1"},
           {"trials", words.events, "1"},
           {"asked", "asked for", "1"},
           {"condition", "", ""},
           {"goal", "", ""}}};
}

ordered_json row_of(const std::string& label, const ShownLine& line, const goal::QuestionRate& rate) {
  return ordered_json::array({label, datum(rate.value), datum(rate.bounds.low), datum(rate.bounds.high),
                              rate.hits, rate.events, line.asked(), line.condition, line.goal});
}

/// @param line that shows what is asked, "dark", and what the bounds are, "bars"
std::string bounds_note(const ReportedStudy& reported, std::string_view line, std::string_view bounds) {
  return fmt::format(
      "{}The {} are {}, for each point separately.",
      question_of(reported).claim() ? fmt::format("The {} line is what the goal asks for. ", line) : "",
      bounds, shown_bounds(reported));
}

void divide_by_goals(Figure& figure, const ReportedStudy& reported, int height) {
  if (!has_several(question_of(reported))) return;
  std::vector<FigurePanel> panels;
  for (const goal::JudgedPart& part : question_of(reported).parts)
    panels.push_back({part.claim->name, part.claim->name});
  figure.specification["height"] = height;
  divide_into_panels(figure, "goal", panels);
}

void use_words(Figure& figure, const RateWords& words) {
  retitle(figure, {{"success rate", words.rate}, {"successes", words.hits}, {"trials", words.events}});
}

/// The points by decreasing rate; evenly spaced points of that order if there are too many.
std::vector<std::int64_t> points_with_lines(const ReportedStudy& reported, std::int64_t lines_of_each) {
  std::vector<std::int64_t> order(reported.summary.points.size());
  std::iota(order.begin(), order.end(), std::int64_t{0});
  const std::int64_t most = std::max<std::int64_t>(max_lines / lines_of_each, 1);
  if (std::ssize(order) <= most) return order;
  std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
    return shown_rate(reported, a).value > shown_rate(reported, b).value;
  });
  std::vector<std::int64_t> shown;
  const std::vector<std::int64_t> leading = leading_points(reported);
  const std::vector<std::int64_t> spread = statistics::spread_over(std::ssize(order), most);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool wanted = std::ranges::binary_search(spread, static_cast<std::int64_t>(i)) ||
                        std::ranges::find(leading, order[i]) != leading.end();
    if (wanted) shown.push_back(order[i]);
  }
  return shown;
}

/// A row for each point under each condition.
Figure row_per_point(const ReportedStudy& reported) {
  const std::vector<ShownLine> lines = shown_lines(reported);
  const bool alone = reported.names.size() == 1;
  const std::vector<std::int64_t> shown = points_with_lines(reported, std::ssize(parts_of(reported)));
  const goal::Question& question = question_of(reported);
  const RateWords words = words_of_rate(reported);
  std::string caption =
      fmt::format("Proportion of the {}{}{}{}. ", words.meeting, alone ? "" : ", of all of each point",
                  has_conditions(reported) ? ", under each condition" : "",
                  goal::is_of_worst_world(question) ? ", in its worst world" : "");
  if (!reported.summary.features.dependent_trials) {
    if (!alone) caption += "Points whose bounds do not overlap differ significantly. ";
    caption +=
        "A dot at 100 % does not exclude failures: their probability may be up to 100 % minus the lower "
        "bound. ";
  }
  if (std::ssize(shown) < std::ssize(reported.summary.points)) {
    caption += fmt::format("Shown are {} of {} points, evenly spaced from the best to the worst. ",
                           shown.size(), reported.summary.points.size());
  }
  FigureData data = rates_data(words);
  double lowest = 1.0;
  for (const std::int64_t point : shown) {
    for (const ShownLine& line : lines) {
      const goal::QuestionRate rate = line.rate(point);
      data.rows.push_back(row_of(label_of_line(reported, point, line, alone), line, rate));
      lowest = std::min({lowest, rate.bounds.low, line.asked().is_null() ? 1.0 : line.asked().get<double>()});
    }
  }
  const std::size_t rows = data.rows.size() / (alone ? 1 : question.parts.size());
  const char* const title = !question.claim()          ? "How many trials succeed?"
                            : !alone                   ? "Which design points meet the goal?"
                            : has_conditions(reported) ? "Is the goal met under each condition?"
                                                       : "Is the goal met?";
  Figure figure = figure_of("success", "success", title, caption + bounds_note(reported, "dark", "bars"),
                            {std::move(data)});
  use_words(figure, words);
  const double from = lowest >= 0.8 ? std::floor(lowest * 100.0 - 0.5) / 100.0 : 0.0;
  figure.specification["layer"][0]["encoding"]["x"]["scale"]["domain"] = {from, 1};
  if (has_conditions(reported)) {
    colour_conditions(figure.specification["encoding"]["color"], reported);
  } else {
    figure.specification["encoding"]["color"] = {{"value", "var(--s1)"}};
  }
  set_rows(figure, rows, 24);
  if (!alone) divide_by_goals(figure, reported, figure.specification["height"]);
  return figure;
}

/// Evenly spaced groups, the nearest one replaced by that of the chosen point.
std::vector<std::int64_t> groups_shown(const ReportedStudy& reported, const std::vector<PointGroup>& groups,
                                       std::int64_t most) {
  std::vector<std::int64_t> shown = statistics::spread_over(std::ssize(groups), most);
  const auto chosen = std::ranges::find_if(groups, [&](const PointGroup& group) {
    return std::ranges::find(group.points, reported.chosen.point) != group.points.end();
  });
  const std::int64_t wanted = chosen - groups.begin();
  *std::ranges::min_element(shown, {}, [&](std::int64_t group) { return std::abs(group - wanted); }) = wanted;
  return shown;
}

Figure along_axis(const ReportedStudy& reported, std::size_t axis) {
  const study::SweepAxis& swept = reported.summary.axes[axis];
  const std::vector<ShownLine> lines = shown_lines(reported);
  const auto conditions = std::ssize(parts_of(reported));
  const RateWords words = words_of_rate(reported);
  const std::vector<PointGroup> groups = groups_along(reported, {axis});
  const std::int64_t most = std::max<std::int64_t>(max_series / conditions, 1);
  const char* const each = has_conditions(reported) ? " under each condition" : "";
  std::string caption = fmt::format(
      "Proportion of the {}, of all of each point{} (line), over {}. A star marks the chosen point. ",
      words.meeting, each, axis_title(swept));
  if (std::ssize(groups) > most) {
    caption += fmt::format("Shown are {} of {} lines{}: that of the chosen point, and others evenly spaced. ",
                           most, groups.size(), each);
  }
  FigureData data = rates_data(words);
  data.columns.push_back({"x", swept.name, swept.unit});
  data.columns.push_back({"series", "", ""});
  for (const std::int64_t shown : groups_shown(reported, groups, most)) {
    const PointGroup& group = groups[static_cast<std::size_t>(shown)];
    for (const ShownLine& line : lines) {
      for (const std::int64_t point : group.points) {
        ordered_json row = row_of(label_of_line(reported, point, line, false), line, line.rate(point));
        row.push_back(swept.numbers[static_cast<std::size_t>(point)]);
        row.push_back(group.label.empty() ? line.condition : study::label_under(group.label, line.condition));
        data.rows.push_back(std::move(row));
      }
    }
  }
  Figure figure =
      figure_of("success-along", "success",
                question_of(reported).claim() ? fmt::format("At which {} is the goal met?", swept.name)
                                              : fmt::format("How does success depend on {}?", swept.name),
                caption + bounds_note(reported, "dashed", "bands"), {std::move(data)});
  use_words(figure, words);
  ordered_json& encoding = figure.specification["encoding"];
  encoding["x"]["title"] = axis_title(swept);
  if (spaced_by_ratio(values_of(swept))) encoding["x"]["scale"]["type"] = "log";
  encoding["x"]["scale"]["domain"] = {values_of(swept).front(), values_of(swept).back()};
  if (groups.size() == 1) colour_conditions(encoding["color"], reported);
  divide_by_goals(figure, reported, 220);
  return figure;
}

}  // namespace

void colour_conditions(nlohmann::ordered_json& colour, const ReportedStudy& reported) {
  if (has_conditions(reported)) {
    colour_by_name(colour, reported.study.conditions);
  } else {
    colour["legend"] = nullptr;
  }
}

std::optional<Figure> success_figure(const ReportedStudy& reported) {
  if (reported.study.open_loop) return std::nullopt;
  const std::vector<std::size_t> numeric = numeric_axes(reported, 3);
  return numeric.empty() ? row_per_point(reported) : along_axis(reported, numeric.front());
}

}  // namespace zerocount::report
