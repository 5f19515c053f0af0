#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/motion/plant_start.hpp"
#include "core/motion/torque_course.hpp"

namespace zerocount {

/// One material test, checked and ready for identification: what the motor did to the rotor, sample by
/// sample, and what the encoder said.
struct TestRecord {
  std::string name;                  ///< as messages call it
  double sample_time{5e-4};          ///< T, s
  std::vector<TorqueCourse> torque;  ///< [sample] from t_k to t_{k+1}
  std::vector<double> reading;       ///< [sample] angle at t_k, in `unit`
  double unit{1.0};                  ///< of the readings, rad: a count, where they are counts
  /// Whether the readings are whole counts, so that the rotor is anywhere in [reading, reading + 1).
  bool counted{false};
  bool units_believed{false};  ///< whatever the magnitudes that come of them
  PlantStart start;            ///< what is known of the contact at the first sample
};

inline std::size_t sample_count(const TestRecord& record) {
  return record.reading.size();
}

/// Largest less smallest torque, N m.
double torque_range(const TestRecord& record);

/// Largest magnitude of the torque, N m.
double largest_torque(const TestRecord& record);

}  // namespace zerocount
