#pragma once

#include <cstddef>
#include <vector>

#include "runners/tuning/answer_details.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::tuning {

/// A cell of a map, examined at the values x and y: its centre, or the tuned values that it contains.
struct MapCell {
  double x{0.0};
  double y{0.0};
  double x_from{0.0}, x_to{0.0};
  double y_from{0.0}, y_to{0.0};
  double rate{0.0};       ///< of the goal, by the first units of the search; of the worst of several
  bool seems_met{false};  ///< all goals under all conditions
  double criterion{0.0};  ///< infinite for never
  bool keeps_margins{true};
};

/// The rate of the goal over two free parameters, the others as tuned.
struct TuningMap {
  std::size_t x{0};  ///< number of the free parameter
  std::size_t y{1};
  std::vector<MapCell> cells;  ///< of a square grid, x fastest
};

/// Trials of the maps of so many free parameters.
std::int64_t trials_of_maps(const trials::Replicates& units, std::size_t free);

/// Maps over all pairs of free parameters. The margins are those of the machines that the search examines.
/// @throws trial::Interrupted, trials::Spent
std::vector<TuningMap> maps_of(const TunedStudy& tuned, const StudySearch& search);

}  // namespace zerocount::tuning
