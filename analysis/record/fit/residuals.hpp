#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/record.hpp"
#include "analysis/record/fit/solver.hpp"

namespace zerocount::fit {

/// Statistics of the normalised residuals, in units of the observations' standard deviations. The residuals
/// are in the order of time and of the records.
struct ResidualStatistics {
  double squares{0.0};  ///< Sum of the squared residuals.
  std::size_t observations{0};
  double runs{0.0};  ///< Number of runs of successive residuals with the same sign.
  /// Correlation length of the residuals: 1 + 2·Σ ρ_j over the lags j before the first autocorrelation ρ_j ≤
  /// 0.
  double correlation_length{1.0};
};

ResidualStatistics residual_statistics(const std::vector<double>& residuals);

/// Statistics of the normalised residuals (observed − modelled angle)/√variance of all observations.
ResidualStatistics residual_statistics(const FittedModel& model, const Observations& observations);

/// Spread of the true parameters that are drawn for the simulated replicates, in textbook standard
/// deviations.
inline constexpr double truth_spread = 3.0;

/// Source of the standard normal random numbers of one replicate. They depend only on the number of the
/// replicate.
class ReplicateNoise {
 public:
  explicit ReplicateNoise(std::size_t replicate);
  double next();
  Eigen::VectorXd next(Eigen::Index size);

 private:
  std::uint64_t replicate_;
  std::uint32_t draw_{0};
};

/// Simulated readings of the record's encoder for the angles `path`. `noise` is the standard deviation of the
/// readings before they are rounded to counts. All values are in the record's unit.
Eigen::VectorXd read_path(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                          ReplicateNoise& random);

/// Results of fits to simulated replicates of the records.
struct ReadingReplicates {
  /// [replicate, column] Error: estimate minus truth. The columns are the coordinates, then the offset of
  /// each record.
  Eigen::MatrixXd errors;
  /// [replicate] Statistics of the residuals of the replicate's fit.
  std::vector<ResidualStatistics> residuals;
};

/// Estimates the errors of a fit by a parametric bootstrap. True parameters are drawn around the model's
/// point. Their paths are read by a simulated encoder with quantisation and noise. The readings are converted
/// to observations and fitted like the real ones, with the model linearised at its point.
///
/// The textbook formula (inverse of the normal matrix) is not valid because readings of an encoder are not
/// independent: the errors at successive edges of a steady ramp compensate each other, and their influence
/// depends on the positions of the edges. The true parameters have three times the textbook standard
/// deviations: enough to vary these positions, and little enough for the linearisation.
/// @param replicates number of replicates
/// @param first number of the first replicate; the random numbers of a replicate depend on its number alone
ReadingReplicates replicate_readings(std::span<const TestRecord> records, const Fit& fit,
                                     std::size_t replicates, std::size_t first = 0);

/// A range of frequencies, Hz.
struct FrequencyRange {
  double low{0.0};
  double high{0.0};
};

/// A narrow peak in the spectrum of a record's residuals, a sign of a second mass on a spring.
struct ResidualLine {
  std::size_t record{0};  ///< Index of the record.
  double frequency{0.0};  ///< Frequency of the peak, Hz.
};

/// Searches the frequency at which the residuals of ring-downs oscillate although the model does not: a sign
/// of a second mass on a spring, such as a load, a coupling or the machine's base.
///
/// The spectrum is that of the residuals in the first 1024 samples of each hold that begins with a step of
/// the torque, summed over the holds of a record. It is compared with those of 1000 simulated replicates of
/// the readings along the model's path, each read at a random position between two counts. At each frequency,
/// the largest power of the first 500 is the usual one. A line is a peak whose ratio to the usual power is
/// more than twice the largest ratio of the other 500 at any frequency, and with at least half of the power
/// above the usual one within ±10 % of its frequency: a wrong friction law leaves residuals at all low
/// frequencies.
/// @param noise [record] standard deviation of the readings' noise, in the record's unit
/// @param own frequencies of the model's own oscillation: lines are searched outside of them
/// @returns the line with the largest ratio. Null if there is none, or no evenly sampled record has a
/// ring-down of 64 samples.
std::optional<ResidualLine> residual_line(Records records, const FittedModel& model,
                                          const std::vector<double>& noise, const FrequencyRange& own);

/// Result of the tests whether quantisation and noise explain the residuals. Each statistic is compared with
/// its distribution in the replicates (see ReadingReplicates).
struct ResidualChecks {
  std::size_t observations{0};
  /// Spread: root mean square of the residuals divided by their standard deviations; about 1 if the
  /// observations' errors explain them.
  double spread{0.0};
  double expected_spread{0.0};  ///< Expected spread: its mean over the simulated replicates.
  /// p-value of the spread: proportion of the replicates with at least this spread.
  double spread_chance{1.0};
  double runs{0.0};  ///< Number of runs of successive residuals with the same sign.
  double expected_runs{0.0};
  /// p-value of the runs: proportion of the replicates whose number of runs is at least as far from
  /// expected_runs.
  double runs_chance{1.0};
  double correlation_length{1.0};  ///< Correlation length of the residuals, see ResidualStatistics.
  double expected_correlation_length{1.0};
  /// Whether the tests are passed: both p-values are at least 1 %, or the spread is less than half of the
  /// expected one (then the residuals are rounding errors, whose runs do not matter).
  bool passed{true};
  /// Factor by which the intervals are widened if the tests failed: from the ratios of spread and correlation
  /// length to the expected ones. 1 if they passed.
  double widening{1.0};
};

ResidualChecks check_residuals(const ResidualStatistics& residuals,
                               const std::vector<ResidualStatistics>& replicates);

/// The errors of a fit, from replicates of the readings, and the checks of its residuals.
struct FitErrors {
  Eigen::MatrixXd errors;  ///< [replicate, column] Errors of the replicates, see ReadingReplicates.
  ResidualChecks checks;
};

FitErrors errors_of(Records records, const Fit& fit, std::size_t replicates);

/// A clause that names the statistic by which the residuals differ from what encoder and noise explain. Empty
/// if the checks passed.
std::string reason_of_misfit(const ResidualChecks& checks);

/// [sample] Residuals: measured − modelled angle, in the record's unit; for counts the measured angle is the
/// middle of the count. 0 for masked readings.
Eigen::VectorXd residuals_along(const TestRecord& record, const Eigen::VectorXd& path);

/// Root mean square of the residuals of the readings that are not masked, in the record's unit. Quantisation
/// of counts alone gives 0.29.
double misfit_along(const TestRecord& record, const Eigen::VectorXd& path);

/// True if quantisation and noise roughly explain the residuals of a record. For counts the test is the
/// distance of the path from the counts, for other readings the autocorrelation of the residuals.
/// @param path [sample] modelled angle, in the record's unit
bool is_explained(const TestRecord& record, const Eigen::VectorXd& path);

/// Index of a sample whose reading is an outlier; null if there is none. The residual of an outlier exceeds
/// 12 standard deviations of all residuals (for counts: 1.5 counts beyond rounding and 6 standard deviations
/// of their noise), the residuals a few samples away do not, and the reading differs as much from the
/// readings before and after it. Masked readings are not considered.
std::optional<std::size_t> find_glitch(const TestRecord& record, const Eigen::VectorXd& path);

/// Index of the sample at which the residuals change most over 20 samples.
std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path);

}  // namespace zerocount::fit
