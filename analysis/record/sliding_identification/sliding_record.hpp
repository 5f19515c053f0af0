#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/records/raw_series.hpp"
#include "analysis/record/sliding_identification/position_torque.hpp"
#include "core/motion/torque_course.hpp"
#include "experiments/parameters/study_units.hpp"

namespace ceres {
class CostFunction;
}
namespace zerocount::sliding_identification {

/// A stroke (motion in one direction), or a part of one, over which the motion is simulated from its own
/// initial state.
struct Window {
  std::size_t first{0};   ///< Index of the first sample.
  std::size_t last{0};    ///< Index of the last sample, which still belongs to the window.
  std::size_t stroke{0};  ///< Index of the stroke (motion in one direction) in the record.
  double direction{0.0};  ///< Sign of the velocity: −1 or 1.
};

/// A motion record, checked and cut into windows: pieces in which the axis slides without a reversal.
///
/// Lengths are in rad and torques in N m; of a linear axis in m and N.
struct SlidingRecord {
  std::string name;  ///< Name of the record in messages.
  parameters::AxisKind axis{};
  std::vector<double> time;                  ///< [sample] Time, s.
  std::vector<motion::TorqueCourse> torque;  ///< [sample] Torque from t_k to t_{k+1}, N m or N.
  std::vector<double> position;              ///< [sample] Position as read, rad or m; 0 at the first sample.
  /// [sample] Velocity, from readings up to `smoothing` samples before and after, rad/s or m/s; used for the
  /// starting point.
  std::vector<double> velocity;
  double delay{0.0};  ///< Delay of the torque, in samples, that was assumed when the record was read.
  /// Resolution of the readings: an encoder step, or three standard deviations of their noise if larger, rad
  /// or m.
  double resolution{0.0};
  double origin{0.0};  ///< Reading at the first sample, rad or m.
  /// Travel after which a position-dependent torque may repeat: 2π rad for a rotary axis; for a linear axis
  /// the pitch, m, or 0 if unknown.
  double pitch{0.0};
  /// True if the record covers a fiftieth of the pitch or more, so that a torque that repeats with it can be
  /// seen.
  bool turns{false};
  std::size_t waves{0};  ///< Number of position-dependent torques (waves), see set_position_waves().
  /// [sample] Sine and cosine of the position-dependent torques at the position; empty without them.
  std::vector<PositionShape> shape{};
  /// [interval] Sine and cosine of the position-dependent torques at the position half-way between two
  /// samples.
  std::vector<PositionShape> shape_between{};
  std::size_t smoothing{1};
  std::size_t window_samples{0};  ///< Approximate number of samples in a window.
  /// Travel after a standstill or a reversal from which the axis slides, rad or m; 0: no presliding was seen.
  double presliding_travel{0.0};
  /// Total travel of all motions between standstills and reversals, rad or m. The strokes are parts of it.
  double moved{0.0};
  std::vector<Window> strokes;
  std::vector<Window> windows;
  double min_velocity{0.0};  ///< Smallest |velocity| in the strokes (sliding in one direction), rad/s or m/s.
  double max_velocity{0.0};  ///< Largest |velocity| in the strokes (sliding in one direction), rad/s or m/s.
};

inline std::size_t samples_of(const Window& window) {
  return window.last - window.first + 1;
}

constexpr std::size_t max_window_samples = 256;
constexpr std::size_t min_window_samples = 16;

/// Proportion of the records' total travel that lies in strokes, the parts in which the axis slides in one
/// direction.
double used_proportion(std::span<const SlidingRecord> records);

/// Finds the strokes (sliding motions in one direction) of a series, and cuts them into windows of
/// max_window_samples.
///
/// A run is a longest sequence of samples at which the velocity, over 5 samples to both sides, has one sign
/// and moves the axis by at least 3 steps of the readings, without a stop in between. A stroke is the part of
/// a run in which the axis slides: where the series says so, or else beyond the presliding_travel() from the
/// run's start. 5 samples at each end of a run are left out, because the reversal may be among them. Strokes
/// shorter than 50 steps or 20 samples are left out.
/// @throws Failure (bad_data) if the times do not increase or have gaps, the torque is constant, or there is
/// no stroke.
/// @param pitch travel of a linear axis after which torques may repeat, m; 0: unknown
SlidingRecord sliding_record(const records::RawSeries& series, double pitch = 0.0);

/// Cuts the strokes of a record into windows of about `samples` samples that cover at least 50 steps of the
/// readings.
void cut_windows(SlidingRecord& record, std::size_t samples);

/// The fitted parameters of a sliding axis, in this order.
enum SlidingCoordinate : std::size_t {
  log_inertia,            ///< Natural logarithm of the inertia J (kg m²) or of the mass (kg).
  coulomb_level,          ///< Coulomb friction level Fc, N m or N.
  viscous_damping,        ///< Viscous damping cs, N m s/rad or N s/m.
  offset_torque,          ///< Constant offset torque u0, N m or N.
  stribeck_excess,        ///< Stribeck excess Fs − Fc over the Coulomb level, N m or N.
  log_stribeck_velocity,  ///< Natural logarithm of the Stribeck velocity ωs, rad/s or m/s.
  /// First of the amplitudes of the position-dependent torques, N m or N (for a slope N m/rad or N/m).
  position_amplitudes,
  sliding_dimension = position_amplitudes + position_terms
};

using SlidingPoint = Eigen::Matrix<double, sliding_dimension, 1>;

/// Residuals of a window for Ceres: the positions of a simulated sliding motion minus the readings, in units
/// of the resolution. The parameters are the first coordinates of a SlidingPoint, as many as the record's
/// position-dependent torques need, and the initial position and velocity.
///
/// The motion is J·dω/dt = u − u0 − p(θ) − cs·ω − d·g(ω), dθ/dt = ω, the law of
/// core/friction/sliding/sliding.hpp with an offset and with the torques p of the record's waves, by the
/// classical Runge–Kutta method, with steps of at most a sampling interval and a twentieth of the time
/// constants of the friction and of the amplifier. The derivatives are those of these steps, by forward
/// automatic differentiation. p is taken at the positions that were read, and between two of them at that of
/// the cubic through four: their errors are small beside a wave, and p is then known but for its amplitudes.
/// The evaluation fails where the motion is not finite.
/// @param record and
/// @param window must outlive the result.
std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window);

/// Travel after a standstill or a reversal, rad or m, beyond which the axis slides; 0 if the readings show no
/// presliding motion.
///
/// A run is a motion in one direction, from a standstill or a reversal. Before it slides, the friction rises
/// with the travel s since its start, whatever the law; while it slides, it does not depend on s. A dwell
/// that ends where it began, in which the rotor creeps under the loop's integral, is short runs with little
/// friction. Fitted by least squares is
///
///   u = J·a + cs·v + u0 + d·(Fc + D_i),   d = ±1 the direction,
///
/// with a level Fc + D_i for each band of s (ratio √2), and Fc above the band in question. Bands are taken
/// from the longest travels down. The axis does not slide in the first band with D_i < −Fc/20, by 3 standard
/// errors, below which the deficit is on average as large at least (friction that varies along the axis makes
/// other patterns). Laws approach their level exponentially, so four times the upper end of that band is
/// returned, unless more than a quarter of the longest run would be lost.
/// @param record record whose velocities are known
/// @param runs motions in one direction, from a standstill or reversal to the next
double presliding_travel(const SlidingRecord& record, std::span<const Window> runs);

}  // namespace zerocount::sliding_identification
