#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/identification/test_record.hpp"
#include "core/motion/plant_start.hpp"

namespace zerocount::identification {

/// Meaning of the torque of a series.
enum class TorqueKind {
  commanded,  ///< command to the amplifier at t_k, held until t_{k+1}
  motor       ///< motor torque at t_k
};

/// A material test as read, unchecked.
struct RawSeries {
  std::string name;                ///< name in messages
  std::vector<std::size_t> lines;  ///< [sample] line in the file; empty for a file without lines
  std::vector<double> time;        ///< s
  std::vector<double> torque;      ///< N m
  TorqueKind torque_kind{TorqueKind::commanded};
  double bandwidth{0.0};              ///< of the amplifier, Hz; 0: ideal amplifier
  double delay{0.0};                  ///< delay of a commanded torque, samples; the torque is 0 before
  std::vector<double> angle;          ///< whole counts, or rad
  double counts_per_revolution{0.0};  ///< 0 if the angle is in rad
  std::vector<double> code;           ///< DAC codes; empty if unknown
  int dac_bits{0};                    ///< 0 if unknown
  std::vector<bool> sliding;          ///< whether the hook slid; empty if unknown
  motion::PlantStart start;           ///< initial state of the contact
  bool units_known{false};            ///< certainly SI units, because this program wrote the file
};

/// "NAME:LINE", or "NAME, sample K".
std::string place_of(const RawSeries& series, std::size_t sample);

/// The user's choices for the interpretation of a table.
struct SeriesChoice {
  std::optional<std::string> torque;  ///< column: torque or drive_torque
  std::optional<std::string> angle;   ///< column: count or theta
  std::optional<double> counts_per_revolution;
  std::optional<double> bandwidth;  ///< Hz
  std::optional<double> delay;      ///< of the commanded torque, samples
  std::optional<int> dac_bits;
  std::optional<double> preload;    ///< N m
  std::optional<double> hardening;  ///< rad
};

/// Delay of the series' torque in samples: the chosen one, or `otherwise`; a motor torque has no delay.
/// @throws Failure (bad_input) if a delay is chosen for the motor torque.
double delay_of(const RawSeries& series, const SeriesChoice& choice, double otherwise);

/// Reads a table with the columns t (s), torque or drive_torque (N m), count or theta (rad), such as the
/// output of `zerocount trace`. If it has both torques, drive_torque is used. If it has both angles, count is
/// used if the counts per revolution are given, theta otherwise.
/// @throws Failure: bad_input if columns are missing or have other units, or if a delay is chosen for the
/// motor torque; and the failures of CsvTable.
RawSeries read_csv_series(const std::filesystem::path& path, const SeriesChoice& choice);

/// Reads the trace of a trial from a results file. The initial state of the contact, the encoder's
/// resolution, the delay and the amplifier's bandwidth are those of the trial, unless chosen otherwise. The
/// angle is that of the fine encoder's counts, unless theta is chosen.
/// @throws Failure: bad_input if the file has no such trial or no trace of it, or if a delay is chosen for
/// the motor torque; and the failures of StudyFile.
RawSeries read_study_series(const std::filesystem::path& path, std::int64_t point, std::int64_t index,
                            const SeriesChoice& choice);

/// Checks the series and converts it to a record for the fit.
/// @param any_magnitude whether to accept values that suggest other units
/// @throws Failure (bad_data) with the reason if one of the checks below fails.
TestRecord checked_record(const RawSeries& series, bool any_magnitude);

// Requirements on a series. Each check throws Failure (bad_data) with the place and the reason.

/// Requires at least 100 samples with increasing times, without gaps, on a regular grid to within a quarter
/// of the sampling interval.
/// @returns the sampling interval, s.
double checked_sample_time(const RawSeries& series);

/// Requires magnitudes that are plausible for a rotor on its bearing's friction, in SI units. Values wrong by
/// a factor of a thousand suggest another unit.
///
/// | quantity | accepted |
/// | --- | --- |
/// | sampling interval | 1 µs … 20 ms |
/// | largest torque | 1e-3 … 20 N m |
/// | travel (maximum − minimum angle) | 4e-6 … 0.05 rad |
/// | range of the torque over travel | 1 … 2e4 N m/rad |
void check_magnitudes(const RawSeries& series, const TestRecord& record);

/// Requires a torque that is not always 0, and an angle that changes.
void check_change(const RawSeries& series, const TestRecord& record);

/// Requires a travel of at least 5 counts, in the direction of the torque.
void check_motion(const RawSeries& series, const TestRecord& record);

/// Refuses a single reading whose distance from its neighbours is more than ten times that of all others.
void check_glitches(const RawSeries& series, const TestRecord& record);

/// Refuses a series in which the hook slides, if the series has that information.
void check_sticking(const RawSeries& series);

/// Refuses a clipped torque: a DAC code that stays at the end of its range for 3 samples, or a torque that
/// stays at its extreme after a slow rise while the angle continues and returns.
void check_clipping(const RawSeries& series, const TestRecord& record);

}  // namespace zerocount::identification
