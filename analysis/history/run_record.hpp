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
  std::string verdict;           ///< of the gate
  std::string layer;             ///< see comparison::ComparisonLayer
  std::string baseline_created;  ///< UTC
  std::string baseline_commit;
};

/// Result of `zerocount compare` for one measure at one point.
struct ValueComparison {
  std::string verdict;                   ///< of the change
  double baseline{statistics::unknown};  ///< value of the baseline
  double effect{statistics::unknown};    ///< how much worse
  statistics::ConfidenceInterval bounds{statistics::unknown,
                                        statistics::unknown};  ///< of the effect, each one-sided
  double margin{statistics::unknown};
  double p{statistics::unknown};  ///< of no difference from the baseline, two-sided
};

/// The value of one measure at one point of a run.
struct RunValue {
  std::string point;    ///< label of the design point, with the condition if there is one: "high, loaded"
  std::string measure;  ///< name of a gate measure, or of one of the goal: "goal_rate", "goal_rate[large]"
  std::string unit;
  statistics::MeasurementKind kind{statistics::MeasurementKind::mean};
  double value{statistics::unknown};
  statistics::ConfidenceInterval bounds{statistics::unknown,
                                        statistics::unknown};  ///< 95 %; unknown where there are none
  std::int64_t n{0};                                           ///< trials or values that it is of
  std::optional<ValueComparison> comparison{};
};

/// One run of a study, without its values.
struct RunIdentity {
  std::string study;  ///< name
  std::string
      series_sha256;  ///< equal for runs whose true values would be equal without a change of the code
  std::string study_sha256;
  std::string file_sha256;  ///< identifies the run
  std::string seed;         ///< decimal
  std::int64_t trials{0};   ///< per design point
  std::string zerocount_version;
  std::string git_commit;
  std::string created;  ///< UTC, as 2002-07-21T12:00:00Z
  std::optional<RunComparison> comparison{};
};

/// One run of a study, as a history keeps it.
struct RunRecord : RunIdentity {
  std::vector<RunValue> values{};  ///< by point, then by measure
};

/// Identifies the series of runs that a file belongs to: the SHA-256 of its manifest's values with the
/// overrides and the defaults of its format version, without description, trials and seed. The seed remains
/// where something is drawn once per study: another seed is then another axis.
std::string series_sha256(const reading::AllTrialsFile& file);

/// The values of a complete results file, with the bounds of its summary: the measures of its goals if it has
/// any (comparison::goal_measures), then the gate measures; of each point under each condition.
/// @throws Failure: inconclusive where there is no value, bad_input where the trials are not independent,
/// and as summarise().
RunRecord record_of(const reading::AllTrialsFile& file);

/// An answer of `zerocount monitor` as a run: the median of each measure of a machine, which is the point,
/// with the baseline's, and 1 over the evidence against no change for p. The series is one baseline's.
/// Nothing for a file that is not named *.json.
/// @throws Failure: bad_data where it is not such JSON, bad_input for another answer, inconclusive without
/// moves
std::optional<RunRecord> monitor_record(const std::filesystem::path& json);

/// Adds to a run what the JSON of `zerocount compare` says of it.
/// @throws Failure (bad_data) where the file is not such JSON, (bad_input) where it is of another run.
void add_comparison(RunRecord& run, const std::filesystem::path& json);

}  // namespace zerocount::history
