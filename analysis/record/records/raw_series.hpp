#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/record/records/column_mapping.hpp"
#include "core/motion/parameters.hpp"
#include "experiments/tables/text_table.hpp"

namespace zerocount::records {

/// Meaning of the torque values in a recorded series.
enum class TorqueKind {
  commanded,  ///< Torque commanded to the amplifier at sampling instant t_k, held until t_{k+1}.
  motor       ///< Torque that the motor exerts at sampling instant t_k.
};

/// Torque and encoder readings of a test as read from a file, before any check.
struct RawSeries {
  std::string name;  ///< Name of the series in messages.
  /// Name of the file if the series is one of several repetitions in it; otherwise empty.
  std::string file{};
  std::vector<std::size_t> lines;  ///< [sample] Line in the file; empty for a file without lines.
  std::vector<double> time;        ///< [sample] Time, s.
  std::vector<double> torque;      ///< [sample] Torque, N m; for a linear axis the force, N.
  TorqueKind torque_kind{TorqueKind::commanded};
  double bandwidth{0.0};  ///< Bandwidth of the amplifier, Hz; 0: ideal amplifier.
  double delay{0.0};      ///< Delay of a commanded torque, samples. The torque is 0 before.
  /// [sample] Angle in whole counts or rad; for a linear axis the position in counts or m.
  std::vector<double> angle;
  double count_size{0.0};  ///< Size of a count, rad or m; 0 if the angle is in rad or m.
  /// True for a linear axis. Units are then N in place of N m and m in place of rad.
  bool linear{false};
  /// [sample] Code sent to the digital-to-analogue converter (DAC); empty if unknown.
  std::vector<double> code;
  int dac_bits{0};             ///< Number of bits of the digital-to-analogue converter (DAC); 0 if unknown.
  std::vector<bool> sliding;   ///< [sample] Whether the axis was sliding (not sticking); empty if unknown.
  std::vector<bool> excluded;  ///< [sample] Whether the encoder reading is not used; empty: all are used.
  motion::PlantStart start;    ///< State of the friction contact at the first sample.
  /// True if the units are certainly SI units, because this program wrote the file.
  bool units_known{false};
  /// Notes for the user on what was changed while the series was read, a sentence each, without the name of
  /// the series.
  std::vector<std::string> notes{};
};

/// Place of a sample, for messages: "NAME:LINE", or "NAME, sample K" for a file without lines.
std::string place_of(const RawSeries& series, std::size_t sample);

/// An interval of time whose readings are not used, s. The torque in it still acts on the axis.
struct ExcludedTime {
  double from{0.0};
  double to{0.0};
};

/// Excludes the readings of the samples in the time interval, its ends included.
/// @return whether the interval contains any sample.
bool exclude(RawSeries& series, const ExcludedTime& interval);

/// The user's choices for the interpretation of a file.
struct SeriesChoice {
  /// Names of the columns that hold the quantities, at most one column for each quantity.
  std::vector<ColumnMapping> columns{};
  /// Character that separates the columns of a text file; nothing: found from the file.
  std::optional<tables::Separator> separator{};
  /// Sampling interval T of a file without times, s: sample k is at k·T.
  std::optional<double> sample_time{};
  /// Name of the column of the torque: torque or drive_torque; nothing: found from the file.
  std::optional<std::string> torque;
  /// Name of the column of the angle: count or theta; nothing: found from the file.
  std::optional<std::string> angle;
  /// Size of an encoder count, rad; m for a linear axis; nothing: not given.
  std::optional<double> count_size;
  bool linear{false};               ///< True if the default columns are those of a linear axis.
  bool rotary{false};               ///< True if the default columns are those of a rotary axis.
  std::optional<double> bandwidth;  ///< Bandwidth of the amplifier, Hz; nothing: not chosen.
  std::optional<double> delay;      ///< Delay of the commanded torque, samples; nothing: not chosen.
  std::optional<int> dac_bits;
  /// Preload of the friction contact (spring torque) at the start, N m; nothing: not chosen.
  std::optional<double> preload;
  /// Hardening state of the friction contact at the start, rad; nothing: not chosen.
  std::optional<double> hardening;
};

/// The reason why the choices contradict each other; empty if they do not.
std::string contradiction_in(const SeriesChoice& choice);

/// Delay of the series' torque in samples: the chosen one, or `otherwise`; a motor torque has no delay.
/// @throws Failure (bad_input) if a delay is chosen for the motor torque.
double delay_of(const RawSeries& series, const SeriesChoice& choice, double otherwise);

/// Reads the series from columns: those that `choice` maps, otherwise t or time, drive_torque or torque,
/// theta or count, such as `zerocount trace` writes them, or of a linear axis drive_force, force and
/// position. If there are both torques, drive_torque is used. If there are both angles, count is used if the
/// size of a count is given, theta otherwise. A file with a force or a position and without a torque is of a
/// linear axis.
///
/// The file has several repetitions if the mapped column of the repetition changes, or if the time returns to
/// the first one. Each becomes a series, and begins with the initial state of the contact.
///
/// Rows with the newest first are put in order of time, and an encoder reading that wraps is continued: see
/// unwrap().
/// @throws Failure: bad_input if columns are missing or their units do not fit, or if a delay is chosen for
/// the motor torque; and the failures of the source.
std::vector<RawSeries> read_columns(const tables::ColumnSource& source, const SeriesChoice& choice);

/// Makes the angle continuous where the reading of a counter or a single-turn encoder wraps: by a revolution
/// of a rotary axis, or by 2¹⁶ or 2³² counts. A step is taken as a wrap if it is longer than a quarter of
/// that jump and, without the jump, resembles its neighbours. A note is added to the series.
void unwrap(RawSeries& series);

/// Reads the trace of a trial from a results file. The initial state of the contact, the encoder's
/// resolution, the delay and the amplifier's bandwidth are those of the trial, unless chosen otherwise. The
/// angle is that of the fine encoder's counts, unless theta is chosen.
/// @throws Failure: bad_input if the file has no such trial or no trace of it, or if a delay is chosen for
/// the motor torque; and the failures of AllTrialsFile.
RawSeries read_study_series(const std::filesystem::path& path, std::int64_t point, std::int64_t index,
                            const SeriesChoice& choice);

/// The points of a results file that keep the trace of one trial, all of the same axis.
struct TracedPoints {
  std::vector<std::int64_t> points;
  /// Other points that keep the trace, but whose plant or friction has other values than the first: "point 3
  /// (k1=80)".
  std::vector<std::string> left_out;
};

/// Among the points that keep the trace of trial `index`, those with the same plant and friction values as
/// the first of them. If no point keeps it, point 0 alone.
TracedPoints traced_points(const std::filesystem::path& path, std::int64_t index);

}  // namespace zerocount::records
