#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/motion/plant_start.hpp"
#include "core/motion/torque_course.hpp"

namespace zerocount::identification {

/// One checked material test: the motor torque and the encoder reading at each sample.
struct TestRecord {
  std::string name;                          ///< name in messages
  double sample_time{5e-4};                  ///< T, s
  std::vector<motion::TorqueCourse> torque;  ///< [sample] from t_k to t_{k+1}
  std::vector<double> reading;               ///< [sample] angle at t_k, in `unit`
  double unit{1.0};                          ///< of the readings, rad; for counts one count
  /// Whether the readings are whole counts: the angle is somewhere in [reading, reading + 1).
  bool counted{false};
  bool units_believed{false};  ///< skips the checks of magnitudes
  motion::PlantStart start;    ///< state of the contact at the first sample
};

inline std::size_t sample_count(const TestRecord& record) {
  return record.reading.size();
}

inline Eigen::Map<const Eigen::VectorXd> readings_of(const TestRecord& record) {
  return {record.reading.data(), static_cast<Eigen::Index>(record.reading.size())};
}

/// Mean distance of the angle from its reading, in the record's unit: half a count, or 0 without counts.
inline double middle_of_reading(const TestRecord& record) {
  return record.counted ? 0.5 : 0.0;
}

/// Maximum − minimum torque, N m.
double torque_range(const TestRecord& record);

/// Maximum |torque|, N m.
double largest_torque(const TestRecord& record);

}  // namespace zerocount::identification
