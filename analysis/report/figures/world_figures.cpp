#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "analysis/summary/worlds_of_point.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_parameters = 6;
constexpr std::size_t max_world_curves = 200;  ///< worlds with a curve
constexpr std::int64_t max_world_steps = 80;   ///< of a curve

/// The parameter of a rule, or the first.
std::size_t leading_input(const worlds::PointWorlds& point) {
  return point.rule ? point.rule->conditions.front().input : 0;
}

/// [world] times from which the error stays within the band of this slot, of moves of the chosen point.
std::vector<statistics::Histogram<double>> times_of_worlds(const ReportedStudy& reported, std::size_t slot) {
  std::vector<statistics::Histogram<double>> times(static_cast<std::size_t>(reported.study.worlds));
  const layout::RowRange rows = rows_of(reported, reported.chosen.point);
  measures::visit_trials(
      reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const auto world = static_cast<std::size_t>(study::world_of(reported.study, row - rows.first));
        for (const trial::MoveOutcome& move : moves) {
          const double time = move.bands[slot].settling_time;
          if (!std::isnan(time)) times[world].add(time);
        }
      });
  return times;
}

void add_curve(FigureData& data, std::size_t world, const statistics::Histogram<double>& times,
               std::int64_t moves, double end, bool bad, double value) {
  const auto row = [&](double time, std::int64_t settled) {
    const double share = static_cast<double>(settled) / static_cast<double>(moves);
    data.rows.push_back(ordered_json::array({world, datum(time), datum(share), bad, datum(value)}));
  };
  row(0.0, 0);
  std::int64_t settled = 0;
  std::int64_t shown = 0;
  for (const auto& [time, count] : times.counts) {
    settled += count;
    if (settled < times.size && (settled - shown) * max_world_steps < times.size) continue;
    row(time, settled);
    shown = settled;
  }
  row(end, settled);
}

/// One curve of settled moves for each world ("horsetail").
std::optional<Figure> curves_figure(const ReportedStudy& reported, const worlds::PointWorlds& point) {
  const trial::ErrorBands& bands = reported.study.features.bands;
  if (bands.count == 0) return std::nullopt;
  const std::vector<worlds::WorldInput>& inputs =
      summary::world_inputs_of(reported.summary, reported.chosen.point);
  const std::size_t slot = reported.summary.question.counted().slot.value_or(0);
  const std::vector<statistics::Histogram<double>> times = times_of_worlds(reported, slot);
  double end = 0.0;
  for (const statistics::Histogram<double>& one : times) {
    if (one.size > 0) end = std::max(end, statistics::largest(one));
  }
  const bool colours = !inputs.empty();
  const std::size_t input = leading_input(point);
  const std::string parameter = colours ? inputs[input].name : std::string("world");
  FigureData data{"steps",
                  {{"world", "world", ""},
                   {"time", "within the band for good from", "s"},
                   {"share", "proportion of moves", "1"},
                   {"bad", "bad world", ""},
                   {"value", parameter, colours ? inputs[input].unit : "1"}}};
  const std::vector<measures::MoveCounts> trials =
      measures::in_worlds(point_of(reported, reported.chosen.point).worlds->succeeded);
  for (std::size_t world = 0; world < std::min(times.size(), max_world_curves); ++world) {
    const std::int64_t moves = trials[world].moves * reported.file.moves();
    add_curve(data, world, times[world], moves, end, point.bad[world],
              colours ? inputs[input].values[world] : static_cast<double>(world));
  }
  Figure figure = figure_of(
      "world-curves", "worlds", "How soon do the moves of each world settle?",
      fmt::format(
          "Proportion of the moves of each world, at {}, whose error stays within ±{} counts from a time "
          "on. {}. Bad worlds are coloured by {}{}.",
          label_of(reported, reported.chosen.point), bands.values()[slot],
          summary::bad_worlds_sentence(point, inputs, reported.summary.question), parameter,
          times.size() > max_world_curves ? fmt::format("; shown are the first {}", max_world_curves) : ""),
      {std::move(data)});
  figure.specification["layer"][1]["encoding"]["color"]["title"] =
      colours && inputs[input].unit != "1" ? fmt::format("{} ({})", parameter, inputs[input].unit)
                                           : parameter;
  return figure;
}

/// The rate of each world over a parameter that differs between them.
Figure rate_figure(const ReportedStudy& reported, const worlds::PointWorlds& point, std::size_t input) {
  const worlds::WorldInput& parameter =
      summary::world_inputs_of(reported.summary, reported.chosen.point)[input];
  FigureData data{"worlds",
                  {{"world", "world", ""},
                   {"value", parameter.name, parameter.unit},
                   {"rate", "rate", "1"},
                   {"low", "lower bound", "1"},
                   {"high", "upper bound", "1"},
                   {"kind", "kind", ""}}};
  for (std::size_t world = 0; world < point.bad.size(); ++world) {
    const goal::BoundedProportion& rate = point.asked.worlds[world];
    data.rows.push_back(
        ordered_json::array({world, datum(parameter.values[world]), datum(rate.value), datum(rate.low),
                             datum(rate.high), point.bad[world] ? "bad world" : "other world"}));
  }
  Figure figure = figure_of(
      "world-rate", fmt::format("world-rate-{}", input + 1),
      fmt::format("Does {} decide whether a world is good?", parameter.name),
      fmt::format("Proportion of the {} in each world, at {}, with one-sided bounds {}.",
                  goal::judged_meeting(reported.summary.question), label_of(reported, reported.chosen.point),
                  point.goal ? "which all hold together with the confidence of the goal"
                             : "each world alone, with 95 % confidence"),
      {std::move(data)});
  ordered_json& x = figure.specification["encoding"]["x"];
  x["title"] =
      parameter.unit == "1" ? parameter.name : fmt::format("{} ({})", parameter.name, parameter.unit);
  std::vector<double> sorted = parameter.values;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.front() > 0.0 && sorted.back() > 5.0 * sorted.front()) x["scale"]["type"] = "log";
  return figure;
}

}  // namespace

std::vector<Figure> world_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  const summary::StudySummary& study = reported.summary;
  const std::optional<worlds::PointWorlds> found = summary::worlds_of_point(study, reported.chosen.point);
  if (!found) return figures;
  const worlds::PointWorlds& point = *found;
  if (std::optional<Figure> curves = curves_figure(reported, point)) figures.push_back(std::move(*curves));
  const std::size_t inputs = summary::world_inputs_of(study, reported.chosen.point).size();
  for (std::size_t input = 0; input < std::min(inputs, max_parameters); ++input)
    figures.push_back(rate_figure(reported, point, input));
  return figures;
}

}  // namespace zerocount::report
