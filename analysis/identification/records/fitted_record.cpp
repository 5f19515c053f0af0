#include "analysis/identification/records/fitted_record.hpp"

namespace zerocount::identification {

FittedRecord fitted_record(const TestRecord& record, const Eigen::VectorXd& path) {
  const std::size_t samples = sample_count(record);
  FittedRecord beside;
  beside.reading = record.recorded.empty() ? record.reading : record.recorded;
  double since_first = 0.0;  // of uneven samples, s
  for (std::size_t k = 0; k < samples; ++k) {
    // A product, because a sum of equal intervals drifts by rounding.
    beside.time.push_back(record.first_time + (record.intervals.empty()
                                                   ? static_cast<double>(k) * record.sample_time
                                                   : since_first));
    since_first += interval_after(record, k);
    beside.torque.push_back(record.torque[k].now);
    beside.fitted.push_back(path[static_cast<Eigen::Index>(k)] - middle_of_reading(record));
    beside.excluded.push_back(is_excluded(record, k));
  }
  return beside;
}

}  // namespace zerocount::identification
