#include "runners/tuning/tuning_map.hpp"

#include <algorithm>
#include <optional>

namespace zerocount::tuning {
namespace {

constexpr int cells_of_side = 15;
constexpr std::int64_t units_of_cell = 128;

/// The values of the tuned study with two of them at other places of their ranges.
Values values_of_cell(const TunedStudy& tuned, const TuningMap& map, double x, double y) {
  UnitCubePoint place = place_of(tuned.free, tuned.gains);
  place[map.x] = x;
  place[map.y] = y;
  const Values moved = values_at(tuned.free, place);
  Values values = tuned.gains;
  values[map.x] = moved[map.x];
  values[map.y] = moved[map.y];
  return values;
}

void simulate(const TunedStudy& tuned, const StudySearch& search, const Values& values, MapCell& cell) {
  const std::optional<study::Study> study = at_values(tuned.study, tuned.free, values);
  cell.keeps_margins = false;
  if (!study) return;
  const Candidate candidate{
      {}, values, results_of(*study, tuned.units, units_of_cell, nullptr, tuned.effort)};
  cell.keeps_margins = search.may_keep(values, has_slid(candidate.units));
  const Aim aim = aim_of(*study);
  const Estimate estimate = estimate_of(aim, candidate, units_of_cell);
  cell.rate = estimate.rate;
  cell.seems_met = reaches(aim, estimate);
  cell.criterion = estimate.criterion;
}

/// Number of the cell of a side in which a place of the range lies.
int cell_at(double place) {
  return std::clamp(static_cast<int>(place * cells_of_side), 0, cells_of_side - 1);
}

}  // namespace

std::int64_t trials_of_maps(const trials::Replicates& units, std::size_t free) {
  const auto pairs = static_cast<std::int64_t>(free * (free - 1) / 2);
  return pairs * cells_of_side * cells_of_side * std::min(units_of_cell, units.count) * units.trials_each;
}

std::vector<TuningMap> maps_of(const TunedStudy& tuned, const StudySearch& search) {
  std::vector<TuningMap> maps;
  for (std::size_t y = 1; y < tuned.free.size(); ++y) {
    for (std::size_t x = 0; x < y; ++x) maps.push_back({x, y, {}});
  }
  const UnitCubePoint place = place_of(tuned.free, tuned.gains);
  for (TuningMap& map : maps) {
    for (int i = 0; i < cells_of_side * cells_of_side; ++i) {
      const int column = i % cells_of_side;
      const int row = i / cells_of_side;
      const auto at = [&](double x, double y) {
        return values_of_cell(tuned, map, x / cells_of_side, y / cells_of_side);
      };
      const bool is_tuned = column == cell_at(place[map.x]) && row == cell_at(place[map.y]);
      const Values examined = is_tuned ? tuned.gains : at(column + 0.5, row + 0.5);
      const Values from = at(column, row);
      const Values to = at(column + 1.0, row + 1.0);
      MapCell cell{examined[map.x], examined[map.y], from[map.x], to[map.x], from[map.y], to[map.y]};
      simulate(tuned, search, examined, cell);
      map.cells.push_back(cell);
    }
  }
  return maps;
}

}  // namespace zerocount::tuning
