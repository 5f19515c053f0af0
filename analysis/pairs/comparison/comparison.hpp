#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/comparison/judgement.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"

/// The result of comparing a results file with a baseline. README.md of this folder describes the method.
namespace zerocount::comparison {

/// Method by which two results files are compared. It depends on how much they have in common.
enum class ComparisonLayer {
  /// Both files are of the same study and the same build of the program: every dataset must be equal to the
  /// bit.
  bits,
  paired,      ///< Trial i drew the same random numbers in both files: trials are compared one by one.
  two_samples  ///< The trials of the files drew different random numbers: distributions are compared.
};

/// The name of a method of comparison: "bits", "paired" or "two_samples".
std::string_view to_string(ComparisonLayer layer);

/// The statuses of a goal (met, missed or undecided) in the baseline and in the current file, at one design
/// point. The point is treated as if it had been chosen beforehand.
struct GoalStatuses {
  std::string name{};  ///< Name of the goal in the manifest's `goals`; empty if the goal has no name.
  goal::Status baseline{goal::Status::undecided};
  goal::Status current{goal::Status::undecided};
};

/// The comparison of one design point in the two files, in one setting (a condition at an age) if the study
/// has settings.
struct PointComparison {
  std::string label;         ///< Label of the design point, with the setting if there is one.
  std::string design_point;  ///< Label of the design point without the setting.
  /// Label of the setting (a condition at an age) of the compared trials; empty if the study has no settings.
  std::string setting;
  std::int64_t baseline_point{0};
  std::int64_t current_point{0};
  std::int64_t baseline_trials{0};
  std::int64_t current_trials{0};
  /// Counts of the baseline's moves that ended off target, so that the move is neither stable nor shown
  /// unstable.
  measures::UndecidedMoves baseline_undecided{};
  /// Counts of the current file's moves that ended off target, so that the move is neither stable nor shown
  /// unstable.
  measures::UndecidedMoves current_undecided{};
  /// Number of pairs of trials that were compared one by one; 0 if the trials of the files are not paired.
  std::int64_t pairs{0};
  GateVerdict verdict{GateVerdict::not_measured};
  std::vector<Judgement> judgements{};  ///< The judgements on the measures, then those on the requirements.
  /// Statuses of the goals by which the points are judged; empty if there is no goal.
  std::vector<GoalStatuses> goals{};
};

/// Pointers to the judgements of all points, in the order of the points.
std::vector<Judgement*> judgements_of(std::span<PointComparison> points);

struct ComparedFile {
  std::string path;
  layout::FileHeader header{};
};

/// The complete result of a comparison of two results files, or of two design points of one file.
struct StudyComparison {
  ComparedFile baseline;
  ComparedFile current;
  /// Label of the design point that serves as baseline, if two points of one file are compared; empty if two
  /// files are compared.
  std::string baseline_label;
  ComparisonLayer layer{ComparisonLayer::two_samples};
  std::string layer_reason;  ///< Reason why this method of comparison (layer) was chosen, one line.
  bool equal_to_the_bit{false};
  /// First dataset that differs between the files, with the place in it. Empty if the datasets are equal or
  /// were not compared bit by bit.
  std::string first_difference;
  std::vector<manifest_text::ManifestDifference> manifest_differences;
  /// Names of random parameters whose values differ although both files drew the same random numbers, because
  /// the manifests differ.
  std::vector<std::string> changed_inputs;
  double confidence{statistics::summary_confidence};  ///< Confidence of each one-sided bound.
  double false_discovery_rate{0.05};
  std::int64_t tests{0};  ///< Number of significance tests over which the false discovery rate is controlled.
  std::vector<PointComparison> points;
  std::vector<study::Goal> goals;  ///< Goals by which the points are judged.
  /// Verdict on the whole comparison; never GateVerdict::not_measured.
  GateVerdict verdict{GateVerdict::inconclusive};
  /// Number of trials per design point that decides the whole comparison with probability
  /// decision_probability. Null if it is decided already, or if no number up to max_trials_to_decide
  /// suffices.
  std::optional<double> trials_to_decide;
  /// Largest number of trials per design point that the forecast tried; unknown (NaN) without a forecast.
  double max_trials_to_decide{statistics::unknown};
  std::vector<std::string> notes;  ///< Further remarks for the reader, a line each.
};

/// Whether the comparison is of two design points of one file.
inline bool compares_points(const StudyComparison& comparison) {
  return !comparison.baseline_label.empty();
}

/// Whether the two files must be equal to the bit but differ.
inline bool is_unequal(const StudyComparison& comparison) {
  return comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
}

/// Compares a results file with a baseline: finds what the two have in common, matches their design points,
/// tests every measure at every point, controls the false discovery rate over all these tests, and gives
/// verdicts.
/// @throws Failure (bad_data) if points cannot be matched, one file has targets and the other torque levels,
/// or a file is damaged.
StudyComparison compare_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                                const GateRules& rules = {});

