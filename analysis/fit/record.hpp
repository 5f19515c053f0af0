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

/// A part with a monotonic torque, from sample `first` to sample `last`.
struct LoadingBranch {
  std::size_t first{0};
  std::size_t last{0};
  double from{0.0};  ///< N m; 0 before the first sample
  double to{0.0};    ///< N m
  /// True if the rotor follows without oscillation: 20 samples or more, over at least 20 % of the range.
  bool slow{false};
};

/// A part with a constant torque, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};      ///< N m
  double from{0.0};        ///< torque 8 samples before the hold, N m
  bool rings_down{false};  ///< begins with a ring-down: the torque changed by 5 % of the range since `from`
};

/// The parts of a record, found from its torque. Percentages are of the range of the torque.
struct RecordParts {
  std::vector<LoadingBranch> branches;  ///< consecutive; torque reversals below 2 % of the range are ignored
  std::vector<TorqueHold> holds;        ///< of 20 samples or more

  /// Number of torque reversals.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }

  /// Number of holds that begin with a ring-down.
  std::size_t ring_downs() const;
};

/// One checked material test: the motor torque and the encoder reading at each sample. Of a linear axis read
/// force for torque and position for angle, N for N m and m for rad, here and in all that is fitted to it.
struct TestRecord {
  std::string name;  ///< name in messages
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  double sample_time{5e-4};                  ///< T, s; of uneven samples the mean
  double first_time{0.0};                    ///< of the first sample, as recorded, s
  std::vector<double> intervals{};           ///< [sample] until the next one, s; empty: T each
  std::vector<motion::TorqueCourse> torque;  ///< [sample] from t_k to t_{k+1}
  /// Samples by which the torque acts later than at its sample, from 0 to below 1: the fraction of a delay.
  double delay_fraction{0.0};
  std::vector<double> reading;  ///< [sample] angle at t_k, in `unit`
  double unit{1.0};             ///< of the readings, rad; for counts one count
  /// True if the readings are whole counts: the angle is somewhere in [reading, reading + 1).
  bool counted{false};
  std::vector<bool> excluded{};  ///< [sample] masked readings; empty: none
  /// [sample] The readings as recorded; empty: as `reading`, which has straight lines in place of masked
  /// ones.
  std::vector<double> recorded{};
  std::string note{};        ///< what was cut out of it; empty: nothing
  motion::PlantStart start;  ///< state of the contact at the first sample
  RecordParts parts;         ///< parts_of() the record, which identify() sets
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
  double settled_after{1e9};  ///< time after the last change of the torque from which they are taken, s
  double longest{0.0};        ///< s
};

/// The motion of a plant along a record, at every sample.
///
/// The torque acts `offset` samples later than recorded, and later by the record's delay_fraction; of uneven
/// samples, so many mean intervals. That is the same as readings so much earlier: a fraction of a sample
/// places each reading between two changes of the torque. Before its first torque the rotor rests; after the
/// last one the torque stays.
SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps = {});

}  // namespace zerocount::fit
