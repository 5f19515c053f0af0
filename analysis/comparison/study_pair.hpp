#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_trials.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/reading/all_trials_file.hpp"

/// Matching of two files: the points that both have, the number of trials that are compared, and the goals.
namespace zerocount::comparison {

/// A design point that both files have, in one setting if the files have settings.
struct MatchedPoint {
  std::string label{};         ///< Label of the point, with the setting if there is one.
  std::int64_t baseline{0};    ///< Index of the point in the baseline.
  std::int64_t current{0};     ///< Index of the point in the current file.
  std::string design_point{};  ///< Label of the point without the setting.
  std::string setting{};       ///< Name of the setting; empty without settings.
  std::size_t setting_at{0};   ///< Index of the setting in the order of the baseline.
};

/// One of the two files.
struct ComparedStudy {
  const reading::AllTrialsFile& file;
  manifest_text::ManifestValues values{};
  std::vector<std::int64_t> under{};  ///< Indices of the settings, in the order of the baseline.
  /// Number of machines, or of the worlds that take their place; 0: each trial is independent.
  std::int64_t machines{0};
  /// Number of trials that are compared at each point (in each setting). The first trials are taken.
  std::int64_t trials{0};
  AlsoRead also{};  ///< Data that goals and requirements need, read in addition to the gate measures.

  /// The trials of the point in its setting.
  reading::AllTrialsFile trials_of(const MatchedPoint& point) const {
    return under.empty() ? file : file.in_setting(under[point.setting_at]);
  }
};

/// The two files, or two design points of one file, after matching.
struct StudyPair {
  ComparedStudy baseline;
  ComparedStudy current;
  std::vector<MatchedPoint> points{};
  std::int64_t settings{1};          ///< Number of settings in which each design point is compared.
  bool in_worlds{false};             ///< At least one study has worlds.
  bool other_worlds{false};          ///< The studies have different worlds, which take the place of machines.
  std::vector<study::Goal> goals{};  ///< Goals by which the points are judged.
  bool goals_of_baseline{false};     ///< The baseline's manifest has goals; `goals` are then those.
};

/// Matches the design points of both files by label, in the order of the baseline, and settings by name. In
/// studies with cases the axes may differ, because a case may have a new gain; otherwise they must be bitwise
/// equal.
/// @throws Failure: bad_data with a list of the points and settings without a partner, or if one file has
/// targets and the other torque levels; bad_input if the rules need a goal, or an error band, that a file
/// lacks
StudyPair pair_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                       const GateRules& rules);

/// Matches two design points of one file.
/// @throws Failure in the cases of pair_studies() and require_independent_trials()
StudyPair pair_points(const reading::AllTrialsFile& file, std::int64_t baseline, std::int64_t current,
                      const GateRules& rules);

/// Rejects saltelli designs. Every test assumes independent trials, but the trials of a saltelli design share
/// most of their random numbers.
/// @throws Failure (bad_data) for a saltelli design
void require_independent_trials(const ComparedStudy& study);

/// The rules, with the rules for a design point copied to each of its settings, and with the requirement
/// `goal` replaced by one for each goal of the current file.
/// @throws Failure (bad_input) if the rules name a measure of a goal that is not judged
GateRules rules_for(const StudyPair& pair, const GateRules& rules);

/// Maximum number of trials of each point that are compared.
std::int64_t trial_limit(const GateRules& rules, const reading::AllTrialsFile& file);

/// The result of compare_draws().
struct DrawComparison {
  bool same{false};      ///< Whether trial i of both files drew the same random numbers.
  std::string reason{};  ///< reason for the result, one line
  /// Drawn parameters whose values differ although the draws are the same, because the manifests differ.
  std::vector<std::string> changed_inputs{};
};

/// Decides whether trial i of both files drew the same random numbers. This holds if the seeds and designs
/// are equal and every random parameter of both files either has bitwise equal values in the compared trials
/// or, after a change of its distribution, sorts the trials in the same order.
DrawComparison compare_draws(const StudyPair& pair);

/// The value of a swept key at a design point, as text; "missing" if it is not swept.
std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point);

}  // namespace zerocount::comparison
