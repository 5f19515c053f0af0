#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/quantity.hpp"
#include "analysis/text/text.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_curves = 6;   ///< of a figure; under conditions at least one for each
constexpr std::int64_t max_steps = 160;  ///< of a curve

/// Half-width of the simultaneous confidence band of a distribution function: √(ln(2M/α)/2n) for n
/// independent clusters (trials or rigs) of M dependent moves each. (Dvoretzky, Kiefer and Wolfowitz 1956
/// with the constant of Massart 1990, for each of the M moves at the level α/M; the mean of M functions that
/// are each within the band is so too.)
double band_of(const ReportedStudy& reported, const measures::PointSummary& point) {
  const std::int64_t clusters = reported.study.rigs > 0 ? reported.study.rigs : point.trials;
  const std::int64_t moves = point.moves / clusters;
  const double alpha = 1.0 - statistics::summary_confidence;
  return std::sqrt(std::log(2.0 * static_cast<double>(moves) / alpha) /
                   (2.0 * static_cast<double>(clusters)));
}

statistics::Histogram<double> settling_times(const ReportedStudy& reported, std::int64_t point) {
  statistics::Histogram<double> times;
  measures::visit_trials(reported.file, rows_of(reported, point),
                         [&](std::int64_t, std::span<const trial::MoveOutcome> moves) {
                           for (const trial::MoveOutcome& move : moves) {
                             if (move.arrived) times.add(move.settling_time);
                           }
                         });
  return times;
}

const measures::MeasureStatistics& settling_of(const ReportedStudy& reported, std::int64_t point) {
  return point_of(reported, point).of(&trial::MoveOutcome::settling_time);
}

/// The points with arrivals; if there are too many, evenly spaced ones from the best to the worst, of which
/// the nearest ones are replaced by the leading points.
std::vector<std::int64_t> points_with_curves(const ReportedStudy& reported) {
  const std::int64_t most =
      std::max<std::int64_t>(max_curves / std::max<std::int64_t>(std::ssize(reported.conditions), 1), 1);
  std::vector<std::int64_t> with_arrivals;
  const auto& points = reported.summary.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].of(&trial::MoveOutcome::settling_time).n > 0)
      with_arrivals.push_back(static_cast<std::int64_t>(i));
  }
  if (std::ssize(with_arrivals) <= most) return with_arrivals;
  std::stable_sort(with_arrivals.begin(), with_arrivals.end(), [&](std::int64_t a, std::int64_t b) {
    return settling_of(reported, a).n > settling_of(reported, b).n;
  });
  std::vector<std::int64_t> shown;
  for (const std::int64_t point : leading_points(reported)) {
    if (settling_of(reported, point).n > 0 && std::ssize(shown) < most) shown.push_back(point);
  }
  for (const std::int64_t i : statistics::spread_over(std::ssize(with_arrivals), most)) {
    const std::int64_t point = with_arrivals[static_cast<std::size_t>(i)];
    if (std::ssize(shown) < most && std::ranges::find(shown, point) == shown.end()) shown.push_back(point);
  }
  std::sort(shown.begin(), shown.end());
  return shown;
}

void add_curve(FigureData& data, const std::string& label, const statistics::Histogram<double>& times,
               std::int64_t moves, double half_width, double end) {
  const auto row = [&](double time, std::int64_t arrived) {
    const double proportion = static_cast<double>(arrived) / static_cast<double>(moves);
    data.rows.push_back(ordered_json::array({label, datum(time), datum(proportion),
                                             datum(std::max(0.0, proportion - half_width)),
                                             datum(std::min(1.0, proportion + half_width))}));
  };
  row(0.0, 0);
  std::int64_t arrived = 0;
  std::int64_t shown = 0;
  for (const auto& [time, count] : times.counts) {
    arrived += count;
    const bool last = arrived == times.size;
    if (last || (arrived - shown) * max_steps >= times.size) {
      row(time, arrived);
      shown = arrived;
    }
  }
  if (times.size == 0 || statistics::largest(times) < end) row(end, arrived);
}

/// "kp=400, loaded"; of a study with one point "loaded".
std::string label_of_curve(const ReportedStudy& reported, const ReportedPart& part, std::int64_t point) {
  return has_conditions(reported) && reported.names.size() == 1
             ? part.condition
             : study::label_under(marked_label_of(reported, point), part.condition);
}

