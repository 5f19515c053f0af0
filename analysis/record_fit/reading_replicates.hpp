#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/record_fit/joint_fit.hpp"

namespace zerocount::record_fit {

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

/// (observed − modelled angle)/√variance of every observation, at the model's point plus `step` in the
/// linearised model; an empty `step` is 0.
std::vector<double> residuals_of(const FittedModel& model, const Observations& observations,
                                 const Eigen::VectorXd& step);

/// Standard deviation of the replicates' true parameters, in textbook standard deviations.
inline constexpr double truth_spread = 3.0;

/// The standard normal numbers of one replicate, which depend on its number only.
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
  std::vector<ResidualStatistics> residuals;  ///< [replicate]
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
/// @param noise [record] of the readings, in the record's unit.
/// @param first number of the first replicate; each is a function of its number
ReadingReplicates replicate_readings(std::span<const TestRecord> records, const FittedModel& model,
                                     const FitSetting& setting, const std::vector<double>& noise,
                                     std::size_t replicates, std::size_t first = 0);

}  // namespace zerocount::record_fit
