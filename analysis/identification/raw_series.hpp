#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/identification/test_record.hpp"
#include "core/motion/plant_start.hpp"

namespace zerocount {

/// What the torque of a series is.
enum class TorqueKind {
  commanded,  ///< to the amplifier at t_k, held until t_{k+1}
  motor       ///< of the motor at t_k
};

/// A material test as it was read, unchecked.
struct RawSeries {
  std::string name;                ///< as messages call it
  std::vector<std::size_t> lines;  ///< [sample] where it stands in the file; empty where it has no lines
  std::vector<double> time;        ///< s
  std::vector<double> torque;      ///< N m
  TorqueKind torque_kind{TorqueKind::commanded};
  double bandwidth{0.0};              ///< of the amplifier, Hz; 0: it follows at once
  std::size_t delay{0};               ///< samples after which a commanded torque acts; until then it is 0
  std::vector<double> angle;          ///< whole counts, or rad
  double counts_per_revolution{0.0};  ///< 0 where the angle is in rad
  std::vector<double> code;           ///< DAC codes; empty where unknown
  int dac_bits{0};                    ///< 0 where unknown
  std::vector<bool> sliding;          ///< whether the hook slid; empty where unknown
  PlantStart start;                   ///< of the contact
  bool units_known{false};            ///< in SI for certain, because this program wrote it
};

/// "NAME:LINE", or "NAME, sample K".
std::string place_of(const RawSeries& series, std::size_t sample);

/// How a table is to be understood, where it leaves a choice.
struct SeriesChoice {
  std::optional<std::string> torque;  ///< column: torque or drive_torque
  std::optional<std::string> angle;   ///< column: count or theta
  std::optional<double> counts_per_revolution;
  std::optional<double> bandwidth;  ///< Hz
  std::optional<int> delay;         ///< of the commanded torque, samples
  std::optional<int> dac_bits;
  std::optional<double> preload;    ///< N m
  std::optional<double> hardening;  ///< rad
};

/// The samples after which the series' torque acts: those chosen, `otherwise` where none are; a motor's
/// torque acts at once.
/// @throws Failure (bad_input) where a delay is chosen for the motor's torque.
std::size_t delay_of(const RawSeries& series, const SeriesChoice& choice, int otherwise);

/// A series from a table with the columns t (s), torque or drive_torque (N m), count or theta (rad); that of
/// `zerocount trace` is one. Where both torques are there, drive_torque is taken. Where both angles are
/// there, count is taken if the counts per revolution are given, theta otherwise.
/// @throws Failure: bad_input where the columns are not there, are said to have other units, or a delay is
/// chosen for the motor's torque; and what CsvTable throws.
RawSeries read_csv_series(const std::filesystem::path& path, const SeriesChoice& choice);

/// A series from the trial's records in the results file. The start of the contact, the encoder's resolution,
/// the delay and the amplifier's bandwidth are those of the trial, unless chosen otherwise. The angle is that
/// of the fine encoder's counts, unless theta is chosen.
/// @throws Failure: bad_input where the file has no such trial or no records of it, or a delay is chosen for
/// the motor's torque; and what StudyFile throws.
RawSeries read_study_series(const std::filesystem::path& path, std::int64_t point, std::int64_t index,
                            const SeriesChoice& choice);

/// The series as a record that can be fitted.
/// @param any_magnitude whether values that look as if they were in other units are believed.
/// @throws Failure (bad_data) with the reason where it cannot: see record_checks.hpp.
TestRecord checked_record(const RawSeries& series, bool any_magnitude);

}  // namespace zerocount
