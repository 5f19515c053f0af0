#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/comparison/point_trials.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/reading/all_trials_file.hpp"

/// Matching of two files: the points that both have, the number of trials that are compared, and the goals.
namespace zerocount::comparison {

/// A design point that both files have, in one setting if the files have settings.
struct MatchedPoint {
  std::string label{};         ///< Label of the design point, with the setting if there is one.
  std::int64_t baseline{0};    ///< Index of the design point in the baseline.
  std::int64_t current{0};     ///< Index of the design point in the current file.
  std::string design_point{};  ///< Label of the design point without the setting.
  /// Label of the setting (a condition at an age); empty if the studies have no settings.
  std::string setting{};
  std::size_t setting_at{0};  ///< Index of the setting in the baseline's list of settings.
};

/// One of the two results files that are compared, with what was found out about it.
struct ComparedStudy {
  const reading::AllTrialsFile& file;
  manifest_text::ManifestValues values{};
  /// Indices of this file's settings, in the order of the baseline's settings; empty without settings.
  std::vector<std::int64_t> under{};
  /// Number of clusters of dependent trials: machines, or the worlds that take their place; 0: each trial is
  /// independent.
  std::int64_t machines{0};
  /// Number of trials that are compared at each design point (in each setting), from the first trial on.
  std::int64_t trials{0};
  AlsoRead also{};  ///< Data that goals and requirements need, read in addition to the gate measures.

  /// The file restricted to the setting of this point.
  reading::AllTrialsFile trials_of(const MatchedPoint& point) const {
    return under.empty() ? file : file.in_setting(under[point.setting_at]);
  }
};

/// The two results files, or one file with two of its design points, after matching.
struct StudyPair {
  ComparedStudy baseline;
  ComparedStudy current;
  std::vector<MatchedPoint> points{};
  std::int64_t settings{1};  ///< Number of settings in which each design point is compared.
  /// True: at least one of the studies has worlds (draws of what all machines share).
  bool in_worlds{false};
  /// True: the studies drew different worlds. Worlds then take the place of machines as independent units.
  bool other_worlds{false};
  std::vector<study::Goal> goals{};  ///< Goals by which the points are judged.
  /// True: the baseline's manifest has goals, and `goals` are these. False: they are those of the current
  /// file.
  bool goals_of_baseline{false};
};

/// Matches the design points of both files by label, in the order of the baseline, and settings by name. In
/// studies with cases the axes may differ, because a case may have a new gain; otherwise they must be bitwise
/// equal.
/// @throws Failure: bad_data with a list of the points and settings without a partner, or if one file has
/// targets and the other torque levels; bad_input if the rules need a goal, or an error band, that a file
/// lacks
StudyPair pair_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                       const GateRules& rules);

/// Treats two design points of one file as a pair to be compared.
/// @param baseline, current indices of the points
/// @throws Failure in the cases of pair_studies() and require_independent_trials()
StudyPair pair_points(const reading::AllTrialsFile& file, std::int64_t baseline, std::int64_t current,
                      const GateRules& rules);

/// Rejects a study with a saltelli design (sampling for Sobol' indices). Every test assumes independent
/// trials, but the trials of such a design share most of their random numbers.
/// @throws Failure (bad_data) for a saltelli design
void require_independent_trials(const ComparedStudy& study);

/// The user's rules adapted to the matched files: the rules for a design point are copied to each of its
/// settings, and the requirement `goal` becomes one for each goal of the current file.
/// @throws Failure (bad_input) if the rules name a measure of a goal that is not judged
GateRules rules_for(const StudyPair& pair, const GateRules& rules);

/// Largest number of trials of each design point that are compared by these rules.
std::int64_t trial_limit(const GateRules& rules, const reading::AllTrialsFile& file);

/// Whether two files drew the same random numbers, as compare_draws() finds.
struct DrawComparison {
  bool same{false};      ///< Whether trial i of both files drew the same random numbers.
  std::string reason{};  ///< Reason for the result, one line.
  /// Drawn parameters whose values differ although the draws are the same, because the manifests differ.
  std::vector<std::string> changed_inputs{};
};

/// Decides whether trial i of both files drew the same random numbers. This holds if the seeds and designs
/// are equal and every random parameter of both files either has bitwise equal values in the compared trials
/// or, after a change of its distribution, sorts the trials in the same order.
DrawComparison compare_draws(const StudyPair& pair);

/// The value of a swept manifest key at a design point, as text; "missing" if the key is not swept.
std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point);

}  // namespace zerocount::comparison
