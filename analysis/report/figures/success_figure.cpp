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

std::string bounds_note(const ReportedStudy& reported) {
  return fmt::format("The bars or bands are {}, for each point separately.", shown_bounds(reported));
}

std::vector<FigureColumn> common_columns(const ReportedStudy& reported) {
  const goal::QuestionWords& words = words_of(question_of(reported));
  return {{"label", "point", ""},
          {"rate", std::string(words.rate), "1"},
          {"low", "lower bound", "1"},
          {"high", "upper bound", "1"},
          {"successes", std::string(words.hits), "1"},
          {"trials", std::string(words.events), "1"}};
}

/// The trials that a point has a line of its own for: all, or those under a condition.
struct ShownLine {
  std::string condition;  ///< empty without conditions
  const ReportedStudy& study;
  goal::Question question;

  goal::QuestionRate rate(std::int64_t point) const {
    return goal::rate_of(question, point_of(study, point));
  }
};

/// The subject of a figure of rates: the study's question, or one of several goals.
struct RateSubject {
  std::string goal{};  ///< its name; empty where there are not several
  std::vector<ShownLine> lines{};

  std::string figure() const { return goal.empty() ? "success" : "success-" + goal; }
  std::string title(std::string_view of_all) const {
    return goal.empty() ? std::string(of_all) : fmt::format("{}: {}", of_all, goal);
  }
};

std::vector<RateSubject> rate_subjects(const ReportedStudy& reported) {
  std::vector<RateSubject> subjects;
  for (const goal::JudgedPart& part : question_of(reported).parts) {
    RateSubject& subject = subjects.emplace_back();
    if (has_several(question_of(reported))) subject.goal = part.claim->name;
    for (const ReportedPart& one : parts_of(reported))
      subject.lines.push_back({one.condition, one.study, only(question_of(one.study), part.number)});
  }
  return subjects;
}

/// "kp=400 ★, loaded"; of the lines of a study with one point "loaded".
std::string label_of_line(const ReportedStudy& reported, std::int64_t point, const ShownLine& line) {
  return reported.names.size() == 1 && !line.condition.empty()
             ? line.condition
             : study::label_under(marked_label_of(reported, point), line.condition);
}

ordered_json row_of(const ReportedStudy& reported, std::int64_t point, const ShownLine& line) {
  const goal::QuestionRate rate = line.rate(point);
  return ordered_json::array({label_of_line(reported, point, line), datum(rate.value), datum(rate.bounds.low),
                              datum(rate.bounds.high), rate.hits, rate.events});
}

/// " under each condition"; empty where a point has one line.
std::string_view lines_text(const ReportedStudy& reported) {
  return has_conditions(reported) ? " under each condition" : "";
}

/// Puts the words of the question in place of those of success.
void speak_of_question(Figure& figure, const goal::QuestionWords& words) {
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

Figure line_per_point(const ReportedStudy& reported, const RateSubject& subject) {
  const std::vector<std::int64_t> shown = points_with_lines(reported, std::ssize(subject.lines));
  const goal::Question& question = question_of(reported);
  const goal::QuestionWords& words = words_of(question);
  std::string caption =
      fmt::format("Proportion of the {}, of all of each point{}{}. ", words.meeting, lines_text(reported),
                  goal::is_of_worst_world(question) ? " in its worst world" : "");
  if (!reported.summary.features.dependent_trials) {
    caption +=
        "Points whose bounds do not overlap differ significantly. A dot at 100 % does not exclude failures: "
        "their "
        "probability may be up to 100 % minus the lower bound. ";
  }
  if (std::ssize(shown) < std::ssize(reported.summary.points)) {
    caption += fmt::format("Shown are {} of {} points, evenly spaced from the best to the worst. ",
                           shown.size(), reported.summary.points.size());
  }
  FigureData data{"points", common_columns(reported)};
  double lowest = 1.0;
  for (const std::int64_t point : shown) {
    for (const ShownLine& line : subject.lines) {
      data.rows.push_back(row_of(reported, point, line));
      lowest = std::min(lowest, line.rate(point).bounds.low);
    }
  }
  Figure figure =
      figure_of("success", subject.figure(), subject.title(fmt::format("{} at each point", words.title)),
                caption + bounds_note(reported), {std::move(data)});
  speak_of_question(figure, words);
  const double from = lowest > 0.9 ? std::floor(lowest * 100.0) / 100.0 : 0.0;
  figure.specification["layer"][0]["encoding"]["x"]["scale"]["domain"] = {from, 1};
  set_rows(figure, shown.size() * subject.lines.size(), 24);
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

Figure along_axis(const ReportedStudy& reported, const RateSubject& subject, std::size_t axis) {
  const study::SweepAxis& swept = reported.summary.axes[axis];
  const goal::QuestionWords& words = words_of(question_of(reported));
  const std::vector<PointGroup> groups = groups_along(reported, {axis});
  const std::int64_t most = std::max<std::int64_t>(max_series / std::ssize(subject.lines), 1);
  std::string caption = fmt::format(
      "Proportion of the {}, of all of each point{} (line), over {}. A star marks the chosen point. ",
      words.meeting, lines_text(reported), axis_title(swept));
  if (std::ssize(groups) > most) {
    caption += fmt::format("Shown are {} of {} lines{}: that of the chosen point, and others evenly spaced. ",
                           most, groups.size(), lines_text(reported));
  }
  FigureData data{"points", common_columns(reported)};
  data.columns.push_back({"x", swept.name, swept.unit});
  data.columns.push_back({"series", "", ""});
  for (const std::int64_t shown : groups_shown(reported, groups, most)) {
    const PointGroup& group = groups[static_cast<std::size_t>(shown)];
    for (const ShownLine& line : subject.lines) {
      for (const std::int64_t point : group.points) {
        ordered_json row = row_of(reported, point, line);
        row.push_back(swept.numbers[static_cast<std::size_t>(point)]);
        row.push_back(group.label.empty() ? line.condition : study::label_under(group.label, line.condition));
        data.rows.push_back(std::move(row));
      }
    }
  }
  Figure figure = figure_of("success-along", subject.figure(),
                            subject.title(fmt::format("{} over {}", words.title, swept.name)),
                            caption + bounds_note(reported), {std::move(data)});
  speak_of_question(figure, words);
  ordered_json& encoding = figure.specification["encoding"];
  encoding["x"]["title"] = axis_title(swept);
  if (spaced_by_ratio(values_of(swept))) encoding["x"]["scale"]["type"] = "log";
  encoding["x"]["scale"]["domain"] = {values_of(swept).front(), values_of(swept).back()};
  if (groups.size() * subject.lines.size() == 1) encoding["color"]["legend"] = nullptr;
  return figure;
}

}  // namespace

std::vector<Figure> success_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  if (reported.study.open_loop) return figures;
  const std::vector<std::size_t> numeric = numeric_axes(reported, 3);
  for (const RateSubject& subject : rate_subjects(reported))
    figures.push_back(numeric.empty() ? line_per_point(reported, subject)
                                      : along_axis(reported, subject, numeric.front()));
  return figures;
}

}  // namespace zerocount::report
