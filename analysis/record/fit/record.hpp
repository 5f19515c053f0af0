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
  double from{0.0};  ///< Torque at the beginning of the branch, N m; 0 before the first sample.
  double to{0.0};    ///< Torque at the end of the branch, N m.
  /// True if the rotor follows the torque without oscillation: the branch has 20 samples or more, and covers
  /// at least 20 % of the torque's range.
  bool slow{false};
};

/// A part of a record with a constant torque, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};  ///< Torque during the hold, N m.
  double from{0.0};    ///< Torque 8 samples before the beginning of the hold, N m.
  /// Whether the axis still oscillates when the hold begins: the torque changed from `from` by at least 5 %
  /// of its range in the record.
  bool rings_down{false};
};

/// The parts of a record, found from its torque. Percentages are of the range of the torque.
struct RecordParts {
  /// Branches of monotonic torque, consecutive; torque reversals below 2 % of the range are ignored.
  std::vector<LoadingBranch> branches;
  std::vector<TorqueHold> holds;  ///< Holds (constant torque) of 20 samples or more.

  /// Number of torque reversals in the record.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }

  /// Number of holds that begin with an oscillation that decays (ring-down).
  std::size_t ring_downs() const;
};

/// One checked material test: the motor torque and the encoder reading at each sample. For a linear axis read
/// force for torque, position for angle, N for N m and m for rad. This holds here and for everything that is
/// fitted to the record.
struct TestRecord {
  std::string name;  ///< Name of the record in messages.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  double sample_time{5e-4};  ///< Sampling interval T, s. For uneven samples: the mean.
  double first_time{0.0};    ///< Recorded time of the first sample, s.
  /// [sample] Time to the next sample, s. Empty: the sampling interval T for each.
  std::vector<double> intervals{};
  /// [sample] Course of the torque from this sample to the next one.
  std::vector<motion::TorqueCourse> torque;
  /// Fractional part of the time by which the torque acts later than recorded, samples, in [0, 1).
  double delay_fraction{0.0};
  std::vector<double> reading;  ///< [sample] Angle at the sample, in `unit`.
  double unit{1.0};  ///< Unit of the readings, rad: the size of a count if the readings are counts.
  /// True if the readings are whole counts: the angle is somewhere in [reading, reading + 1).
  bool counted{false};
  /// [sample] Whether the reading is masked, so that the fit does not use it; empty: no reading is masked.
  std::vector<bool> excluded{};
  /// [sample] Readings as recorded. Empty if they equal `reading`. In `reading`, straight lines replace
  /// masked readings.
  std::vector<double> recorded{};
  std::string note{};        ///< Note on what was cut out of the record; empty if nothing was.
  motion::PlantStart start;  ///< State of the friction contact at the first sample.
  RecordParts parts;         ///< Branches and holds of the record, found by parts_of(); identify() sets them.
};

inline std::size_t sample_count(const TestRecord& record) {
  return record.reading.size();
}

/// Time from the sample to the next one, s: T, or for uneven sampling the recorded time.
inline double interval_after(const TestRecord& record, std::size_t sample) {
  return record.intervals.empty() ? record.sample_time : record.intervals[sample];
}

/// True if the reading of the sample is masked, so that the fit does not use it.
inline bool is_excluded(const TestRecord& record, std::size_t sample) {
  return !record.excluded.empty() && record.excluded[sample];
}

/// Number of samples of the record that are not masked.
inline std::size_t used_samples(const TestRecord& record) {
  const auto masked = std::count(record.excluded.begin(), record.excluded.end(), true);
  return sample_count(record) - static_cast<std::size_t>(masked);
}

/// Mean difference of the angle and its reading, in the record's unit: half a count for counts, otherwise 0.
inline double middle_of_reading(const TestRecord& record) {
  return record.counted ? 0.5 : 0.0;
}

inline Eigen::Map<const Eigen::VectorXd> readings_of(const TestRecord& record) {
  return {record.reading.data(), static_cast<Eigen::Index>(record.reading.size())};
}

RecordParts parts_of(const TestRecord& record);

/// True if a branch is slow and has no step of the torque, that is, no change by 5 % of the torque's range
/// from one sample to the next. Such a step occurs at the end of a hold, for example.
bool is_gradual(const TestRecord& record, const LoadingBranch& branch);

/// True if a record has a slow branch without a step of the torque (is_gradual()).
bool has_slow_branches(std::span<const TestRecord> records);

/// True if the records have slow branches without steps (is_gradual()), and no ring-downs.
bool are_slow_alone(std::span<const TestRecord> records);

/// Throws the Failure that refuses a record.
/// @param place the record's name, or a line of its file, at which the reason was found
/// @param reason reason with the words and units of any axis (parameters::text_on())
/// @throws Failure (bad_data) always
[[noreturn]] void refuse(parameters::AxisKind axis, const std::string& place, const std::string& reason);

/// Range of the torque in the record: maximum − minimum, N m.
double torque_range(const TestRecord& record);

/// Largest |torque| in the record, N m.
double largest_torque(const TestRecord& record);

/// Simulated angle and velocity of a record at every sample.
struct SampledPath {
  Eigen::VectorXd angle;     ///< [sample] Angle, in the record's unit.
  Eigen::VectorXd velocity;  ///< [sample] Velocity, in the record's unit per sample.
};

/// Limits of long simulation steps over several samples, in a long hold of an evenly sampled record, where
/// only creep moves the rotor. By default there are no such steps.
struct LongSteps {
  /// Time after the last change of the torque from which on long steps are taken, s.
  double settled_after{1e9};
  double longest{0.0};  ///< Longest simulation step, s.
};

/// Simulates the motion of a plant along a record, and returns it at every sample.
///
/// The torque acts later than recorded by `offset` and the record's delay_fraction, in samples; for uneven
/// sampling, in mean intervals. This is equivalent to readings that are earlier by the same time: a fraction
/// of a sample places each reading between two changes of the torque. Before the first torque the rotor
/// rests; after the last one the torque stays.
SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps = {});

}  // namespace zerocount::fit
