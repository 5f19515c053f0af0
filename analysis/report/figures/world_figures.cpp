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

/// Moves of a world that are asked, and the times from which they are settled.
struct WorldMoves {
  statistics::Histogram<double> times;
  std::int64_t asked{0};
};

/// [world] those of the chosen point.
std::vector<WorldMoves> moves_of_worlds(const ReportedStudy& reported, const measures::CountedGoal& goal) {
  std::vector<WorldMoves> worlds(static_cast<std::size_t>(reported.study.worlds));
  const layout::RowRange rows = rows_of(reported, reported.chosen.point);
  measures::visit_trials(
      reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        WorldMoves& world =
            worlds[static_cast<std::size_t>(study::world_of(reported.study, row - rows.first))];
        for (const trial::MoveOutcome& move : moves) {
          if (!measures::asks(goal, move)) continue;
          ++world.asked;
          const double time = measures::settling_time(goal, move);
          if (!std::isnan(time)) world.times.add(time);
        }
      });
  return worlds;
}

/// Draws what is asked as a dashed line across the figure. @param channel "x" or "y"
void add_asked(Figure& figure, const char* channel, double value) {
  ordered_json encoding{
      {"x", nullptr}, {"y", nullptr}, {"detail", nullptr}, {"color", {{"value", "var(--ink)"}}}};
  encoding[channel] = {{"field", "asked"}, {"type", "quantitative"}};
  figure.specification["layer"].push_back(
      {{"data", {{"values", {{{"asked", value}}}}}},
       {"mark", {{"type", "rule"}, {"strokeDash", {4, 3}}, {"strokeWidth", 1.2}}},
       {"encoding", std::move(encoding)}});
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
  const goal::Question& question = reported.summary.question;
  if (!question.claim() && reported.study.features.bands.count == 0) return std::nullopt;
  const std::vector<worlds::WorldInput>& inputs =
      summary::world_inputs_of(reported.summary, reported.chosen.point);
  const std::vector<WorldMoves> moves =
      moves_of_worlds(reported, question.claim() ? question.counted() : measures::CountedGoal{.slot = 0});
  double end = question.claim() ? question.claim()->within : 0.0;
  for (const WorldMoves& one : moves) {
    if (one.times.size > 0) end = std::max(end, statistics::largest(one.times));
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
  for (std::size_t world = 0; world < std::min(moves.size(), max_world_curves); ++world) {
    add_curve(data, world, moves[world].times, moves[world].asked, end, point.bad[world],
              colours ? inputs[input].values[world] : static_cast<double>(world));
  }
  Figure figure = figure_of(
      "world-curves", "worlds", "How soon do the moves of each world settle?",
      fmt::format(
          "Proportion of the moves of each world, at {}, whose error stays within ±{} from a time "
          "on. {}. Bad worlds are coloured by {}{}.",
          label_of(reported, reported.chosen.point),
          precision_text(reported, question.claim()
                                       ? *question.claim()
                                       : study::Goal{.band = reported.study.features.bands.values()[0]}),
          summary::bad_worlds_sentence(point, inputs, reported.summary.question), parameter,
          moves.size() > max_world_curves ? fmt::format("; shown are the first {}", max_world_curves) : ""),
      {std::move(data)});
  ordered_json& layers = figure.specification["layer"];
  layers[1]["encoding"]["color"]["title"] = colours && inputs[input].unit != "1"
                                                ? fmt::format("{} ({})", parameter, inputs[input].unit)
                                                : parameter;
  if (std::ranges::find(point.bad, true) == point.bad.end())
    layers.erase(1);  // a layer without rows has no scale
  if (question.claim()) {
    add_asked(figure, "x", question.claim()->within);
    add_asked(figure, "y", question.claim()->moves);
  }
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
  if (sorted.front() > 0.0 && sorted.back() > 5.0 * sorted.front()) x["scale"] = {{"type", "log"}};
  if (const std::optional<study::Goal>& claim = reported.summary.question.claim())
    add_asked(figure, "y", claim->machines.value_or(claim->moves));
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
