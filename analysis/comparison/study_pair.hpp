#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_trials.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/reading/all_trials_file.hpp"

/// Matches two files: the points that both have, how many trials of each are compared, and the goal.
namespace zerocount::comparison {

/// A design point that both files have, under one condition where they have any.
struct MatchedPoint {
  std::string label{};  ///< with the condition
  std::int64_t baseline{0};
  std::int64_t current{0};
  std::string design_point{};   ///< its label without the condition
  std::string condition{};      ///< empty without conditions
  std::size_t condition_at{0};  ///< its number in the order of the baseline
};

/// One of the files.
struct ComparedStudy {
  const reading::AllTrialsFile& file;
  manifest_text::ManifestValues values{};
  std::vector<std::int64_t> under{};  ///< Indices of the conditions, in the order of the baseline.
  std::int64_t machines{0};           ///< or worlds that take their place; 0: each trial is independent
  std::int64_t trials{0};             ///< of each point (under each condition) that are compared, its first
  AlsoRead also{};  ///< what is read beside the gate measures: what goals and requirements need

  /// The trials of the point under its condition.
  reading::AllTrialsFile trials_of(const MatchedPoint& point) const {
    return under.empty() ? file : file.under_condition(under[point.condition_at]);
  }
};

/// Both files, or two design points of one.
struct StudyPair {
  ComparedStudy baseline;
  ComparedStudy current;
  std::vector<MatchedPoint> points{};
  std::int64_t conditions{1};        ///< under each of which a design point is compared
  bool in_worlds{false};             ///< a study has worlds
  bool other_worlds{false};          ///< and not the same ones: these take the place of machines
  std::vector<study::Goal> goals{};  ///< by which the points are judged
  bool goals_of_baseline{false};     ///< they are those of the baseline's manifest
};

/// Matches the design points of both files by label, in the order of the baseline, and conditions by name. In
/// studies with cases the axes may differ, because a case may have got another gain; otherwise they must be
/// bitwise equal.
/// @throws Failure: bad_data that lists the points and conditions without a partner, or where one file has
/// targets and the other torque levels; bad_input where the rules need a goal, or an error band, that a file
/// lacks
StudyPair pair_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                       const GateRules& rules);

/// Two design points of one file.
/// @throws Failure as pair_studies, and require_independent_trials
StudyPair pair_points(const reading::AllTrialsFile& file, std::int64_t baseline, std::int64_t current,
                      const GateRules& rules);

/// Every test takes trials for independent, and those of a saltelli design share most of their numbers.
/// @throws Failure (bad_data) for such a design
void require_independent_trials(const ComparedStudy& study);

/// The rules, with those of a design point under each of its conditions, and with the requirement `goal` for
/// each goal of the current file.
/// @throws Failure (bad_input) where they name a measure of a goal that is not judged
GateRules rules_for(const StudyPair& pair, const GateRules& rules);

/// The most trials of each point that are compared.
std::int64_t trial_limit(const GateRules& rules, const reading::AllTrialsFile& file);

/// Whether trial i of both files drew the same random numbers.
struct DrawComparison {
  bool same{false};
  std::string reason{};                       ///< one line
  std::vector<std::string> changed_inputs{};  ///< whose values differ all the same, because the manifests do
};

/// The draws are the same if the seeds and designs are equal and every random parameter of both files either
/// has bitwise equal values in the compared trials or, after a change of its distribution, sorts them in the
/// same order.
DrawComparison compare_draws(const StudyPair& pair);

/// The value of a swept key at a design point, as text; "missing" if it is not swept.
std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point);

}  // namespace zerocount::comparison
