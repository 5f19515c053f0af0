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

/// How much the two files have in common, which decides how they can be compared.
enum class ComparisonLayer {
  bits,        ///< one study by one build: every dataset must be equal to the bit
  paired,      ///< trial i drew the same random numbers in both: trials are compared one by one
  two_samples  ///< different draws: distributions are compared
};

/// "bits", "paired" or "two_samples".
std::string_view to_string(ComparisonLayer layer);

/// The verdicts of both files on the goal at a design point, if it was chosen before.
struct GoalStatuses {
  std::string name{};  ///< of `goals`; empty of a goal without a name
  goal::Status baseline{goal::Status::undecided};
  goal::Status current{goal::Status::undecided};
};

/// One design point in the two files, under one condition where there are any.
struct PointComparison {
  std::string label;         ///< with the condition, if there is one
  std::string design_point;  ///< its label without the condition
  std::string condition;     ///< that its trials are under; empty without conditions
  std::int64_t baseline_point{0};
  std::int64_t current_point{0};
  std::int64_t baseline_trials{0};
  std::int64_t current_trials{0};
  measures::UndecidedMoves baseline_undecided{};  ///< of all moves of the file
  measures::UndecidedMoves current_undecided{};
  std::int64_t pairs{0};  ///< trials that were compared one by one; 0 where they were not
  GateVerdict verdict{GateVerdict::not_measured};
  std::vector<Judgement> judgements{};  ///< the measures, then the requirements
  std::vector<GoalStatuses> goals{};    ///< where the points are judged by any
};

/// The judgements of all points.
std::vector<Judgement*> judgements_of(std::span<PointComparison> points);

struct ComparedFile {
  std::string path;
  layout::FileHeader header{};
};

/// Everything that a comparison found.
struct StudyComparison {
  ComparedFile baseline;
  ComparedFile current;
  std::string baseline_label;  ///< of the baseline's point where two points of one file are compared
  ComparisonLayer layer{ComparisonLayer::two_samples};
  std::string layer_reason;  ///< why this layer, one line
  bool equal_to_the_bit{false};
  std::string first_difference;  ///< first dataset that differs, with the place; empty if not searched for
  std::vector<manifest_text::ManifestDifference> manifest_differences;
  std::vector<std::string> changed_inputs;  ///< drawn parameters whose values differ on the same draws
  double confidence{statistics::summary_confidence};  ///< of each bound
  double false_discovery_rate{0.05};
  std::int64_t tests{0};  ///< over which the false discoveries are controlled
  std::vector<PointComparison> points;
  std::vector<study::Goal> goals;                  ///< by which the points are judged
  GateVerdict verdict{GateVerdict::inconclusive};  ///< never not_measured
  std::optional<double>
      trials_to_decide;  ///< per design point, that decide the whole, with decision_probability
  double max_trials_to_decide{statistics::unknown};  ///< per design point, the most that were tried
  std::vector<std::string> notes;                    ///< what else the reader should know, a line each
};

/// Whether the comparison is of two design points of one file.
inline bool compares_points(const StudyComparison& comparison) {
  return !comparison.baseline_label.empty();
}

/// Whether the data must be equal to the bit and are not.
inline bool is_unequal(const StudyComparison& comparison) {
  return comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
}

/// Compares a results file with a baseline: finds what the two have in common, matches their design points,
/// tests every measure at every point, controls the false discoveries over all of them, and gives verdicts.
/// @throws Failure (bad_data) where points cannot be matched, one file has targets and the other torque
/// levels, or a file is damaged.
StudyComparison compare_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                                const GateRules& rules = {});

/// Compares two design points of one file: is the point `current` as good as the point `baseline`?
/// @throws Failure (bad_data) as compare_studies
StudyComparison compare_points(const reading::AllTrialsFile& file, std::int64_t baseline,
                               std::int64_t current, const GateRules& rules = {});

/// How two files are compared.
struct CompareOptions {
  std::optional<std::filesystem::path> margins{};  ///< file of margins and requirements
  bool changed_fails{false};                       ///< a change for the better fails too, at every measure
  std::optional<std::int64_t> max_trials{};        ///< as GateRules::max_trials
};

/// The rules of these options for a file with these labels of design points.
/// @throws Failure as read_gate_rules
GateRules rules_of(const CompareOptions& options, std::span<const std::string> labels);

/// Compares two files.
/// @throws Failure as compare_studies and read_gate_rules, and as AllTrialsFile
StudyComparison compare_files(const std::filesystem::path& baseline, const std::filesystem::path& current,
                              const CompareOptions& options = {});

/// The result of a change of a baseline.
struct BaselineUpdate {
  bool changed{true};      ///< false where it was this file already
  std::string comparison;  ///< with the baseline that was replaced, a sentence; empty where there was none
  std::vector<std::string> warnings;
};

/// Where the reasons for a baseline are recorded: "NAME.h5.log.yaml", a YAML list, oldest entry first.
std::filesystem::path baseline_log(const std::filesystem::path& baseline);

/// Makes a whole results file the baseline `output`, byte by byte, and records the reason first: a baseline
/// without its record is never left behind.
/// @throws Failure where `file` is not a complete results file, or something cannot be written
BaselineUpdate update_baseline(const std::filesystem::path& file, const std::filesystem::path& output,
                               const std::string& reason);

/// The verdict in a sentence.
std::string verdict_sentence(const StudyComparison& comparison);

/// A value of a measure or requirement with its unit: proportions in per cent.
std::string value_text(double value, std::string_view quantity, std::string_view unit);

/// A number of trials to two digits, rounded up.
std::string trials_text(double trials);

/// The answer of `compare`. A long table shows only the noteworthy rows to people, with the number of the
/// others.
document::AnswerDescription<StudyComparison> comparison_answer();

/// JUnit XML: a test suite with one case per point and measure or requirement. What fails the gate is a
/// failure, an inconclusive verdict an error, and a measure without values is skipped.
std::string comparison_junit(const StudyComparison& comparison);

}  // namespace zerocount::comparison
