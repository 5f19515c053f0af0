#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/reading_replicates.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount::identification {

/// Tests whether quantisation and noise explain the residuals. Each statistic is compared with its
/// distribution in the replicates (see ReadingReplicates).
struct ResidualChecks {
  std::size_t observations{0};
  double spread{0.0};           ///< root mean square of residual/standard deviation
  double expected_spread{0.0};  ///< its mean over the replicates
  double spread_chance{1.0};    ///< proportion of the replicates with at least this spread
  double runs{0.0};             ///< number of runs of one sign
  double expected_runs{0.0};
  double runs_chance{1.0};         ///< proportion of the replicates at least as far from expected_runs
  double correlation_length{1.0};  ///< see ResidualStatistics
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

/// A clause that names the part of the residuals that encoder and noise do not explain. Empty if the checks
/// passed.
std::string reason_of_misfit(const ResidualChecks& checks);

/// A sample whose reading is an outlier: its residual is above 12 standard deviations of all (for counts,
/// 1.5 counts beyond rounding and 6 standard deviations of their noise), and the readings a few samples
/// away are not. Masked readings are none. Nothing if there is none.
std::optional<std::size_t> find_glitch(const TestRecord& record, const Eigen::VectorXd& path);

/// The sample at which the residuals change most over 20 samples.
std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path);

// Checks of the records after a fit. Each throws Failure (bad_data) with the record, the place in it and
// the reason.

/// Refuses records with a single outlier (see find_glitch()).
void refuse_glitches(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting);

/// Refuses residuals whose root mean square exceeds 2 % of a record's travel and 2 counts.
/// @param tolerance factor on these limits
void refuse_unexplained(std::span<const TestRecord> records, const ContactFit& fit, double tolerance);

/// Refuses a spread of the residuals of more than 30 times that of the simulated replicates.
void refuse_gross_misfit(std::span<const TestRecord> records, const ContactFit& fit,
                         const ResidualChecks& checks);

}  // namespace zerocount::identification
