#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/change_point.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"
#include "results/reading/all_trials_file.hpp"

/// Results over time: the values of many runs of a study, and when they changed.
namespace zerocount::history {

/// Result of `zerocount compare` for a run as a whole.
struct RunComparison {
  std::string verdict;           ///< Verdict of the gate.
  std::string layer;             ///< Layer of the comparison, see comparison::ComparisonLayer.
  std::string baseline_created;  ///< Time at which the baseline was made, UTC.
  std::string baseline_commit;
};

/// Result of `zerocount compare` for one measure at one point.
struct ValueComparison {
  std::string verdict;                   ///< Verdict on the change.
  double baseline{statistics::unknown};  ///< Value of the baseline.
  /// Effect in the unit of the measure, positive for the worse. From an answer of `zerocount monitor`: value
  /// − baseline.
  double effect{statistics::unknown};
  /// One-sided bounds of the effect.
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};
  double margin{statistics::unknown};
  double p{statistics::unknown};  ///< Two-sided p-value of no difference from the baseline.
};

/// The value of one measure at one point of a run.
struct RunValue {
  /// Label of the design point, with the setting if there is one: "high, loaded".
  std::string point;
  /// Name of a gate measure or of a measure of a goal: "goal_rate", "goal_rate[large]".
  std::string measure;
  std::string unit;
  statistics::MeasurementKind kind{statistics::MeasurementKind::mean};
  double value{statistics::unknown};
  /// 95 % bounds of the value; unknown if there are none.
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};
  std::int64_t n{0};  ///< Number of trials or values behind `value`.
  std::optional<ValueComparison> comparison{};
};

/// One run of a study, without its values.
struct RunIdentity {
  std::string study;  ///< Name of the study.
  /// Identifies the series: equal for runs whose true values would be equal without a change of the code.
  std::string series_sha256;
  std::string study_sha256;
  std::string file_sha256;  ///< Checksum of the results file; identifies the run.
  std::string seed;         ///< Seed as a decimal number.
  std::int64_t trials{0};   ///< Number of trials per design point.
  std::string zerocount_version;
  std::string git_commit;
  std::string created;  ///< Time at which the run was made, UTC, as 2002-07-21T12:00:00Z.
  std::optional<RunComparison> comparison{};
};

/// One run of a study, as a history keeps it.
struct RunRecord : RunIdentity {
  std::vector<RunValue> values{};  ///< Values, sorted by point, then by measure.
};

/// Identifies the series of runs that a file belongs to. It is the SHA-256 of the manifest's values with the
/// overrides and the defaults of the format version, without description, trials and seed. The seed is
/// included if something is drawn once per study, because another seed is then another axis.
std::string series_sha256(const reading::AllTrialsFile& file);

/// The values of a complete results file with the bounds of its summary, for each point in each setting:
/// first the measures of its goals if it has any (comparison::goal_measures), then the gate measures.
/// @throws Failure: inconclusive where there is no value, bad_input where the trials are not independent,
/// and as summarise().
RunRecord record_of(const reading::AllTrialsFile& file);

/// Converts an answer of `zerocount monitor` to a run. The point is the machine, and a value is the median of
/// a measure. It is compared with the baseline's median; 1 over the evidence against no change serves as p.
/// All answers with the same baseline form one series. Nothing for a file whose name does not end in .json.
/// @throws Failure: bad_data if the file is not such JSON, bad_input for another answer, inconclusive without
/// moves
std::optional<RunRecord> monitor_record(const std::filesystem::path& json);

/// Adds the comparison in the JSON of `zerocount compare` to a run.
/// @throws Failure: bad_data if the file is not such JSON; bad_input if it belongs to another run.
void add_comparison(RunRecord& run, const std::filesystem::path& json);

}  // namespace zerocount::history
