#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/angle_observations.hpp"
#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/record_motion.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount::identification {

/// The unknowns of a fit: one contact, and for each record the encoder's reading at θ = 0.
struct FitPoint {
  ContactPoint contact;
  Eigen::VectorXd offset;  ///< [record] in the record's unit
};

/// Settings of a fit.
struct FitSetting {
  FreeCoordinates free{};
  double creep_torque{1.0};  ///< σ0 of the coordinates, N m
  /// Mean of a weak normal prior on the free coordinates, which keeps undetermined coordinates finite. Its
  /// standard deviation `prior_spread` corresponds to a parameter known to a factor of 400.
  ContactPoint prior;
  double prior_spread{3.0};
  double tolerance{1e-6};  ///< relative change of the sum of squares at which the fit ends
  int max_steps{50};
};

/// The observations of each record.
using Observations = std::vector<std::vector<AngleObservation>>;

/// Result of a fit.
struct FitResult {
  FitPoint point;
  double squares{0.0};  ///< the minimum sum of squares
};

/// Minimises the sum of squares of (observed − modelled angle)/√variance and of the prior, starting at
/// `start`. Non-linear least squares by Ceres (Levenberg–Marquardt, dense QR). If the fit fails, the point is
/// `start` and `squares` is infinite.
FitResult fit_jointly(std::span<const TestRecord> records, const Observations& observations,
                      const FitPoint& start, const FitSetting& setting);

/// The model at a point, with its linearisation.
struct FittedModel {
  FitPoint point;
  std::vector<RecordMotion> motions;  ///< [record]; the paths include the offsets
};

FittedModel model_at(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting);

/// Textbook covariance of the errors of a fit, valid for independent observations: the inverse of the normal
/// matrix, including the prior.
Eigen::MatrixXd textbook_covariance(const FittedModel& model, const Observations& observations,
                                    const FitSetting& setting);

/// Normal equations of the linearised model: `matrix`·d = `gradient` gives the step d to its least squares.
/// The first coordinate_count rows belong to the contact, the others to the offsets. Rows of fixed
/// coordinates are those of the identity.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  double squares{0.0};          ///< sum of squares at the model, without the prior
  std::size_t observations{0};  ///< in the sum
};

/// The residuals of all observations and of the prior at the model.
NormalEquations normal_equations(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting);

class NormalEquationsSum {
 public:
  NormalEquationsSum(std::size_t records, const FitSetting& setting);

  /// Adds the observations of record number `record` with the modelled path `path`.
  void add(std::size_t record, const std::vector<AngleObservation>& observations, const Eigen::VectorXd& path,
           const PathSensitivity& sensitivity);

  /// Adds the prior, including its gradient at the contact `at`.
  NormalEquations with_prior(const ContactPoint& at) const;

 private:
  const FitSetting& setting_;
  NormalEquations sum_;
};

}  // namespace zerocount::identification
