#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/report/figures/figure.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"

namespace zerocount::design_commands {
namespace {

using document::Figure;
using document::FigureData;
using nlohmann::ordered_json;
using report::datum;
using tuning::TuneAnswer;
using tuning::TunedAxis;
using tuning::Values;

constexpr int cells_of_side = 15;
constexpr std::int64_t machines_of_cell = 128;

/// A cell of a map of two free parameters. It is examined at the values x and y: the centre of the cell or,
/// if the cell contains the tuned values, these.
struct MapCell {
  double x{0.0};
  double y{0.0};
  double x_from{0.0}, x_to{0.0};
  double y_from{0.0}, y_to{0.0};
  double rate{0.0};  ///< Success rate of the worst goal on the first machines of the search, 0 to 1.
  /// Whether all goals seem to be met in all settings (conditions at ages), by the rates alone.
  bool seems_met{false};
  /// Value of the criterion, the quantity that the tuning minimises; infinity for "never".
  double criterion{0.0};
  bool keeps_margins{false};
};

/// Map of the success rate over two free parameters. The other parameters have their tuned values.
struct TuningMap {
  std::size_t x{0};              ///< Index of the free parameter on the x axis.
  std::size_t y{1};              ///< Index of the free parameter on the y axis.
  std::vector<MapCell> cells{};  ///< Cells of a square grid; x varies fastest, then y.
};

/// Maps of the success rate over all pairs of free parameters.
using Maps = std::vector<TuningMap>;

tuning::ExtraCost cost_of_maps(const TunedAxis& axis) {
  const trials::Replicates& machines = axis.search.machines();
  const auto free = std::ssize(axis.free());
  const std::int64_t trials = free * (free - 1) / 2 * cells_of_side * cells_of_side *
                              std::min(machines_of_cell, machines.count) * machines.trials_each;
  return {.maps = trials, .trials = trials};
}

/// Simulates the values of a cell of a map, and stores success rate and criterion in the cell. Its stability
/// margins are examined on the machines that the search examines.
void simulate_cell(const TunedAxis& axis, const Values& values, MapCell& cell) {
  const std::optional<study::Study> study = tuning::at_values(axis.tuned, axis.free(), values);
  if (!study) return;
  const auto machines =
      tuning::results_of(*study, axis.search.machines(), machines_of_cell, nullptr, axis.effort);
  cell.keeps_margins = axis.search.may_keep(values, tuning::has_slid(machines));
  const tuning::Aim aim = tuning::aim_of(*study);
  const tuning::RateEstimate estimate = estimate_of(aim, machines, machines_of_cell);
  cell.rate = estimate.rate;
  cell.seems_met = reaches(aim, estimate);
  cell.criterion = estimate.criterion;
}

TuningMap map_of(const TunedAxis& axis, std::size_t x, std::size_t y) {
  TuningMap map{x, y};
  const tuning::UnitCubePoint place = tuning::place_of(axis.free(), axis.values);
  // The tuned values with two of them at other places of their ranges, in cells.
  const auto values_in = [&](double column, double row) {
    tuning::UnitCubePoint at = place;
    at[x] = column / cells_of_side;
    at[y] = row / cells_of_side;
    const Values moved = tuning::values_at(axis.free(), at);
    Values values = axis.values;
    values[x] = moved[x];
    values[y] = moved[y];
    return values;
  };
  const auto cell_at = [](double of_range) {
    return std::clamp(static_cast<int>(of_range * cells_of_side), 0, cells_of_side - 1);
  };
  for (int row = 0; row < cells_of_side; ++row) {
    for (int column = 0; column < cells_of_side; ++column) {
      const bool is_tuned = column == cell_at(place[x]) && row == cell_at(place[y]);
      const Values examined = is_tuned ? axis.values : values_in(column + 0.5, row + 0.5);
      const Values from = values_in(column, row);
      const Values to = values_in(column + 1.0, row + 1.0);
      MapCell& cell =
          map.cells.emplace_back(MapCell{examined[x], examined[y], from[x], to[x], from[y], to[y]});
      simulate_cell(axis, examined, cell);
    }
  }
  return map;
}

std::any find_maps(TunedAxis& axis) {
  Maps maps;
  for (std::size_t y = 1; y < axis.free().size(); ++y) {
    for (std::size_t x = 0; x < y; ++x) maps.push_back(map_of(axis, x, y));
  }
  return maps;
}

FigureData cells_data(const TuningMap& map, const study::FreeParameter& x, const study::FreeParameter& y) {
  using Cell = const MapCell&;
  return report::data_of<MapCell>(
      "cells", map.cells,
      {{{"x", x.name, x.unit}, [](Cell one) { return datum(one.x); }},
       {{"y", y.name, y.unit}, [](Cell one) { return datum(one.y); }},
       {{"x_from", "", ""}, [](Cell one) { return datum(one.x_from); }},
       {{"x_to", "", ""}, [](Cell one) { return datum(one.x_to); }},
       {{"y_from", "", ""}, [](Cell one) { return datum(one.y_from); }},
       {{"y_to", "", ""}, [](Cell one) { return datum(one.y_to); }},
       {{"rate", "rate of the goal", "1"}, [](Cell one) { return datum(one.rate); }},
       {{"criterion", "criterion", ""}, [](Cell one) { return datum(one.criterion); }},
       {{"margins", "margins", ""},
        [](Cell one) { return ordered_json(one.keeps_margins ? "kept" : "lost"); }}});
}

FigureData boundaries_of(const TuningMap& map) {
  std::vector<report::CellEdges> cells;
  for (const MapCell& one : map.cells) cells.push_back({one.x_from, one.x_to, one.y_from, one.y_to});
  FigureData data = report::boundaries_data();
  report::add_boundary(data, "goal seems met", cells, cells_of_side,
                       [&](std::size_t i) { return map.cells[i].seems_met; });
  report::add_boundary(data, "margins kept", cells, cells_of_side,
                       [&](std::size_t i) { return map.cells[i].keeps_margins; });
  return data;
}

Figure map_figure(const TuneAnswer& answer, const TuningMap& map) {
  const study::FreeParameter& x = answer.free[map.x];
  const study::FreeParameter& y = answer.free[map.y];
  Figure figure = report::figure_of(
      "tuning-map", fmt::format("tuning-map-{}-{}", map.x + 1, map.y + 1),
      fmt::format("Which {} and {} meet the goal?", x.name, y.name),
      fmt::format(
          "The other free parameters are as tuned. The lines enclose the cells in which the goal seems met, "
          "each by {} machines of the search, and those whose loops keep the margins; pale cells do not keep "
          "them. The star is the tuned point, at which its cell is examined; the others are examined at "
          "their "
          "centres.",
          machines_of_cell),
      {cells_data(map, x, y),
       boundaries_of(map),
       {"tuned",
        {{"x", "", ""}, {"y", "", ""}},
        {ordered_json::array({datum(answer.tuned.values[map.x]), datum(answer.tuned.values[map.y])})}}});
  for (const auto& [axis, parameter] : {std::pair{"x", &x}, std::pair{"y", &y}}) {
    figure.parameters[fmt::format("{}_domain", axis)] = {parameter->low, parameter->high};
    figure.parameters[fmt::format("{}_scale", axis)] = parameter->logarithmic ? "log" : "linear";
  }
  return figure;
}

void describe_maps(Items& items) {
  items.figures([](const Tuning& tuning) {
    std::vector<Figure> figures;
    if (!is_drawn(tuning)) return figures;
    for (const TuningMap& map : found_by_extra<Maps>(tuning))
      figures.push_back(map_figure(tuning.answer, map));
    return figures;
  });
}

}  // namespace

tuning::Extra maps_extra() {
  return {.name = "maps",
          .question = "Where else is the goal met?",
          .refusal = [](const study::Study&, bool with_page) -> std::string {
            return with_page ? ""
                             : "maps are drawn on a page; expected --report PAGE or --watch PAGE with them";
          },
          .cost = cost_of_maps,
          .run = find_maps,
          .describe = describe_maps};
}

}  // namespace zerocount::design_commands
