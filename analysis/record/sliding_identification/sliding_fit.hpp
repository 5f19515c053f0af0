#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/report.hpp"
#include "analysis/record/sliding_identification/sliding_record.hpp"

namespace zerocount::sliding_identification {

using FreeParameters = std::array<bool, sliding_dimension>;
using SlidingMatrix = Eigen::Matrix<double, sliding_dimension, sliding_dimension>;

/// A window (piece of a stroke that is simulated by itself) with its fitted initial position and velocity,
/// rad and rad/s or m and m/s.
struct FittedWindow {
  const SlidingRecord* record;
  const Window* window;
  std::array<double, 2> start;
};

/// Result of a fit of the sliding law to all windows of some records. The records must outlive it, and must
/// not be cut into other windows.
struct SlidingFit {
  SlidingPoint point{SlidingPoint::Zero()};
  FreeParameters free{};
  std::vector<PositionWave> waves{};  ///< Position-dependent torques (waves) whose amplitudes are fitted.
  std::vector<FittedWindow> windows;
  std::size_t samples{0};
  double misfit{0.0};  ///< Root mean square of the residuals, in steps of the readings.
  /// Covariance of the fitted parameters; zero for parameters that are not free. See fit_sliding().
  SlidingMatrix covariance{SlidingMatrix::Zero()};
  /// [window] Mean torque against the drive that the model lacks, N m or N.
  std::vector<double> unexplained;
  double unexplained_torque{0.0};  ///< Root mean square of `unexplained`, N m or N.
};

/// Smallest number of strokes (motions in one direction) from which the variance between strokes is used.
/// With fewer it is known too poorly.
constexpr std::size_t min_independent_strokes = 12;

/// The starting point of the fit: least squares of the torque on acceleration, direction, velocity, 1 and a
/// torque that repeats with the pitch (the inverse dynamics), over all samples of the strokes. Its
/// derivatives are differences of the readings over a few samples, whose errors bias it; the fit does not use
/// them.
/// @throws Failure (bad_data) if the axis accelerates against the torque.
SlidingPoint starting_point(std::span<const SlidingRecord> records, bool both_directions);

/// Fits the law by output error: positions simulated under the torque that was applied, against those read.
///
/// Under closed loop the torque follows from the readings, so it correlates with their errors, and
/// regressions of the torque on derivatives of the readings are biased (Söderström and Stoica, System
/// Identification, 1989, chapter 10). Here the readings are in the residuals only, so the loop does not
/// matter. Each window has its own initial position and velocity (multiple shooting: Bock, in Numerical
/// Treatment of Inverse Problems, 1983), so forces that the model lacks do not add up over the record.
///
/// The residuals within a window, or within a stroke, may depend on each other in any way: the variance of
/// each parameter is the largest of that by independent residuals and those by the jackknife over windows and
/// over strokes (cluster-robust: MacKinnon, Nielsen and Webb, J. Econometrics 232 (2023) 272; Cameron and
/// Miller, J. Human Resources 50 (2015) 317).
/// @throws Failure (bad_data) if the simulated motion is not finite at the start, or at several steps in a
/// row.
SlidingFit fit_sliding(std::span<const SlidingRecord> records, const SlidingPoint& start,
                       const FreeParameters& free, const std::vector<PositionWave>& waves = {});

/// The residuals of a window and their derivatives, row-major as Ceres writes them.
struct WindowSlopes {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_point;
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> by_start;
};

WindowSlopes slopes_of(const FittedWindow& fitted, const SlidingPoint& point);

/// Decrease of the sum of squares of the residuals when a Stribeck excess with this velocity (rad/s or m/s)
/// is added, estimated by one Gauss–Newton step from a fit without it.
double stribeck_gain(const SlidingFit& fit, double velocity);

/// Smallest ratio of the Stribeck excess to its standard error at which the excess is significant.
constexpr double min_excess_ratio = 3.5;

/// The reported parameters with their 95 % intervals. A parameter is not identifiable if the fit does not
/// contain it, if its interval is too wide, or if its value is outside the range in the table of parameters.
/// Intervals end where that range ends.
std::vector<fit::ParameterEstimate> estimates_of(const SlidingFit& fit, parameters::AxisKind axis);

/// A sentence on a fitted parameter if no allowed value lies within the errors of the fit; empty if there is
/// no such parameter. For a true value at the end of the allowed range, chance causes it in one of 1000
/// records.
std::string impossible_parameter(const SlidingFit& fit, parameters::AxisKind axis);

}  // namespace zerocount::sliding_identification
