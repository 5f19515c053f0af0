#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_curves = 6;
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
  std::vector<std::int64_t> with_arrivals;
  const auto& points = reported.summary.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].of(&trial::MoveOutcome::settling_time).n > 0)
      with_arrivals.push_back(static_cast<std::int64_t>(i));
  }
  if (std::ssize(with_arrivals) <= max_curves) return with_arrivals;
  std::stable_sort(with_arrivals.begin(), with_arrivals.end(), [&](std::int64_t a, std::int64_t b) {
    return settling_of(reported, a).n > settling_of(reported, b).n;
  });
  std::vector<std::int64_t> shown;
  for (const std::int64_t point : leading_points(reported)) {
    if (settling_of(reported, point).n > 0) shown.push_back(point);
  }
  for (const std::int64_t i : statistics::spread_over(std::ssize(with_arrivals), max_curves)) {
    const std::int64_t point = with_arrivals[static_cast<std::size_t>(i)];
    if (std::ssize(shown) < max_curves && std::ranges::find(shown, point) == shown.end())
      shown.push_back(point);
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
  if (statistics::largest(times) < end) row(end, arrived);
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
                              : fmt::format("{} trials", points.front().trials),
      reported.study.rigs == 0 && moves_per_trial > 1 ? fmt::format(" of {} moves each", moves_per_trial)
                                                      : "");
  const auto arriving = std::count_if(points.begin(), points.end(), [](const measures::PointSummary& point) {
    return point.of(&trial::MoveOutcome::settling_time).n > 0;
  });
  if (std::ssize(shown) < arriving) {
    caption +=
        fmt::format("Shown are {} of {} points: the chosen one, the first, the runner-up, and others. ",
                    shown.size(), arriving);
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
    const measures::PointSummary& summary = point_of(reported, point);
    add_curve(data, marked_label_of(reported, point), settling_times(reported, point), summary.moves,
              band_of(reported, summary), end);
  }
  Figure figure = figure_of("settling-time", "settling-time", "Arrival", caption, {std::move(data)});
  ordered_json& x = figure.specification["encoding"]["x"];
  if (start > 0.0 && end > 12.0 * start) {  // otherwise a few late arrivals would compress all others
    x["scale"]["type"] = "symlog";
    x["scale"]["constant"] = start / 4.0;
    x["axis"]["format"] = "~g";
    x["axis"]["values"] = round_numbers(0.0, end, start / 4.0);
    figure.caption += "The time axis is linear near zero and logarithmic beyond.";
  }
  if (shown.size() == 1) figure.specification["encoding"]["color"]["legend"] = nullptr;
  return figure;
}

/// Times from which the error stays within the band to the end of the move.
statistics::Histogram<double> times_in_band(const ReportedStudy& reported, std::int64_t point,
                                            std::size_t slot) {
  statistics::Histogram<double> times;
  measures::visit_trials(reported.file, rows_of(reported, point),
                         [&](std::int64_t, std::span<const trial::MoveOutcome> moves) {
                           for (const trial::MoveOutcome& move : moves) {
                             if (!std::isnan(move.bands[slot].settling_time))
                               times.add(move.bands[slot].settling_time);
                           }
                         });
  return times;
}

/// The time of the goal and its proportion of moves, as rules across the figure.
void add_goal(Figure& figure, const goal::Question& question) {
  const study::Goal& goal = *question.claim();
  figure.data.push_back({"goal",
                         {{"within", "within", "s"}, {"moves", "proportion of moves", "1"}},
                         {ordered_json::array({goal.within, goal.moves})}});
  const ordered_json start{{"value", 0}};
  const auto add = [&](ordered_json encoding) {
    encoding["color"] = {{"value", "var(--ink)"}};
    figure.specification["layer"].push_back(
        {{"data", {{"name", "goal"}}},
         {"mark", {{"type", "rule"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1.2}}},
         {"encoding", std::move(encoding)}});
  };
  add({{"x", {{"field", "within"}, {"type", "quantitative"}}}, {"y", start}, {"y2", {{"value", "height"}}}});
  add({{"x", start}, {"x2", {{"value", "width"}}}, {"y", {{"field", "moves"}, {"type", "quantitative"}}}});
  figure.caption +=
      fmt::format("The dashed lines are the goal: ±{} counts after {} s, in {} of the moves{}. ", goal.band,
                  text::short_number(goal.within), text::percent(goal.moves),
                  question.worlds > 0 ? " of each world" : "");
}

/// Nothing for a file without bands.
std::optional<Figure> band_figure(const ReportedStudy& reported) {
  const trial::ErrorBands& bands = reported.study.features.bands;
  const std::int64_t point = reported.chosen.point;
  const measures::PointSummary& summary = point_of(reported, point);
  FigureData data{"steps",
                  {{"label", "band", ""},
                   {"time", "within the band for good from", "s"},
                   {"share", "proportion of moves", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"}}};
  std::vector<statistics::Histogram<double>> times;
  double end = 0.0;
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    times.push_back(times_in_band(reported, point, slot));
    if (times.back().size > 0) end = std::max(end, statistics::largest(times.back()));
  }
  if (end == 0.0) return std::nullopt;
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    if (times[slot].size == 0) continue;
    add_curve(data, fmt::format("±{}", bands.values()[slot]), times[slot], summary.moves,
              band_of(reported, summary), end);
  }
  Figure figure = figure_of(
      "settling-time", "settled", "Within the band for good",
      fmt::format("Proportion of all moves of {} whose error stays within ±b counts from a time on to the "
                  "end of the move. Shortly before the end there is little time left to leave a band in. ",
                  label_of(reported, point)),
      {std::move(data)});
  ordered_json& encoding = figure.specification["encoding"];
  encoding["x"]["title"] = "within the band for good from (s)";
  figure.specification["layer"][0]["encoding"]["y"]["title"] = "proportion of moves";
  if (reported.study.worlds > 0) figure.caption += "It is an average over the worlds. ";
  for (const goal::JudgedPart& part : question_of(reported).parts)
    if (part.claim && !part.claim->tolerance) add_goal(figure, only(question_of(reported), part.number));
  return figure;
}

}  // namespace

std::vector<Figure> distribution_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  if (std::optional<Figure> arrival = arrival_figure(reported)) figures.push_back(std::move(*arrival));
  if (reported.study.open_loop) return figures;
  if (std::optional<Figure> settled = band_figure(reported)) figures.push_back(std::move(*settled));
  if (question_of(reported).claim()) std::ranges::reverse(figures);  // what the goal is about comes first
  return figures;
}

}  // namespace zerocount::report