/// Compares two design points of one results file, with the point `baseline` as the reference: is the point
/// `current` as good?
/// @param baseline, current indices of the points
/// @throws Failure (bad_data) in the cases of compare_studies()
StudyComparison compare_points(const reading::AllTrialsFile& file, std::int64_t baseline,
                               std::int64_t current, const GateRules& rules = {});

/// Options of the comparison of two files.
struct CompareOptions {
  /// Path of the YAML file with margins and requirements; null: the default margins, no requirements.
  std::optional<std::filesystem::path> margins{};
  /// True: for every measure, a change for the better beyond the margin fails the gate, too.
  bool changed_fails{false};
  /// Largest number of trials of each point that are compared; null: a default number
  /// (GateRules::max_trials).
  std::optional<std::int64_t> max_trials{};
};

/// The rules of the comparison that follow from these options.
/// @param labels labels of the compared design points, which the file of margins may name
/// @throws Failure in the cases of read_gate_rules()
GateRules rules_of(const CompareOptions& options, std::span<const std::string> labels);

/// Reads the results file `current` and the results file `baseline`, and compares them.
/// @throws Failure in the cases of compare_studies(), read_gate_rules() and AllTrialsFile
StudyComparison compare_files(const std::filesystem::path& baseline, const std::filesystem::path& current,
                              const CompareOptions& options = {});

/// Result of update_baseline(): whether it replaced the baseline, and the comparison before.
struct BaselineUpdate {
  /// False if the baseline file was already equal to the new file, so that nothing was copied.
  bool changed{true};
  /// Verdict of the comparison of the new file with the baseline that it replaces; empty if there was no
  /// baseline.
  std::string comparison;
  std::vector<std::string> warnings;
};

/// Path of the log that records the reason for each update of a baseline: "NAME.h5.log.yaml", a YAML list,
/// oldest entry first.
std::filesystem::path baseline_log(const std::filesystem::path& baseline);

/// Makes a results file the new baseline: copies the complete file `file`, byte by byte, to `output`. The
/// reason is recorded in the log first, so a baseline without its record is never left behind.
/// @throws Failure if `file` is not a complete results file, or a file cannot be written
BaselineUpdate update_baseline(const std::filesystem::path& file, const std::filesystem::path& output,
                               const std::string& reason);

/// The verdict of the comparison in one sentence.
std::string verdict_sentence(const StudyComparison& comparison);

/// Text of a value of a measure or requirement with its unit; proportions in per cent.
/// @param quantity name of the measure or of the required quantity
std::string value_text(double value, std::string_view quantity, std::string_view unit);

/// Text of a number of trials, rounded up to two digits.
std::string trials_text(double trials);

/// Description of the answer of the command `compare`, from which its text, JSON and other formats are
/// generated. If its table is long, people see only the noteworthy rows and the number of the other rows.
document::AnswerDescription<StudyComparison> comparison_answer();

/// The comparison as JUnit XML: a test suite with one case per point and measure or requirement. A judgement
/// that fails the gate is a failure, an inconclusive one an error; a measure without values is skipped.
std::string comparison_junit(const StudyComparison& comparison);

}  // namespace zerocount::comparison
