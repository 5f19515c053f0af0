#include "analysis/measures/level_statistics.hpp"

#include <algorithm>
#include <vector>

#include "analysis/statistics/mean_bounds.hpp"

namespace zerocount {
namespace {

using Level = const LevelStatistics&;

const std::vector<LevelField>& fields_of_levels() {
  static const std::vector<LevelField> list{
      {"", "n", "1", "trials whose motion was not lost, of which the values of the level are", true,
       [](Level s) { return to_double(s.torque.n); }},
      {"", "nonfinite", "1", "trials whose motion was lost in the level or before", true,
       [](Level s) { return to_double(s.nonfinite); }},
      {"", "torque", "N m", "mean torque at the end of the level", false,
       [](Level s) { return s.torque.mean; }},
      {"position", "mean", "rad", "mean rotor angle at the end of the level", false,
       [](Level s) { return s.position.mean; }},
      {"position", "low", "rad", "lower 95 % bound of the mean rotor angle (Student's t)", false,
       [](Level s) { return student_t(s.position, s.confidence).low; }},
      {"position", "high", "rad", "upper 95 % bound of the mean rotor angle (Student's t)", false,
       [](Level s) { return student_t(s.position, s.confidence).high; }},
      {"position", "sd", "rad", "standard deviation of the rotor angle", false,
       [](Level s) { return s.position.sd(); }},
      {"position", "min", "rad", "smallest rotor angle", false, [](Level s) { return s.position.min; }},
      {"position", "max", "rad", "largest rotor angle", false, [](Level s) { return s.position.max; }},
      {"creep", "mean", "rad", "mean plastic extension at the end of the level", false,
       [](Level s) { return s.creep.mean; }},
      {"creep", "low", "rad", "lower 95 % bound of the mean plastic extension (Student's t)", false,
       [](Level s) { return student_t(s.creep, s.confidence).low; }},
      {"creep", "high", "rad", "upper 95 % bound of the mean plastic extension (Student's t)", false,
       [](Level s) { return student_t(s.creep, s.confidence).high; }},
      {"creep", "sd", "rad", "standard deviation of the plastic extension", false,
       [](Level s) { return s.creep.sd(); }},
      {"creep", "min", "rad", "smallest plastic extension", false, [](Level s) { return s.creep.min; }},
      {"creep", "max", "rad", "largest plastic extension", false, [](Level s) { return s.creep.max; }},
      {"", "broke_away", "1", "trials in which the hook slid during the level", true,
       [](Level s) { return to_double(s.broke_away); }},
      {"", "reversal_depth_max", "1", "largest number of reversal points on the stack during the level", true,
       [](Level s) { return to_double(s.reversal_depth); }},
  };
  return list;
}

}  // namespace

void LevelStatistics::add(const MoveOutcome& move) {
  if (move.outcome == Outcome::nonfinite) {
    ++nonfinite;
    return;
  }
  torque.add(move.holding_torque);
  position.add(move.final_position);
  creep.add(move.creep);
  broke_away += move.broke_away;
  reversal_depth = std::max(reversal_depth, move.reversal_depth);
}

std::span<const LevelField> level_fields() {
  return fields_of_levels();
}

}  // namespace zerocount
