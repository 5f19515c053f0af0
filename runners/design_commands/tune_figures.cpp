#include "runners/design_commands/tune_figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/report/figures/figure.hpp"
#include "analysis/text/quantity.hpp"

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

FigureData boundaries_of(const TuningMap& map) {
  std::vector<report::CellEdges> cells;
  cells.reserve(map.cells.size());
  for (const MapCell& one : map.cells) cells.push_back({one.x_from, one.x_to, one.y_from, one.y_to});
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(cells.size()))));
  FigureData data = report::boundaries_data();
  report::add_boundary(data, "goal seems met", cells, side,
                       [&](std::size_t i) { return map.cells[i].seems_met; });
  report::add_boundary(data, "margins kept", cells, side,
                       [&](std::size_t i) { return map.cells[i].keeps_margins; });
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
  Figure figure = report::figure_of(
      "tuning-map", fmt::format("tuning-map-{}-{}", map.x + 1, map.y + 1),
      fmt::format("Which {} and {} meet the goal?", x.name, y.name),
      "The other free parameters are as tuned. The lines enclose the cells in which the goal seems met, each "
      "by "
      "128 machines of the search, and those whose loops keep the margins; pale cells do not keep them. The "
      "star "
      "is the tuned point, at which its cell is examined; the others are examined at their centres.",
      {cells_data(map, answer.free), boundaries_of(map), places_data("tuned", map, {answer.gains})});
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

Figure lost_ages_figure(const tuning::LostAges& life, const study::Study& study) {
  FigureData data{"ages",
                  {{"series", "of", ""},
                   {"age", "age", study.ages.unit},
                   {"rate", "proportion", "1"},
                   {"low", "lower bound", "1"},
                   {"high", "upper bound", "1"},
                   {"asked", "asked", "1"}}};
  for (std::size_t i = 0; i < life.claims.size(); ++i) {
    const tuning::ClaimOfLife& claim = life.claims[i].claim;
    const study::Goal& goal = study.goals[claim.goal];
    const std::string name =
        (goal.machines ? "machines in the goal" : "moves in the goal") + tuning::text_of(study, claim);
    for (const tuning::AgeVerdict& at : life.tried)
      data.rows.push_back({name, datum(at.age), datum(at.rates[i].value), datum(at.rates[i].low),
                           datum(at.rates[i].high), datum(goal.machines.value_or(goal.moves))});
  }
  Figure figure = report::figure_of(
      "ages", "tuning-ages", "How long do the tuned values hold?",
      fmt::format("Proportions at each age that was tried, by {} machines that the search did not use, with "
                  "one-sided bounds at the goal's confidence. Dashed: what is asked. Beyond {}, the last age "
                  "of the study, the laws of aging are extrapolated.",
                  life.units, study::age_text(study.ages, study.ages.at.back())),
      {std::move(data)});
  std::vector<double> ages;
  for (const tuning::AgeVerdict& at : life.tried) ages.push_back(at.age);
  report::scale_ages(figure, ages, study.ages.unit);
  return figure;
}

/// The criterion of both sets of values over the ages of each interval; an age at which it is never is left
/// out.
Figure retuning_figure(const tuning::Retuning& retuning, const study::Study& study) {
  FigureData data{"ages",
                  {{"series", "values", ""},
                   {"from", "tuned at", study.ages.unit},
                   {"age", "age", study.ages.unit},
                   {"criterion", criterion_title(study), ""}}};
  std::vector<double> ages;
  for (const tuning::RetunedInterval& one : retuning.intervals) {
    for (const auto& [name, verdicts] :
         {std::pair{"one set for the whole life", &one.one_set}, std::pair{"tuned again", &one.retuned}}) {
      for (const tuning::AgeVerdict& at : *verdicts) {
        if (!std::isfinite(at.criterion)) continue;
        data.rows.push_back({name, datum(one.interval.from()), datum(at.age), datum(at.criterion)});
        ages.push_back(at.age);
      }
    }
  }
  Figure figure = report::figure_of(
      "retuning", "tuning-retuning", "What does tuning again buy?",
      fmt::format(
          "The criterion of the worst goal and condition at the beginning and the end of each interval "
          "of {}, and at the ages of the study between, on the same fresh machines; a line for each "
          "interval. Lower is better. An age at which it is not reached within the hold is left out.",
          study::age_text(study.ages, retuning.every)),
      {std::move(data)});
  figure.specification["encoding"]["y"]["title"] = criterion_title(study);
  std::ranges::sort(ages);
  ages.erase(std::unique(ages.begin(), ages.end()), ages.end());
  report::scale_ages(figure, ages, study.ages.unit);
  return figure;
}

