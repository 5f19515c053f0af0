#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/observations.hpp"
#include "analysis/record/fit/record.hpp"

namespace ceres {
class IterationCallback;
class Problem;
}  // namespace ceres
namespace zerocount::fit {

/// End conditions and step control of a non-linear least-squares search. The defaults are those of Ceres.
struct SearchSetting {
  int max_steps{50};
  /// Number of consecutive steps with non-finite residuals after which the search fails.
  int max_invalid_steps{5};
  /// Relative decrease of the sum of squares in one step below which the search ends.
  double tolerance{1e-6};
  double parameter_tolerance{1e-8};  ///< Relative change of the parameters below which the search ends.
  double trust_region{1e4};          ///< Radius of the trust region for the first step.
  /// True: the solver eliminates the parameter blocks on which few residuals depend, which is faster with
  /// many blocks.
  bool many_blocks{false};
  /// Callback that is called after each step and may end the search; not owned; null: none.
  ceres::IterationCallback* end{nullptr};
};

struct SearchResult {
  /// False if the residuals are not finite. The parameters are then unchanged.
  bool found{false};
  bool converged{false};
  double squares{0.0};  ///< Sum of the squared residuals at the end.
};

/// Moves the parameters of the problem to the minimum of the sum of squares by the Levenberg–Marquardt
/// method, on one thread.
///
/// The program calls ceres::Solve() nowhere else. It prints nothing: what Ceres would write to standard error
/// through glog, such as "Residual and Jacobian evaluation failed", is in the result, and the caller says
/// what it means for the records.
SearchResult search_least_squares(ceres::Problem& problem, const SearchSetting& setting);

/// The unknowns of a fit: the coordinates of the model, and for each record the encoder's reading at θ = 0.
struct FitPoint {
  Point axis;
  Eigen::VectorXd offset;  ///< [record] Reading of the encoder at the angle θ = 0, in the record's unit.
};

/// Settings of a fit: model, free coordinates, prior and end conditions.
struct FitSetting {
  FitModel model;
  FreeCoordinates free{};
  /// Mean of a weak normal prior on the free coordinates, which keeps undetermined coordinates finite. Its
  /// standard deviation `prior_spread` corresponds to a parameter known to a factor of 400.
  Point prior;
  double prior_spread{3.0};
  double tolerance{1e-6};  ///< Relative change of the sum of squares at which the fit ends.
  int max_steps{50};
  /// Number of simulated samples (FitModel::simulated) at which the fit ends after its present step.
  double max_simulated{std::numeric_limits<double>::infinity()};
};

/// [record] The observations of each record, in the order of time.
using Observations = std::vector<std::vector<AngleObservation>>;

/// [record] Every reading that is not masked as an observation, with the variance of the rounding to counts.
Observations all_readings(Records records);

/// Result of a fit: its point, its sum of squares, and whether it converged.
struct FitResult {
  FitPoint point;
  double squares{0.0};    ///< Minimum sum of squares, including the prior; infinite if the fit failed.
  bool converged{false};  ///< True if the fit converged within FitSetting::max_steps.
};

/// Fits a model to the observations of all records. Minimises the sum of squares of (observed − modelled
/// angle)/√variance and of the prior, starting at `start`. Non-linear least squares by Ceres
/// (Levenberg–Marquardt, dense QR). If the fit fails, the point is `start` and `squares` is infinite.
FitResult fit_jointly(Records records, const Observations& observations, const FitPoint& start,
                      const FitSetting& setting);

/// Fits a model as fit_jointly() does, with the starting point as the mean of the prior.
FitResult fit_from(Records records, const Observations& observations, const FitPoint& start,
                   FitSetting setting);

/// Completes a point of the model by the encoder offsets for which the residuals of each record have the mean
/// 0, and computes the sum of squares of all readings divided by the variance of the rounding to counts. The
/// sum is infinite if the motion cannot be simulated, or is too fast for the sampling.
FitResult with_mean_offsets(Records records, const FitModel& model, const Point& point);

/// One round of a search from many starting points: the fits from the best `points` of them each take `steps`
/// steps.
struct SearchRound {
  std::size_t points{0};
  int steps{0};
};

using SearchRounds = std::initializer_list<SearchRound>;

/// Continues the best of the fits, in parallel. Each round continues fewer fits by more steps (successive
/// halving: Jamieson & Talwalkar, AISTATS 2016).
/// @returns the fits of the last round with a finite sum of squares, sorted by it
std::vector<FitResult> follow_best(Records records, const Observations& observations,
                                   std::vector<FitResult> fits, FitSetting setting, SearchRounds rounds);

/// Searches minima from many starting points by follow_best().
/// @returns the fits whose sum of squares is within four times the smallest one
std::vector<FitResult> promising_fits(Records records, const Observations& observations,
                                      const std::vector<Point>& starts, const FitSetting& setting,
                                      SearchRounds rounds = {{6, 4}, {3, 8}});

/// A fit model at a point, with the simulated motions and their derivatives there (its linearisation).
struct FittedModel {
  FitPoint point;
  std::vector<RecordMotion> motions;  ///< [record] Modelled motions; their paths include the encoder offsets.
};

FittedModel model_at(Records records, const FitPoint& point, const FitSetting& setting);

/// [record] The readings converted to observations with independent errors (see observe()), along the paths
/// of a model.
/// @param noise [record] standard deviation of the readings' noise, in the record's unit
Observations observations_along(Records records, const FittedModel& model, const std::vector<double>& noise);

/// Whether all values of the simulated motion are finite.
bool is_finite(const RecordMotion& motion);

/// A model fitted to records, with the observations behind the fit.
struct Fit {
  FitSetting setting;
  FittedModel model;
  /// [record] Standard deviation of the readings' noise in the record's unit; 0: counts without noise.
  std::vector<double> noise;
  /// [record] Observations; readings were last converted to them along the paths of the model at that time.
  Observations observations;
};

/// Sets the model of `fit` to the point `at`, and converts the readings to observations along it.
void observe_at(Records records, const FitPoint& at, Fit& fit);

/// Converts the readings to observations again, along the paths of the fit's present model.
void observe_again(Records records, Fit& fit);

/// Textbook covariance of the errors of a fit, valid for independent observations: the inverse of the normal
/// matrix, including the prior.
Eigen::MatrixXd textbook_covariance(const FittedModel& model, const Observations& observations,
                                    const FitSetting& setting);

/// Normal equations of the linearised model: the solution d of `matrix`·d = `gradient` is the step to the
/// minimum of the sum of squares. The first rows belong to the coordinates, the others to the offsets. Rows
/// of fixed coordinates are rows of the identity matrix.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  double squares{0.0};          ///< Sum of squares at the model's point, without the prior.
  std::size_t observations{0};  ///< Number of observations in the sum of squares.
};

/// The normal equations of a fit at the model's point, from the residuals of all observations and of the
/// prior.
NormalEquations normal_equations(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting);

/// Looks for better points near the model's point. Adds each of `changes` to it. Then one step of linear
/// least squares with the model's sensitivities adapts the free coordinates of `setting` and the offsets. The
/// sums of squares are those of the linear model.
/// @returns the points whose sum is smaller than the model's by more than chance, sorted by it
std::vector<FitResult> better_points(Records records, const Observations& observations,
                                     const FittedModel& model, const FitSetting& setting,
                                     const std::vector<Point>& changes);

class NormalEquationsSum {
 public:
  NormalEquationsSum(std::size_t records, const FitSetting& setting);

  /// Adds the observations of the record with the index `record`.
  /// @param path [sample] modelled path
  /// @param sensitivity [sample, coordinate] derivatives of the path
  void add(std::size_t record, const std::vector<AngleObservation>& observations, const Eigen::VectorXd& path,
           const Eigen::MatrixXd& sensitivity);

  /// The normal equations with the prior, including the prior's gradient at the coordinates `at`.
  NormalEquations with_prior(const Point& at) const;

 private:
  const FitSetting& setting_;
  NormalEquations sum_;
};

}  // namespace zerocount::fit
