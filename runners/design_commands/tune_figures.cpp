#include "runners/design_commands/tune_figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/report/figures/report_figures.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::design_commands {
namespace {

using document::Figure;
using document::FigureData;
using nlohmann::ordered_json;
using report::datum;
using tuning::MapCell;
using tuning::TriedPoint;
using tuning::TuneAnswer;
using tuning::TuningMap;
using tuning::UnitCubePoint;
using tuning::Values;
using tuning::WorstMachine;

std::string axis_title(const study::FreeParameter& parameter) {
  return parameter.unit == "1" ? parameter.name : fmt::format("{} ({})", parameter.name, parameter.unit);
}

FigureData cells_data(const TuningMap& map, const std::vector<study::FreeParameter>& free) {
  const study::FreeParameter& x = free[map.x];
  const study::FreeParameter& y = free[map.y];
  return report::data_of<MapCell>(
      "cells", map.cells,
      {{{"x", x.name, x.unit}, [](const MapCell& one) { return datum(one.x); }},
       {{"y", y.name, y.unit}, [](const MapCell& one) { return datum(one.y); }},
       {{"x_from", "", ""}, [](const MapCell& one) { return datum(one.x_from); }},
       {{"x_to", "", ""}, [](const MapCell& one) { return datum(one.x_to); }},
       {{"y_from", "", ""}, [](const MapCell& one) { return datum(one.y_from); }},
       {{"y_to", "", ""}, [](const MapCell& one) { return datum(one.y_to); }},
       {{"rate", "rate of the goal", "1"}, [](const MapCell& one) { return datum(one.rate); }},
       {{"criterion", "criterion", ""}, [](const MapCell& one) { return datum(one.criterion); }},
       {{"margins", "margins", ""},
        [](const MapCell& one) { return ordered_json(one.keeps_margins ? "kept" : "lost"); }}});
}

/// The edges between cells in which all goals seem met and cells in which they do not.
FigureData boundary_data(const TuningMap& map) {
  FigureData data{"boundary", {{"x_from", "", ""}, {"x_to", "", ""}, {"y_from", "", ""}, {"y_to", "", ""}}};
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(map.cells.size()))));
  const auto meets = [&](std::size_t i) { return map.cells[i].seems_met; };
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const MapCell& cell = map.cells[i];
    if (i % side + 1 < side && meets(i) != meets(i + 1))
      data.rows.push_back({datum(cell.x_to), datum(cell.x_to), datum(cell.y_from), datum(cell.y_to)});
    if (i + side < map.cells.size() && meets(i) != meets(i + side))
      data.rows.push_back({datum(cell.x_from), datum(cell.x_to), datum(cell.y_to), datum(cell.y_to)});
  }
  return data;
}

FigureData places_data(std::string name, const TuningMap& map, const std::vector<Values>& points) {
  return report::data_of<Values>(std::move(name), points,
                                 {{{"x", "", ""}, [&](const Values& at) { return datum(at[map.x]); }},
                                  {{"y", "", ""}, [&](const Values& at) { return datum(at[map.y]); }}});
}

Figure map_figure(const TuneAnswer& answer, const TuningMap& map) {
  const study::FreeParameter& x = answer.free[map.x];
  const study::FreeParameter& y = answer.free[map.y];
  std::vector<Values> tried;
  tried.reserve(answer.tried.size());
  for (const TriedPoint& one : answer.tried) tried.push_back(one.values);
  Figure figure = report::figure_of(
      "tuning-map", fmt::format("tuning-map-{}-{}", map.x + 1, map.y + 1),
      fmt::format("Rate of the goal over {} and {}", x.name, y.name),
      "The other free parameters are as tuned. The line encloses the cells in which the goal seems met, each "
      "by "
      "128 machines of the search; × marks cells whose loops do not keep the margins. Dots are the points "
      "that "
      "the search tried, at all values of the other parameters; the star is the tuned point.",
      {cells_data(map, answer.free), boundary_data(map), places_data("tried", map, tried),
       places_data("tuned", map, {answer.gains})});
  ordered_json& encoding = figure.specification["layer"][0]["encoding"];
  for (const auto& [axis, parameter] : {std::pair{"x", &x}, std::pair{"y", &y}}) {
    encoding[axis]["title"] = axis_title(*parameter);
    encoding[axis]["scale"]["domain"] = {parameter->low, parameter->high};
    if (parameter->logarithmic) encoding[axis]["scale"]["type"] = "log";
  }
  return figure;
}

std::string point_text(const TuneAnswer& answer, const Values& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{} {}", i > 0 ? ", " : "", answer.free[i].name, values[i]);
  return text;
}

