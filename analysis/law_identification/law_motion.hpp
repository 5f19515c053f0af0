#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/joint_fit.hpp"
#include "analysis/identification/test_record.hpp"
#include "analysis/law_identification/law_model.hpp"

namespace zerocount::law_identification {

using Observations = identification::Observations;

/// The modelled readings of a record, and their derivatives.
struct LawMotion {
  Eigen::VectorXd path;         ///< [sample] in the record's unit
  Eigen::MatrixXd sensitivity;  ///< [sample, coordinate]; columns that are not free are 0
};

inline Eigen::Index dimension_of(const LawModel& model) {
  return static_cast<Eigen::Index>(model.free.size());
}

/// True if the rotor's motion before it slides is not much faster than the sampling of the fastest
/// record. What is faster cannot be told from the records, and takes long to simulate.
bool can_be_sampled(Records records, const LawModel& model, const LawPoint& point);

/// The rotor angle at every sample of a record since the first one, in the record's unit.
Eigen::VectorXd law_path(const identification::TestRecord& record, const LawModel& model,
                         const LawPoint& point);

/// law_path() and its derivatives with respect to the point, by forward differences.
LawMotion law_motion(const identification::TestRecord& record, const LawModel& model, const LawPoint& point);

/// Every reading that is not masked as an observation with the variance of a count.
Observations all_readings(Records records);

/// Unknowns of a fit: the coordinates of the law, and the reading of each record at θ = 0.
struct LawUnknowns {
  LawPoint point;
  Eigen::VectorXd phase;  ///< [record] in the record's unit
};

/// Result of a fit.
struct LawMinimum {
  LawUnknowns at;
  double squares{0.0};    ///< sum of squares over the variances
  bool converged{false};  ///< within the steps allowed
};

/// Standard deviation (of logarithms) of the weak prior about the start of a fit, which keeps coordinates
/// finite that the observations do not determine.
inline constexpr double prior_spread = 3.0;

/// Non-linear least squares by Ceres (Levenberg–Marquardt) from `start`, at most `steps` steps.
LawMinimum minimise(Records records, const LawModel& model, const Observations& observations,
                    const LawUnknowns& start, int steps);

}  // namespace zerocount::law_identification
