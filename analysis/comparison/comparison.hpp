#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/judgement.hpp"
#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"

/// The result of comparing a results file with a baseline. README.md of this folder describes the method.
namespace zerocount::comparison {

/// Method of comparison, which depends on how much the two files have in common.
enum class ComparisonLayer {
  bits,        ///< one study by one build: every dataset must be equal to the bit
  paired,      ///< trial i drew the same random numbers in both: trials are compared one by one
  two_samples  ///< different draws: distributions are compared
};

/// "bits", "paired" or "two_samples".
std::string_view to_string(ComparisonLayer layer);

/// The verdicts of both files on a goal at a design point, as if the point had been chosen beforehand.
struct GoalStatuses {
  std::string name{};  ///< Name of the goal in `goals`; empty if the goal has no name.
  goal::Status baseline{goal::Status::undecided};
  goal::Status current{goal::Status::undecided};
};

/// The comparison of one design point in the two files, in one setting if there are settings.
struct PointComparison {
  std::string label;         ///< Label of the point, with the setting if there is one.
  std::string design_point;  ///< Label of the point without the setting.
  std::string setting;       ///< Setting of the trials; empty without settings.
  std::int64_t baseline_point{0};
  std::int64_t current_point{0};
  std::int64_t baseline_trials{0};
  std::int64_t current_trials{0};
  measures::UndecidedMoves baseline_undecided{};  ///< Undecided moves of the baseline.
  measures::UndecidedMoves current_undecided{};   ///< Undecided moves of the current file.
  std::int64_t pairs{0};  ///< Number of trials that were compared one by one; 0 if trials are not paired.
  GateVerdict verdict{GateVerdict::not_measured};
  std::vector<Judgement> judgements{};  ///< the measures, then the requirements
  std::vector<GoalStatuses> goals{};    ///< The goals that judge the points; empty without a goal.
};

/// The judgements of all points, in order.
std::vector<Judgement*> judgements_of(std::span<PointComparison> points);

struct ComparedFile {
  std::string path;
  layout::FileHeader header{};
};

/// Everything that a comparison found.
struct StudyComparison {
  ComparedFile baseline;
  ComparedFile current;
  std::string baseline_label;  ///< Label of the baseline's point if two points of one file are compared.
  ComparisonLayer layer{ComparisonLayer::two_samples};
  std::string layer_reason;  ///< Reason for the choice of the layer, one line.
  bool equal_to_the_bit{false};
  std::string first_difference;  ///< First dataset that differs, with the place; empty if not searched for.
  std::vector<manifest_text::ManifestDifference> manifest_differences;
  std::vector<std::string> changed_inputs;  ///< drawn parameters whose values differ on the same draws
  double confidence{statistics::summary_confidence};  ///< Confidence of each bound.
  double false_discovery_rate{0.05};
  std::int64_t tests{0};  ///< Number of tests over which the false discoveries are controlled.
  std::vector<PointComparison> points;
  std::vector<study::Goal> goals;                  ///< Goals by which the points are judged.
  GateVerdict verdict{GateVerdict::inconclusive};  ///< never not_measured
  /// Trials per design point that decide the whole comparison with decision_probability.
  std::optional<double> trials_to_decide;
  /// Largest number of trials per design point that was tried.
  double max_trials_to_decide{statistics::unknown};
  std::vector<std::string> notes;  ///< Further remarks for the reader, a line each.
};

/// Whether the comparison is of two design points of one file.
inline bool compares_points(const StudyComparison& comparison) {
  return !comparison.baseline_label.empty();
}

/// Whether the data must be equal to the bit, but are not.
inline bool is_unequal(const StudyComparison& comparison) {
  return comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
}

/// Compares a results file with a baseline: finds what the two have in common, matches their design points,
/// tests every measure at every point, controls the false discoveries over all of them, and gives verdicts.
/// @throws Failure (bad_data) if points cannot be matched, one file has targets and the other torque levels,
/// or a file is damaged.
StudyComparison compare_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                                const GateRules& rules = {});

/// Compares two design points of one file: is the point `current` as good as the point `baseline`?
/// @throws Failure (bad_data) in the cases of compare_studies()
StudyComparison compare_points(const reading::AllTrialsFile& file, std::int64_t baseline,
                               std::int64_t current, const GateRules& rules = {});

/// Options of the comparison of two files.
struct CompareOptions {
  std::optional<std::filesystem::path> margins{};  ///< file of margins and requirements
  bool changed_fails{false};                       ///< For every measure, a change for the better fails too.
  std::optional<std::int64_t> max_trials{};        ///< see GateRules::max_trials
};

/// The rules that follow from these options. @param labels labels of the design points
/// @throws Failure in the cases of read_gate_rules()
GateRules rules_of(const CompareOptions& options, std::span<const std::string> labels);

/// Compares two files.
/// @throws Failure in the cases of compare_studies(), read_gate_rules() and AllTrialsFile
StudyComparison compare_files(const std::filesystem::path& baseline, const std::filesystem::path& current,
                              const CompareOptions& options = {});

/// The result of update_baseline().
struct BaselineUpdate {
  bool changed{true};      ///< False if the baseline was already equal to the file.
  std::string comparison;  ///< Verdict of the comparison with the replaced baseline; empty without one.
  std::vector<std::string> warnings;
};

/// Path of the log with the reasons for a baseline: "NAME.h5.log.yaml", a YAML list, oldest entry first.
std::filesystem::path baseline_log(const std::filesystem::path& baseline);

/// Copies a complete results file, byte by byte, to the baseline `output`. The reason is recorded first, so a
/// baseline without its record is never left behind.
/// @throws Failure if `file` is not a complete results file, or a file cannot be written
BaselineUpdate update_baseline(const std::filesystem::path& file, const std::filesystem::path& output,
                               const std::string& reason);

/// The verdict of the comparison in one sentence.
std::string verdict_sentence(const StudyComparison& comparison);

/// Text of a value of a measure or requirement with its unit; proportions in per cent.
std::string value_text(double value, std::string_view quantity, std::string_view unit);

/// Text of a number of trials, rounded up to two digits.
std::string trials_text(double trials);

/// The answer of `compare`. If its table is long, people see only the noteworthy rows and the number of the
/// other rows.
document::AnswerDescription<StudyComparison> comparison_answer();

/// The comparison as JUnit XML: a test suite with one case per point and measure or requirement. A judgement
/// that fails the gate is a failure, an inconclusive one an error; a measure without values is skipped.
std::string comparison_junit(const StudyComparison& comparison);

}  // namespace zerocount::comparison