std::optional<Figure> arrival_figure(const ReportedStudy& reported) {
  const std::vector<std::int64_t> shown = points_with_curves(reported);
  if (shown.empty()) return std::nullopt;
  const auto& points = reported.summary.points;
  const std::int64_t moves_per_trial = reported.file.moves();
  std::string caption = fmt::format(
      "Proportion of all moves of a point that have arrived by a time: their error was first 0 for the whole "
      "dwell (also if they left the target later). A curve that ends below 100 % has moves that never "
      "arrived. The bands {} (Dvoretzky-Kiefer-Wolfowitz, n = "
      "{}{}). ",
      reported.summary.features.dependent_trials
          ? "would contain the whole curve of a point with 95 % confidence if its trials were independent"
          : "contain the whole curve of a point with 95 % confidence",
      reported.study.rigs > 0 ? fmt::format("{} rigs", reported.study.rigs)
                              : fmt::format("{} trials", study::draw_count(reported.study)),
      reported.study.rigs == 0 && moves_per_trial > 1 ? fmt::format(" of {} moves each", moves_per_trial)
                                                      : "");
  const auto arriving = std::count_if(points.begin(), points.end(), [](const measures::PointSummary& point) {
    return point.of(&trial::MoveOutcome::settling_time).n > 0;
  });
  if (std::ssize(shown) < arriving) {
    caption += fmt::format("Shown are {} of {} points: the chosen one{}. ", shown.size(), arriving,
                           shown.size() == 1 ? "" : ", the first, the runner-up, and others");
  }
  if (arriving < std::ssize(points))
    caption +=
        fmt::format("At {} of the {} points no move arrived. ", std::ssize(points) - arriving, points.size());
  FigureData data{"steps",
                  {{"label", "point", ""},
                   {"time", "arrived by", "s"},
                   {"share", "proportion of moves", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"}}};
  double end = 0.0;
  double start = std::numeric_limits<double>::infinity();
  for (const std::int64_t point : shown) {
    end = std::max(end, settling_of(reported, point).max);
    start = std::min(start, settling_of(reported, point).median.value);
  }
  for (const std::int64_t point : shown) {
    for (const ReportedPart& part : parts_of(reported)) {
      const measures::PointSummary& summary = point_of(part.study, point);
      add_curve(data, label_of_curve(reported, part, point), settling_times(part.study, point), summary.moves,
                band_of(part.study, summary), end);
    }
  }
  Figure figure = figure_of("settling-time", "settling-time", "How soon do the moves arrive?", caption,
                            {std::move(data)});
  ordered_json& x = figure.specification["encoding"]["x"];
  if (start > 0.0 && end > 12.0 * start) {  // otherwise a few late arrivals would compress all others
    x["scale"]["type"] = "symlog";
    x["scale"]["constant"] = start / 4.0;
    x["axis"]["values"] = round_numbers(0.0, end, start / 4.0);
    figure.caption += "The time axis is linear near zero and logarithmic beyond.";
  }
  if (shown.size() == 1) colour_conditions(figure.specification["encoding"]["color"], reported);
  return figure;
}

/// A goal or an error band in which moves settle.
struct SettledSubject {
  std::string name;                    ///< of the goal; of a band "±1 count"
  std::string precision;               ///< "1 count", "10 nm"
  measures::CountedGoal counted;       ///< the moves that are asked, and where they settle
  std::optional<study::Goal> claim{};  ///< whose lines are drawn
};

std::vector<SettledSubject> settled_subjects(const ReportedStudy& reported) {
  const goal::Question& question = question_of(reported);
  std::vector<SettledSubject> subjects;
  if (question.claim()) {
    for (const goal::JudgedPart& part : question.parts)
      subjects.push_back({part.claim->name, precision_text(reported, *part.claim), part.counted, part.claim});
    return subjects;
  }
  const trial::ErrorBands& bands = reported.study.features.bands;
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    const std::string precision = precision_text(reported, {.band = bands.values()[slot]});
    subjects.push_back({"±" + precision, precision, {.slot = slot}});
  }
  return subjects;
}

/// The moves of the chosen point that are asked, and the times from which they are settled.
struct SettledMoves {
  statistics::Histogram<double> times;
  std::int64_t asked{0};
};

SettledMoves settled_moves(const ReportedStudy& reported, const measures::CountedGoal& goal) {
  SettledMoves settled;
  measures::visit_trials(reported.file, rows_of(reported, reported.chosen.point),
                         [&](std::int64_t, std::span<const trial::MoveOutcome> moves) {
                           for (const trial::MoveOutcome& move : moves) {
                             if (!measures::asks(goal, move)) continue;
                             ++settled.asked;
                             const double time = measures::settling_time(goal, move);
                             if (!std::isnan(time)) settled.times.add(time);
                           }
                         });
  return settled;
}

/// Adds the curves of a subject, one for each condition; returns whether a move settles.
bool add_settled(FigureData& data, const ReportedStudy& reported, const SettledSubject& subject) {
  std::vector<SettledMoves> settled;
  const std::vector<ReportedPart> parts = parts_of(reported);
  double end = 0.0;
  for (const ReportedPart& part : parts) {
    settled.push_back(settled_moves(part.study, subject.counted));
    if (settled.back().times.size > 0) end = std::max(end, statistics::largest(settled.back().times));
  }
  if (end == 0.0) return false;
  if (subject.claim) end = std::max(end, subject.claim->within);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t first = data.rows.size();
    add_curve(data, has_conditions(reported) ? parts[i].condition : subject.name, settled[i].times,
              settled[i].asked, band_of(parts[i].study, point_of(parts[i].study, reported.chosen.point)),
              end);
    for (std::size_t row = first; row < data.rows.size(); ++row) data.rows[row].push_back(subject.name);
  }
  return true;
}

/// The times of the goals and their proportions of moves, as rules across the figure.
void add_goals(Figure& figure, const std::vector<SettledSubject>& subjects) {
  FigureData goals{"goals",
                   {{"within", "within", "s"}, {"moves", "proportion of moves", "1"}, {"subject", "", ""}}};
  for (const SettledSubject& one : subjects)
    if (one.claim) goals.rows.push_back({one.claim->within, one.claim->moves, one.name});
  if (goals.rows.empty()) return;
  figure.data.push_back(std::move(goals));
  const ordered_json start{{"value", 0}};
  const auto add = [&](ordered_json encoding) {
    encoding["color"] = {{"value", "var(--ink)"}};
    figure.specification["layer"].push_back(
        {{"data", {{"name", "goals"}}},
         {"mark", {{"type", "rule"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1.2}}},
         {"encoding", std::move(encoding)}});
  };
  add({{"x", {{"field", "within"}, {"type", "quantitative"}}}, {"y", start}, {"y2", {{"value", "height"}}}});
  add({{"x", start}, {"x2", {{"value", "width"}}}, {"y", {{"field", "moves"}, {"type", "quantitative"}}}});
}

/// "large: ±10 nm after 30 ms in 95 % of the moves".
std::string goal_text(const SettledSubject& subject) {
  return fmt::format("{}{}±{} after {} in {} of the moves", subject.name, subject.name.empty() ? "" : ": ",
                     subject.precision, text::quantity_text(subject.claim->within, "s"),
                     text::percent(subject.claim->moves));
}

/// A curve for each goal, or band, and condition: goals, and bands with conditions, in panels of their own.
std::optional<Figure> settled_figure(const ReportedStudy& reported) {
  FigureData data{"steps",
                  {{"label", has_conditions(reported) ? "condition" : "of", ""},
                   {"time", "settled for good from", "s"},
                   {"share", "proportion of moves", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"},
                   {"subject", has_conditions(reported) ? "goal or band" : "", ""}}};
  std::vector<SettledSubject> subjects = settled_subjects(reported);
  std::erase_if(subjects, [&](const SettledSubject& one) { return !add_settled(data, reported, one); });
  if (subjects.empty()) return std::nullopt;
  const bool with_claim = subjects.front().claim.has_value();
  const bool with_limits =
      std::ranges::any_of(subjects, [](const SettledSubject& one) { return !one.counted.limits.empty(); });
  std::string caption = fmt::format(
      "Proportion of the moves of {} whose error stays within ±{} from a time on to the end of the move{}. ",
      label_of(reported, reported.chosen.point), subjects.size() == 1 ? subjects.front().precision : "b",
      has_conditions(reported) ? ", under each condition" : "");
  if (with_claim) caption += "The dashed lines are the goal: the curve must pass above their crossing. ";
  if (with_claim && subjects.size() == 1) caption += fmt::format("It asks {}. ", goal_text(subjects.front()));
  if (!with_claim) caption += "Shortly before the end there is little time left to leave a band in. ";
  if (with_limits) caption += "The limits of the goal are not in it. ";
  if (reported.study.worlds > 0) caption += "It is an average over the worlds. ";
  Figure figure =
      figure_of("settling-time", "settled",
                subjects.size() == 1
                    ? fmt::format("How soon are the moves within ±{} for good?", subjects.front().precision)
                    : fmt::format("How soon are the moves within {} for good?",
                                  with_claim ? "what each goal asks" : "each band"),
                caption, {std::move(data)});
  ordered_json& encoding = figure.specification["encoding"];
  encoding["x"]["title"] = "time since the start of the move (s)";
  figure.specification["layer"][0]["encoding"]["y"]["title"] = "proportion of moves";
  if (has_conditions(reported) || with_claim) colour_conditions(encoding["color"], reported);
  add_goals(figure, subjects);
  if (!has_conditions(reported) && !with_claim) return figure;
  std::vector<FigurePanel> panels;
  panels.reserve(subjects.size());
  for (const SettledSubject& one : subjects)
    panels.push_back({one.name, one.claim ? goal_text(one) : one.name});
  if (panels.size() > 1) figure.specification["height"] = 190;
  divide_into_panels(figure, "subject", panels);
  return figure;
}

}  // namespace

std::vector<Figure> distribution_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  const auto add = [&](std::optional<Figure> figure) {
    if (figure) figures.push_back(std::move(*figure));
  };
  if (!question_of(reported).claim()) add(arrival_figure(reported));
  if (!reported.study.open_loop) add(settled_figure(reported));
  return figures;
}

}  // namespace zerocount::report
