#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/answer/fit_report.hpp"
#include "analysis/sliding_identification/sliding_record.hpp"

namespace zerocount::sliding_identification {

constexpr Eigen::Index balance_terms = 6;
constexpr Eigen::Index direction_term = 1;
constexpr Eigen::Index offset_term = 3;

/// The torque about a sample, and what it is linear in while the axis slides:
///
///   u = J·a + d·Fc + cs·v + u0 + g1·sin(2π·x/pitch) + g2·cos(2π·x/pitch)
///
/// with the last two terms 0 where the record moves by less than a fiftieth of the pitch, or knows none.
/// The other terms are means with the same triangular weights over 4·smoothing samples, which turn the second
/// differences of the positions into a mean acceleration: smoothing adds no error to the balance.
struct TorqueBalance {
  Eigen::Vector<double, balance_terms> terms;  ///< acceleration, direction, velocity, 1, sine and cosine
  double torque{0.0};                          ///< N m or N
};

/// Samples before and after the sample that a balance is from.
inline std::size_t balance_reach(const SlidingRecord& record) {
  return 2 * record.smoothing;
}

/// The balance at sample k, at least balance_reach() from both ends of the record. The errors of the readings
/// bias a fit by it.
TorqueBalance torque_balance(const SlidingRecord& record, std::size_t k, double direction);

struct SlidingFit;
struct SlidingRecord;

/// A torque against the drive that depends on the position x as read: a·sin(κ·x) + b·cos(κ·x), such as
/// gravity (once a revolution) and cogging; or a·x.
struct PositionWave {
  double periods{0.0};      ///< per revolution, or per pitch of a linear axis; 0: proportional to x
  double wave_number{0.0};  ///< κ, 1/rad or 1/m
};

/// Most waves of a fit, and their amplitudes: of sine and cosine in turns.
inline constexpr std::size_t max_position_waves = 4;
inline constexpr std::size_t position_terms = 2 * max_position_waves;

/// [term] sin(κ·x) and cos(κ·x) of each wave, or x and 0; 0 for waves that the fit does not have.
using PositionShape = std::array<double, position_terms>;

PositionShape shape_at(double x, std::span<const PositionWave> waves);

/// Gives each sample of the records its shape.
void set_position_waves(std::vector<SlidingRecord>& records, std::span<const PositionWave> waves);

/// The wave, none of the fit's, that the unexplained torque of the windows shows best: of up to 1000 periods
/// in a revolution or pitch, and of a linear axis proportional to the position. The usual one, once a
/// revolution or that of a linear axis, unless another one beside it explains visibly more. Nothing if no
/// wave explains more than chance.
///
/// The torque of the windows is regressed on what the law is linear in, acceleration, direction, velocity, 1
/// and the fit's waves, with and without the wave, because the law has taken a part of it.
std::optional<PositionWave> strongest_wave(const SlidingFit& fit);

/// Whether the amplitudes of a wave of the fit exclude 0 together, by their covariance.
bool is_shown(const SlidingFit& fit, std::size_t wave);

/// "ripple.1", with the periods; "slope" of a wave proportional to the position.
std::string name_of(const PositionWave& wave);

using FreeParameters = std::array<bool, sliding_dimension>;
using SlidingMatrix = Eigen::Matrix<double, sliding_dimension, sliding_dimension>;

/// A window of a record, and its initial position and velocity.
struct FittedWindow {
  const SlidingRecord* record;
  const Window* window;
  std::array<double, 2> start;
};

/// Result of a fit of the sliding law to all windows of records, which must outlive it uncut.
struct SlidingFit {
  SlidingPoint point{SlidingPoint::Zero()};
  FreeParameters free{};
  std::vector<PositionWave> waves{};  ///< whose amplitudes are fitted
  std::vector<FittedWindow> windows;
  std::size_t samples{0};
  double misfit{0.0};  ///< root mean square of the residuals, in steps of the readings
  /// Covariance of the point; zero for parameters that are not free. See fit_sliding().
  SlidingMatrix covariance{SlidingMatrix::Zero()};
  std::vector<double> unexplained;  ///< [window] mean torque against the drive that the model lacks, N m or N
  double unexplained_torque{0.0};   ///< its root mean square
};

/// The starting point: least squares of the torque on acceleration, direction, velocity, 1 and a torque that
/// repeats with the pitch (the inverse dynamics), over all samples of the strokes. Its derivatives are
/// differences of the readings over a few samples, whose errors bias it; the fit does not use them.
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

/// How much of the sum of squares a Stribeck excess with this velocity (rad/s or m/s) would explain, by one
/// Gauss–Newton step from a fit without.
double stribeck_gain(const SlidingFit& fit, double velocity);

constexpr double min_excess_ratio = 3.5;  ///< of the Stribeck excess to its standard error

/// The reported parameters with their 95 % intervals. What the fit has no parameter for, or knows too badly,
/// is not identifiable.
std::vector<identification::ParameterEstimate> estimates_of(const SlidingFit& fit, parameters::AxisKind axis);

}  // namespace zerocount::sliding_identification
