#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/records/raw_series.hpp"
#include "analysis/sliding_identification/position_torque.hpp"
#include "core/motion/torque_course.hpp"
#include "experiments/parameters/study_units.hpp"

namespace ceres {
class CostFunction;
}
namespace zerocount::sliding_identification {

/// A stroke, or a part of one, over which the motion is simulated from an initial state of its own.
struct Window {
  std::size_t first{0};   ///< First sample.
  std::size_t last{0};    ///< Last sample; it belongs to the window.
  std::size_t stroke{0};  ///< Number of the stroke in the record.
  double direction{0.0};  ///< −1 or 1: the sign of the velocity
};

/// A motion record, checked and cut into windows in which the axis slides without a reversal.
///
/// Lengths are in rad and torques in N m; of a linear axis in m and N.
struct SlidingRecord {
  std::string name;  ///< Name in messages.
  parameters::AxisKind axis{};
  std::vector<double> time;                  ///< [sample] Time, s.
  std::vector<motion::TorqueCourse> torque;  ///< [sample] Torque from t_k to t_{k+1}, N m or N.
  std::vector<double> position;              ///< [sample] Position as read, rad or m; 0 at the first sample.
  /// [sample] Velocity over `smoothing` samples to both sides, used for the starting point.
  std::vector<double> velocity;
  double delay{0.0};  ///< Delay of the torque that the record was read with, samples.
  /// Step of the readings, or three standard deviations of their noise, rad or m.
  double resolution{0.0};
  double origin{0.0};  ///< Reading at the first sample, rad or m.
  /// Travel with which a torque may repeat: 2π for a rotary axis. For a linear axis the pitch, m, or 0 if
  /// unknown.
  double pitch{0.0};
  bool turns{false};     ///< True if the record moves by a fiftieth of the pitch or more.
  std::size_t waves{0};  ///< Number of torques that depend on the position, see set_position_waves().
  std::vector<PositionShape> shape{};  ///< [sample] Shape of the position torques; empty without them.
  /// [interval] Shape of the position torques in the middle of the interval.
  std::vector<PositionShape> shape_between{};
  std::size_t smoothing{1};
  std::size_t window_samples{0};  ///< Approximate number of samples of the windows.
  /// Travel from a standstill or a reversal before the axis slides, rad or m; 0: not seen.
  double presliding_travel{0.0};
  /// Total travel of all motions between standstills and reversals, rad or m. The strokes are parts of it.
  double moved{0.0};
  std::vector<Window> strokes;
  std::vector<Window> windows;
  double min_velocity{0.0};  ///< Smallest |velocity| in the strokes, rad/s or m/s.
  double max_velocity{0.0};  ///< Largest |velocity| in the strokes, rad/s or m/s.
};

inline std::size_t samples_of(const Window& window) {
  return window.last - window.first + 1;
}

constexpr std::size_t max_window_samples = 256;
constexpr std::size_t min_window_samples = 16;

/// Proportion of the travel of the records that lies in strokes.
double used_proportion(std::span<const SlidingRecord> records);

/// Finds the strokes of a series, and cuts them into windows of max_window_samples.
///
/// A run is a longest sequence of samples at which the velocity, over 5 samples to both sides, has one sign
/// and moves the axis by at least 3 steps of the readings, without a stop in between. A stroke is the part of
/// a run in which the axis slides: where the series says so, or else beyond the presliding_travel() from the
/// run's start. 5 samples at each end of a run are left out, because the reversal may be among them. Strokes
/// shorter than 50 steps or 20 samples are left out.
/// @throws Failure (bad_data) if the times do not increase or have gaps, the torque is constant, or there is
/// no stroke.
/// @param pitch of a linear axis, m; 0: unknown
SlidingRecord sliding_record(const records::RawSeries& series, double pitch = 0.0);

/// Cuts the strokes into windows of about `samples` samples, and at least 50 steps of the readings.
void cut_windows(SlidingRecord& record, std::size_t samples);

/// The fitted parameters of a sliding axis, in this order.
enum SlidingCoordinate : std::size_t {
  log_inertia,            ///< ln of J (kg m²) or of the mass (kg)
  coulomb_level,          ///< Fc, N m or N
  viscous_damping,        ///< cs, N m s/rad or N s/m
  offset_torque,          ///< u0, N m or N
  stribeck_excess,        ///< Fs − Fc, N m or N
  log_stribeck_velocity,  ///< ln of ωs, rad/s or m/s
  position_amplitudes,    ///< the first of those of the position's waves, N m or N (of a slope N/m)
  sliding_dimension = position_amplitudes + position_terms
};

using SlidingPoint = Eigen::Matrix<double, sliding_dimension, 1>;

/// The positions of a simulated sliding motion less the readings in a window, in units of the resolution. The
/// parameters are the first coordinates of a SlidingPoint, as many as the record's waves need, and the
/// initial position and velocity.
///
/// The motion is J·dω/dt = u − u0 − p(θ) − cs·ω − d·g(ω), dθ/dt = ω, the law of
/// core/friction/sliding/sliding.hpp with an offset and with the torques p of the record's waves, by the
/// classical Runge–Kutta method, with steps of at most a sampling interval and a twentieth of the time
/// constants of the friction and of the amplifier. The derivatives are those of these steps, by forward
/// automatic differentiation. p is taken at the positions that were read, and between two of them at that of
/// the cubic through four: their errors are small beside a wave, and p is then known but for its amplitudes.
/// The evaluation fails where the motion is not finite.
/// @param record and @param window must outlive the result.
std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window);

/// Travel from the start of a run, rad or m, beyond which the axis slides; 0 where the readings show no
/// pre-sliding motion.
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
/// @param record with its velocities
double presliding_travel(const SlidingRecord& record, std::span<const Window> runs);

}  // namespace zerocount::sliding_identification
