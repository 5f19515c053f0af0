#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/identification/reading_replicates.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// Whether what the model leaves of the readings looks like the encoder's steps and noise: each figure beside
/// what it is in records made up from the fitted model (see ReadingReplicates).
struct ResidualChecks {
  std::size_t observations{0};
  double spread{0.0};           ///< root mean square of residual/standard deviation
  double expected_spread{0.0};  ///< its mean over the made-up records
  double spread_chance{1.0};    ///< proportion of the made-up records with as much or more
  double runs{0.0};             ///< stretches of residuals of one sign
  double expected_runs{0.0};
  double runs_chance{1.0};         ///< proportion of the made-up records as far from expected_runs or farther
  double correlation_length{1.0};  ///< see ResidualStatistics
  double expected_correlation_length{1.0};
  /// Both chances are 1 % or more; or the spread is less than half of what is expected, where the course of
  /// what is left does not matter: readings without noise and steps leave arithmetic.
  bool passed{true};
  /// Factor by which intervals are to be widened, where the checks failed: by how much larger the residuals
  /// are than expected, and by how much longer they keep their course.
  double widening{1.0};
};

ResidualChecks check_residuals(const ResidualStatistics& residuals,
                               const std::vector<ResidualStatistics>& replicates);

/// A sample at which the reading alone is off the path, by 1.5 counts (where they are counts) and 12 times
/// what is usual, while those a few samples away are not; nothing where there is none.
std::optional<std::size_t> find_glitch(const TestRecord& record, const Eigen::VectorXd& path);

/// The sample about which the readings part fastest from the path: where what is left of them changes most
/// over 20 samples.
std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path);

}  // namespace zerocount
