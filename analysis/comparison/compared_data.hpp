#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/matching.hpp"
#include "analysis/comparison/point_trials.hpp"
#include "experiments/manifest_text/manifest_values.hpp"
#include "results/reading/all_trials_file.hpp"

/// What of two files is compared: which points, how many trials of each, and by which goal.
namespace zerocount::comparison {

/// The design points to compare, and where their trials are.
struct ComparedData {
  const reading::AllTrialsFile& baseline;
  const reading::AllTrialsFile& current;
  std::vector<MatchedPoint> points;
  std::int64_t baseline_rigs{0};
  std::int64_t current_rigs{0};
  bool in_worlds{false};             ///< a study has worlds
  bool other_worlds{false};          ///< and not the same ones: these take the place of rigs
  std::int64_t conditions{1};        ///< under each of which a design point is compared
  std::int64_t baseline_trials{0};   ///< of each point (under each condition) that are compared, its first
  std::int64_t current_trials{0};    ///< of the current file
  AlsoRead of_baseline{};            ///< what is read of it beside the gate measures
  AlsoRead of_current{};             ///< likewise, and what the requirements need
  std::vector<study::Goal> goals{};  ///< by which the points are judged
  bool goals_of_baseline{false};     ///< they are those of the baseline's manifest
};

/// The points with what the rules and both manifests say of their trials.
/// @throws Failure (bad_input, bad_data) where the rules need a goal, or an error band, that a file lacks
ComparedData compared_data(const reading::AllTrialsFile& baseline,
                           const manifest_text::ManifestValues& old_values,
                           const reading::AllTrialsFile& current,
                           const manifest_text::ManifestValues& new_values, std::vector<MatchedPoint> points,
                           const GateRules& rules);

/// The rules, with those of a design point under each of its conditions, and with the requirement `goal` for
/// each goal of the current file.
/// @throws Failure (bad_input) where they name a measure of a goal that is not judged
GateRules rules_for(const ComparedData& data, const GateRules& rules);

/// The most trials of each point that are compared.
std::int64_t trial_limit(const GateRules& rules, const reading::AllTrialsFile& file);

struct TrialsOfBoth {
  PointTrials baseline;
  PointTrials current;
};

/// The compared trials of a point, from both files.
/// @throws Failure (bad_data) where a file is damaged
TrialsOfBoth read_trials(const ComparedData& data, const MatchedPoint& point);

}  // namespace zerocount::comparison
