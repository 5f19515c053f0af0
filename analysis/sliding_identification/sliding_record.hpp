#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/records/raw_series.hpp"
#include "analysis/sliding_identification/position_torque.hpp"
#include "core/motion/torque_course.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::sliding_identification {

/// A stroke, or a part of one, over which the motion is simulated from an initial state of its own.
struct Window {
  std::size_t first{0};   ///< sample
  std::size_t last{0};    ///< sample, included
  std::size_t stroke{0};  ///< number of the stroke in the record
  double direction{0.0};  ///< −1 or 1: the sign of the velocity
};

/// A motion record, checked and cut into windows in which the axis slides without a reversal.
///
/// Lengths are in rad and torques in N m; of a linear axis in m and N.
struct SlidingRecord {
  std::string name;  ///< in messages
  parameters::AxisKind axis{};
  std::vector<double> time;                  ///< [sample], s
  std::vector<motion::TorqueCourse> torque;  ///< [sample] from t_k to t_{k+1}
  std::vector<double> position;              ///< [sample] as read, from 0 at the first sample
  std::vector<double> velocity;  ///< [sample] over `smoothing` samples to both sides, for the start
  double resolution{0.0};        ///< step of the readings, or three standard deviations of their noise
  double origin{0.0};            ///< reading at the first sample, rad or m
  double pitch{0.0};     ///< travel with which a torque may repeat: 2π, of a linear axis 0 if unknown
  bool turns{false};     ///< whether it moves by a fiftieth of the pitch or more
  std::size_t waves{0};  ///< torques that depend on the position (set_position_waves())
  std::vector<PositionShape> shape{};  ///< [sample]; empty without such torques
  std::size_t smoothing{1};
  double presliding_travel{0.0};  ///< from a standstill or a reversal, before the axis slides; 0: not seen
  std::vector<Window> strokes;
  std::vector<Window> windows;
  double min_velocity{0.0};  ///< smallest |velocity| in the strokes
  double max_velocity{0.0};  ///< largest |velocity|
};

inline std::size_t samples_of(const Window& window) {
  return window.last - window.first + 1;
}

constexpr std::size_t max_window_samples = 256;
constexpr std::size_t min_window_samples = 16;

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

}  // namespace zerocount::sliding_identification
