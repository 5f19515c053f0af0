#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/angle_observations.hpp"
#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/record_motion.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// What is fitted: one contact, and of each record the angle that the encoder shows where θ = 0.
struct FitPoint {
  ContactPoint contact;
  Eigen::VectorXd offset;  ///< [record] in the record's unit
};

/// What is asked of a fit, beside the records.
struct FitSetting {
  FreeCoordinates free{};
  double creep_torque{1.0};  ///< σ0 of the coordinates, N m
  /// Where a free coordinate is kept by a weak spring, so that one of which the records say nothing stays
  /// finite: its standard deviation is `prior_spread`, which is that of a parameter known to a factor of 400.
  ContactPoint prior;
  double prior_spread{3.0};
  double tolerance{1e-6};  ///< relative change of the sum of squares at which the fit ends
  int max_steps{50};
};

/// The observations of each record.
using Observations = std::vector<std::vector<AngleObservation>>;

/// What a fit came to.
struct FitResult {
  FitPoint point;
  double squares{0.0};  ///< the least sum of squares
};

/// The point at which the sum of squares of (observed − modelled angle)/√variance, with that of the prior, is
/// least near `start`. Non-linear least squares by Ceres (Levenberg–Marquardt, dense QR). Where the fit
/// fails, the point is `start` and `squares` is infinite.
FitResult fit_jointly(std::span<const TestRecord> records, const Observations& observations,
                      const FitPoint& start, const FitSetting& setting);

/// The model at a point, with what is needed to go a little way from it.
struct FittedModel {
  FitPoint point;
  std::vector<RecordMotion> motions;  ///< [record]; the paths include the offsets
};

FittedModel model_at(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting);

/// The textbook's covariance of the errors of a fit, were the observations independent: the inverse of the
/// matrix of the normal equations, with the prior.
Eigen::MatrixXd textbook_covariance(const FittedModel& model, const Observations& observations,
                                    const FitSetting& setting);

/// The normal equations at a model: `matrix`·d = `gradient` leads to the least squares of the linearised
/// model. The first coordinate_count rows are the contact's, then come the offsets. Rows of coordinates that
/// are not free are those of the identity.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  double squares{0.0};          ///< sum of squares at the model, without the prior
  std::size_t observations{0};  ///< in the sum
};

class NormalEquationsSum {
 public:
  NormalEquationsSum(std::size_t records, const FitSetting& setting);

  /// Adds what the observations of record number `record` say where its path is `path`.
  void add(std::size_t record, const std::vector<AngleObservation>& observations, const Eigen::VectorXd& path,
           const PathSensitivity& sensitivity);

  /// With the prior, whose pull from the contact `at` towards the setting's point is included.
  NormalEquations with_prior(const ContactPoint& at) const;

 private:
  const FitSetting& setting_;
  NormalEquations sum_;
};

}  // namespace zerocount