/// The proportion that the worst goal of the proof asks for.
double asked_of(const TuneAnswer& answer, const study::Study& study) {
  const study::Goal& goal = study.goals[answer.proof->verdict.goal];
  return goal.machines.value_or(goal.moves);
}

Figure frontier_figure(const TuneAnswer& answer, const study::Study& study) {
  std::vector<TriedPoint> tried = answer.tried;
  std::erase_if(tried, [](const TriedPoint& one) { return !std::isfinite(one.estimate.criterion); });
  TriedPoint tuned{answer.gains, {}};
  tuned.estimate.criterion = answer.criterion;
  const goal::Verdict& verdict = answer.proof->verdict;
  tuned.estimate.rate = study.goals[verdict.goal].machines ? verdict.machines.value : verdict.moves.value;
  Figure figure = report::figure_of(
      "tuning-frontier", "tuning-frontier", "What does more speed cost?",
      "The points that the search tried, with a finite criterion; what the goal asks for is dashed. The line "
      "joins those that no other point "
      "with as many machines beats in both; their rates are those of the search, and so a little too good. "
      "The "
      "star is the tuned point by its proof.",
      {points_data("frontier", answer, answer.frontier),
       points_data("tried", answer, tried),
       points_data("tuned", answer, {tuned}),
       {"asked", {{"rate", "asked for", "1"}}, {ordered_json::array({asked_of(answer, study)})}}});
  figure.specification["layer"][0]["encoding"]["x"]["title"] = criterion_title(study);
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
                   {"range", "", ""},
                   {"place", "", ""},
                   {"low_place", "", ""},
                   {"high_place", "", ""}}};
  for (std::size_t i = 0; i < answer.room.size(); ++i) {
    data.rows.push_back({answer.free[i].name, datum(answer.gains[i]), datum(low[i]), datum(high[i]),
                         text::range_text(low[i], high[i], answer.free[i].unit), datum(tuned[i]),
                         datum(low_place[i]), datum(high_place[i])});
  }
  Figure figure = report::figure_of("tuning-room", "tuning-room", "How far may each parameter move?",
                                    "The interval around the tuned value in which the goal seems met, the "
                                    "others as tuned, by simulation on "
                                    "machines of the search, with its ends.",
                                    {std::move(data)});
  report::set_rows(figure, answer.room.size(), 36);
  return figure;
}

bool is_drawn(const Tuning& tuning) {
  return tuning.drawn && tuning.answer.proof;
}

}  // namespace

std::string criterion_title(const study::Study& study) {
  const std::string name = tuning::criterion_name(study);
  if (tuning::is_proportion_of_allowed(study)) return name + ", of the time that its goal allows";
  const std::string& unit = tuning::criteria_of(study).front().measure->field.column.unit;
  return unit == "1" || unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

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

std::vector<Figure> lost_ages_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || !tuning.answer.lost_ages) return {};
  return {lost_ages_figure(*tuning.answer.lost_ages, tuning.study)};
}

std::vector<Figure> retuning_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || !tuning.answer.retuning || tuning.answer.retuning->intervals.empty()) return {};
  return {retuning_figure(*tuning.answer.retuning, tuning.study)};
}

std::vector<Figure> room_figures(const Tuning& tuning) {
  if (!is_drawn(tuning) || tuning.answer.room.empty()) return {};
  return {room_figure(tuning.answer)};
}

}  // namespace zerocount::design_commands
