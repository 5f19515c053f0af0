#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/fit/record.hpp"
#include "analysis/fit/solver.hpp"

namespace zerocount::fit {

/// Statistics of the residuals, in units of the observations' standard deviations, in the order of time and
/// of the records.
struct ResidualStatistics {
  double squares{0.0};  ///< sum of squares
  std::size_t observations{0};
  double runs{0.0};  ///< number of runs of one sign
  /// 1 + 2·Σ ρ_j over the lags j before the first autocorrelation ρ_j ≤ 0.
  double correlation_length{1.0};
};

ResidualStatistics residual_statistics(const std::vector<double>& residuals);

/// Statistics of the normalised residuals (observed − modelled angle)/√variance of all observations.
ResidualStatistics residual_statistics(const FittedModel& model, const Observations& observations);

/// Standard deviation of the replicates' true parameters, in textbook standard deviations.
inline constexpr double truth_spread = 3.0;

/// Standard normal random numbers of one replicate. They depend only on the number of the replicate.
class ReplicateNoise {
 public:
  explicit ReplicateNoise(std::size_t replicate);
  double next();
  Eigen::VectorXd next(Eigen::Index size);

 private:
  std::uint64_t replicate_;
  std::uint32_t draw_{0};
};

/// The readings of the record's encoder along `path`. `noise` is their standard deviation before they are
/// rounded. All in the record's unit.
Eigen::VectorXd read_path(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                          ReplicateNoise& random);

/// Results of fits to simulated replicates of the records.
struct ReadingReplicates {
  Eigen::MatrixXd errors;                     ///< [replicate, coordinate, then offset] estimate − truth
  std::vector<ResidualStatistics> residuals;  ///< [replicate] Statistics of the residuals.
};

/// Parametric bootstrap. True parameters are drawn around the model's point. Their paths are read by the
/// encoder with quantisation and noise. The readings are converted to observations and fitted like the real
/// ones, with the model linearised at its point.
///
/// The textbook formula (inverse of the normal matrix) is not
/// valid because readings of an encoder are not independent: the errors at successive edges of a steady ramp
/// compensate each other, and their influence depends on the positions of the edges. The true parameters have
/// three times the textbook standard deviations: enough to vary these positions, and little enough for the
/// linearisation.
/// @param first number of the first replicate; each is a function of its number
ReadingReplicates replicate_readings(std::span<const TestRecord> records, const Fit& fit,
                                     std::size_t replicates, std::size_t first = 0);

/// A range of frequencies, Hz.
struct FrequencyRange {
  double low{0.0};
  double high{0.0};
};

/// A narrow peak in the spectrum of the residuals.
struct ResidualLine {
  std::size_t record{0};  ///< number of the record
  double frequency{0.0};  ///< Frequency of the peak, Hz.
};

/// The frequency at which the residuals of ring-downs oscillate although the model does not: a sign of a
/// second mass on a spring, such as a load, a coupling or the machine's base.
///
/// The spectrum is that of the residuals in the first 1024 samples of each hold that begins with a step of
/// the torque, summed over the holds of a record. It is compared with those of 1000 simulated replicates of
/// the readings along the model's path, each read at a random position between two counts. At each frequency,
/// the largest power of the first 500 is the usual one. A line is a peak whose ratio to the usual power is
/// more than twice the largest ratio of the other 500 at any frequency, and with at least half of the power
/// above the usual one within ±10 % of its frequency: a wrong friction law leaves residuals at all low
/// frequencies.
/// @param noise [record] of the readings, in the record's unit
/// @param own the oscillation of the model itself: lines are looked for outside of it
/// @returns the line with the largest ratio. Nothing if there is none, or no evenly sampled record has a
/// ring-down of 64 samples.
std::optional<ResidualLine> residual_line(Records records, const FittedModel& model,
                                          const std::vector<double>& noise, const FrequencyRange& own);

/// Tests whether quantisation and noise explain the residuals. Each statistic is compared with its
/// distribution in the replicates (see ReadingReplicates).
struct ResidualChecks {
  std::size_t observations{0};
  double spread{0.0};           ///< Root mean square of residual/standard deviation.
  double expected_spread{0.0};  ///< Mean of the spread over the replicates.
  double spread_chance{1.0};    ///< proportion of the replicates with at least this spread
  double runs{0.0};             ///< number of runs of one sign
  double expected_runs{0.0};
  double runs_chance{1.0};         ///< proportion of the replicates at least as far from expected_runs
  double correlation_length{1.0};  ///< Correlation length, see ResidualStatistics.
  double expected_correlation_length{1.0};
  /// Both probabilities are at least 1 %, or the spread is less than half of the expected one (then the
  /// residuals are rounding errors, whose runs do not matter).
  bool passed{true};
  /// Factor that widens the intervals if the checks failed: from the ratios of spread and correlation length
  /// to the expected ones.
  double widening{1.0};
};

ResidualChecks check_residuals(const ResidualStatistics& residuals,
                               const std::vector<ResidualStatistics>& replicates);

/// The errors of a fit, by replicates of the readings, and the checks of its residuals.
struct FitErrors {
  Eigen::MatrixXd errors;  ///< Errors of the replicates, see ReadingReplicates.
  ResidualChecks checks;
};

FitErrors errors_of(Records records, const Fit& fit, std::size_t replicates);

/// A clause that names the part of the residuals that encoder and noise do not explain. Empty if the checks
/// passed.
std::string reason_of_misfit(const ResidualChecks& checks);

/// [sample] Measured − modelled angle; for counts the measured angle is the middle of the count. 0 for masked
/// readings.
Eigen::VectorXd residuals_along(const TestRecord& record, const Eigen::VectorXd& path);

/// Root mean square of the residuals of the readings that are not masked, in the record's unit. Quantisation
/// alone gives 0.29.
double misfit_along(const TestRecord& record, const Eigen::VectorXd& path);

/// True if quantisation and noise explain the residuals roughly. For counts the test is the distance of the
/// path from the counts, for other readings the autocorrelation of the residuals.
bool is_explained(const TestRecord& record, const Eigen::VectorXd& path);

/// A sample whose reading is an outlier; nothing if there is none. Its residual exceeds 12 standard
/// deviations of all residuals (for counts: 1.5 counts beyond rounding and 6 standard deviations of their
/// noise), the residuals a few samples away do not, and the reading differs as much from the readings before
/// and after it. Masked readings are not considered.
std::optional<std::size_t> find_glitch(const TestRecord& record, const Eigen::VectorXd& path);

/// The sample at which the residuals change most over 20 samples.
std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path);

}  // namespace zerocount::fit
