#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/statistics/change_point.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "results/reading/all_trials_file.hpp"

/// Results over time: the values of many runs of a study, and when they changed.
namespace zerocount::history {

/// Result of `zerocount compare` for a run as a whole.
struct RunComparison {
  /// Verdict of the gate on the whole run: "passed", "regression", "changed" or "inconclusive".
  std::string verdict;
  /// Method of the comparison: "bits", "paired" or "two_samples" (comparison::ComparisonLayer).
  std::string layer;
  std::string baseline_created;  ///< Time at which the baseline file was made, UTC.
  std::string baseline_commit;
};

/// Comparison of one measure at one design point with the baseline, from `zerocount compare` or `zerocount
/// monitor`.
struct ValueComparison {
  /// Verdict on the change of the measure, such as "worse" or "equivalent"; from `zerocount monitor`:
  /// "changed" or "no alarm".
  std::string verdict;
  double baseline{statistics::unknown};  ///< Value of the measure in the baseline.
  /// Change from the baseline in the unit of the measure, positive for the worse. From an answer of
  /// `zerocount monitor`: value − baseline.
  double effect{statistics::unknown};
  /// One-sided bounds of the effect; unknown (NaN) if there are none.
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};
  double margin{statistics::unknown};
  /// Two-sided p-value of the hypothesis that the value does not differ from the baseline.
  double p{statistics::unknown};
};

/// The value of one measure at one design point of a run, with its bounds.
struct RunValue {
  /// Label of the design point, with the setting if there is one: "high, loaded". From an answer of
  /// `zerocount monitor`: name of the machine's log.
  std::string point;
  /// Name of a gate measure or of a measure of a goal: "goal_rate", "goal_rate[large]".
  std::string measure;
  std::string unit;
  statistics::MeasurementKind kind{statistics::MeasurementKind::mean};
  double value{statistics::unknown};
  /// 95 % bounds of the value; NaN if there are none.
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};
  std::int64_t n{0};  ///< Number of trials or of single values from which `value` was computed.
  std::optional<ValueComparison> comparison{};
};

/// One run of a study, without its values.
struct RunIdentity {
  std::string study;  ///< Name of the study.
  /// Checksum that identifies the series of runs to which the run belongs. It is equal for runs whose true
  /// values would be equal if the program's code were the same.
  std::string series_sha256;
  std::string study_sha256;
  std::string file_sha256;  ///< Checksum of the results file; identifies the run.
  std::string seed;         ///< Seed of the random numbers as a decimal number.
  std::int64_t trials{0};   ///< Number of trials per design point.
  std::string zerocount_version;
  std::string git_commit;
  std::string created;  ///< Time at which the run was made, UTC, as 2002-07-21T12:00:00Z.
  std::optional<RunComparison> comparison{};
};

/// One run of a study, as a history keeps it.
struct RunRecord : RunIdentity {
  std::vector<RunValue> values{};  ///< Values of the run, sorted by design point, then by measure.
};

/// Checksum that identifies the series of comparable runs to which a results file belongs. It is the SHA-256
/// of the manifest's values with the overrides and the defaults of the format version, without description,
/// trials and seed. The seed is included if something is drawn once per study, because another seed then
/// means another axis.
std::string series_sha256(const reading::AllTrialsFile& file);

/// The record of a complete results file for the history: its values with the bounds of its summary, for each
/// design point in each setting. First come the measures of its goals, if it has any
/// (comparison::goal_measures), then the gate measures.
/// @throws Failure: inconclusive if there is no value, bad_input if the trials are not independent, and in
/// the cases of summarise().
RunRecord record_of(const reading::AllTrialsFile& file);

/// Converts an answer of `zerocount monitor` (a JSON file) to a run for the history. The machine serves as
/// design point, and a value is the median of a measure over the moves. It is compared with the baseline's
/// median; 1 divided by the evidence against no change serves as p. All answers with the same baseline form
/// one series. Null for a file whose name does not end in .json.
/// @throws Failure: bad_data if the file is not such JSON, bad_input for another answer, inconclusive without
/// moves
std::optional<RunRecord> monitor_record(const std::filesystem::path& json);

/// Adds to a run its comparison with a baseline, from the JSON answer of `zerocount compare`.
/// @throws Failure: bad_data if the file is not such JSON; bad_input if it belongs to another run.
void add_comparison(RunRecord& run, const std::filesystem::path& json);

}  // namespace zerocount::history