FigureData points_data(std::string name, const TuneAnswer& answer, const std::vector<TriedPoint>& points) {
  return report::data_of<TriedPoint>(
      std::move(name), points,
      {{{"criterion", "criterion", ""}, [](const TriedPoint& one) { return datum(one.estimate.criterion); }},
       {{"rate", "rate of the goal", "1"}, [](const TriedPoint& one) { return datum(one.estimate.rate); }},
       {{"values", "values", ""},
        [&](const TriedPoint& one) { return ordered_json(point_text(answer, one.values)); }},
       {{"units", "machines or trials", "1"},
        [](const TriedPoint& one) { return ordered_json(one.estimate.units); }}});
}

Figure frontier_figure(const TuneAnswer& answer, const study::Study& study) {
  std::vector<TriedPoint> tried = answer.tried;
  std::erase_if(tried, [](const TriedPoint& one) { return !std::isfinite(one.estimate.criterion); });
  TriedPoint tuned{answer.gains, {}};
  tuned.estimate.criterion = answer.criterion;
  const goal::Verdict& verdict = answer.proof->verdict;
  tuned.estimate.rate = study.goals[verdict.goal].machines ? verdict.machines.value : verdict.moves.value;
  Figure figure = report::figure_of(
      "tuning-frontier", "tuning-frontier", "Success and speed",
      "The points that the search tried, with a finite criterion. The line joins those that no other point "
      "with as many machines beats in both; their rates are those of the search, and so a little too good. "
      "The "
      "star is the tuned point by its proof.",
      {points_data("frontier", answer, answer.frontier), points_data("tried", answer, tried),
       points_data("tuned", answer, {tuned})});
  figure.specification["layer"][0]["encoding"]["x"]["title"] = tuning::criterion_name(study);
  return figure;
}

Figure room_figure(const TuneAnswer& answer) {
  const UnitCubePoint tuned = tuning::place_of(answer.free, answer.gains);
  Values low = answer.gains;
  Values high = answer.gains;
  for (std::size_t i = 0; i < answer.room.size(); ++i) {
    low[i] = answer.room[i].low;
    high[i] = answer.room[i].high;
  }
  const UnitCubePoint low_place = tuning::place_of(answer.free, low);
  const UnitCubePoint high_place = tuning::place_of(answer.free, high);
  FigureData data{"room",
                  {{"parameter", "parameter", ""},
                   {"tuned", "tuned", ""},
                   {"low", "goal seems met from", ""},
                   {"high", "to", ""},
                   {"place", "", ""},
                   {"low_place", "", ""},
                   {"high_place", "", ""}}};
  for (std::size_t i = 0; i < answer.room.size(); ++i) {
    data.rows.push_back({axis_title(answer.free[i]), datum(answer.gains[i]), datum(low[i]), datum(high[i]),
                         datum(tuned[i]), datum(low_place[i]), datum(high_place[i])});
  }
  Figure figure = report::figure_of("tuning-room", "tuning-room", "Room of each parameter",
                                    "The interval around the tuned value in which the goal seems met, the "
                                    "others as tuned, by simulation on "
                                    "machines of the search.",
                                    {std::move(data)});
  report::set_rows(figure, answer.room.size(), 28);
  return figure;
}

Figure worst_figure(const WorstMachine& worst, const study::Study& study,
                    const reading::AllTrialsFile& file) {
  constexpr std::int64_t buckets = 400;
  const report::SampleTrial trial{"worst-machine", "The worst machine of the proof", 0, worst.trial, buckets};
  Figure figure = report::trace_figure(report::reported_study(file, std::nullopt), trial,
                                       report::replay_trial(study, 0, worst.trial, buckets));
  report::put_on_axis(figure, study.units.axis);
  return figure;
}

bool is_drawn(const Tuning& tuning) {
  return tuning.drawn && tuning.answer.proof;
}

}  // namespace

std::vector<Figure> map_figures(const Tuning& tuning) {
  std::vector<Figure> figures;
  if (!is_drawn(tuning)) return figures;
  for (const TuningMap& map : tuning.answer.maps) figures.push_back(map_figure(tuning.answer, map));
  return figures;
}

std::vector<Figure> frontier_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || tuning.answer.tried.empty()) return {};
  return {frontier_figure(tuning.answer, tuning.study)};
}

std::vector<Figure> room_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || tuning.answer.room.empty()) return {};
  return {room_figure(tuning.answer)};
}

std::vector<Figure> worst_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || !tuning.answer.worst || tuning.study.plugin) return {};
  return {
      worst_figure(*tuning.answer.worst, tuning.answer.proof->study, reading::AllTrialsFile(tuning.output))};
}

}  // namespace zerocount::design_commands
