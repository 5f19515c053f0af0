#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/motion/parameters.hpp"
#include "core/motion/torque_course.hpp"
#include "core/plant/plant.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::fit {

/// A part of a record with a monotonic torque, from sample `first` to sample `last`.
struct LoadingBranch {
  std::size_t first{0};
  std::size_t last{0};
  double from{0.0};  ///< Torque at the beginning, N m; 0 before the first sample.
  double to{0.0};    ///< Torque at the end, N m.
  /// True if the rotor follows without oscillation: 20 samples or more, over at least 20 % of the range.
  bool slow{false};
};

/// A part of a record with a constant torque, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};  ///< Torque during the hold, N m.
  double from{0.0};    ///< Torque 8 samples before the hold, N m.
  /// Whether the axis still oscillates when the hold begins: the torque changed from `from` by at least 5 %
  /// of its range in the record.
  bool rings_down{false};
};

/// The parts of a record, found from its torque. Percentages are of the range of the torque.
struct RecordParts {
  std::vector<LoadingBranch> branches;  ///< consecutive; torque reversals below 2 % of the range are ignored
  std::vector<TorqueHold> holds;        ///< Holds of 20 samples or more.

  /// Number of torque reversals.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }

  /// Number of holds that begin with a ring-down.
  std::size_t ring_downs() const;
};

/// One checked material test: the motor torque and the encoder reading at each sample. For a linear axis read
/// force for torque, position for angle, N for N m and m for rad. This holds here and for everything that is
/// fitted to the record.
struct TestRecord {
  std::string name;  ///< name in messages
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  double sample_time{5e-4};                  ///< Sampling interval T, s. For uneven samples: the mean.
  double first_time{0.0};                    ///< Recorded time of the first sample, s.
  std::vector<double> intervals{};           ///< [sample] Time to the next sample, s. Empty: T for each.
  std::vector<motion::TorqueCourse> torque;  ///< [sample] Torque from t_k to t_{k+1}.
  /// Fractional part of the torque's delay, samples, in [0, 1).
  double delay_fraction{0.0};
  std::vector<double> reading;  ///< [sample] angle at t_k, in `unit`
  double unit{1.0};             ///< Unit of the readings, rad: the size of a count if they are counts.
  /// True if the readings are whole counts: the angle is somewhere in [reading, reading + 1).
  bool counted{false};
  std::vector<bool> excluded{};  ///< [sample] masked readings; empty: none
  /// [sample] Readings as recorded. Empty if they equal `reading`. In `reading`, straight lines replace
  /// masked readings.
  std::vector<double> recorded{};
  std::string note{};        ///< Note on what was cut out of the record; empty if nothing was.
  motion::PlantStart start;  ///< state of the contact at the first sample
  RecordParts parts;         ///< Parts found by parts_of(); identify() sets them.
};

inline std::size_t sample_count(const TestRecord& record) {
  return record.reading.size();
}

/// Time from a sample to the next one, s.
inline double interval_after(const TestRecord& record, std::size_t sample) {
  return record.intervals.empty() ? record.sample_time : record.intervals[sample];
}

/// True if the reading of a sample is masked.
inline bool is_excluded(const TestRecord& record, std::size_t sample) {
  return !record.excluded.empty() && record.excluded[sample];
}

/// Number of samples that are not masked.
inline std::size_t used_samples(const TestRecord& record) {
  const auto masked = std::count(record.excluded.begin(), record.excluded.end(), true);
  return sample_count(record) - static_cast<std::size_t>(masked);
}

/// Mean distance of the angle from its reading, in the record's unit: half a count, or 0 without counts.
inline double middle_of_reading(const TestRecord& record) {
  return record.counted ? 0.5 : 0.0;
}

inline Eigen::Map<const Eigen::VectorXd> readings_of(const TestRecord& record) {
  return {record.reading.data(), static_cast<Eigen::Index>(record.reading.size())};
}

RecordParts parts_of(const TestRecord& record);

/// True if a branch is slow and has no step (of 5 % of the range from sample to sample), such as at the end
/// of a hold.
bool is_gradual(const TestRecord& record, const LoadingBranch& branch);

/// True if a record has a gradual branch.
bool has_slow_branches(std::span<const TestRecord> records);

/// True if the records have gradual branches and no ring-downs.
bool are_slow_alone(std::span<const TestRecord> records);

/// Refuses a record.
/// @param place of the reason: the record's name, or a line of its file
/// @param reason with the words and units of any axis (parameters::text_on())
/// @throws Failure (bad_data)
[[noreturn]] void refuse(parameters::AxisKind axis, const std::string& place, const std::string& reason);

/// Maximum − minimum torque, N m.
double torque_range(const TestRecord& record);

/// Maximum |torque|, N m.
double largest_torque(const TestRecord& record);

/// The path of a record and its velocity.
struct SampledPath {
  Eigen::VectorXd angle;     ///< [sample] in the record's unit
  Eigen::VectorXd velocity;  ///< [sample] in units per sample
};

/// Steps of several samples in a long hold of an evenly sampled record, where only creep moves the rotor. By
/// default there are none.
struct LongSteps {
  /// Time after the last change of the torque from which long steps are taken, s.
  double settled_after{1e9};
  double longest{0.0};  ///< Longest step, s.
};

/// The motion of a plant along a record, at every sample.
///
/// The torque acts later than recorded by `offset` and the record's delay_fraction, in samples; for uneven
/// samples, in mean intervals. This is equivalent to readings that are earlier by the same time: a fraction
/// of a sample places each reading between two changes of the torque. Before the first torque the rotor
/// rests; after the last one the torque stays.
SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps = {});

}  // namespace zerocount::fit
