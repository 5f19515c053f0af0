#include "analysis/record/fit/record.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/failure/failure.hpp"

namespace zerocount::fit {
namespace {

constexpr double reversal_threshold = 0.02;   // fraction of the range
constexpr double hold_tolerance = 1e-3;       // fraction of the range
constexpr double step_threshold = 0.05;       // fraction of the range
constexpr double slow_threshold = 0.2;        // fraction of the range
constexpr std::size_t min_part_samples = 20;  // for a hold and for a slow branch
constexpr std::size_t step_samples = 8;

/// The torque at the beginning of a sample interval, N m; 0 before the first sample.
double torque_at(const TestRecord& record, std::ptrdiff_t sample) {
  return sample < 0 ? 0.0 : record.torque[static_cast<std::size_t>(sample)].now;
}

/// The branches of a record: its parts between turning points of the torque. A turning point is an extreme
/// after which the torque returns by more than a threshold.
/// @param range range of the torque, of which the threshold is a fraction
std::vector<LoadingBranch> branches_of(const TestRecord& record, double range) {
  const double threshold = reversal_threshold * range;
  std::vector<LoadingBranch> branches;
  LoadingBranch branch;  // from the last turning point to the extreme torque since then
  int direction = 0;
  for (std::size_t k = 0; k < record.torque.size(); ++k) {
    const double torque = record.torque[k].now;
    const double change = torque - branch.to;
    if (direction == 0) {
      if (std::abs(torque - branch.from) > threshold) direction = torque > branch.from ? 1 : -1;
      branch.last = k;
      branch.to = torque;
    } else if (change * direction >= 0.0) {
      if (change != 0.0) branch.last = k;
      branch.to = torque;
    } else if (std::abs(change) > threshold) {
      branches.push_back(branch);
      branch = {branch.last, k, branch.to, torque};
      direction = -direction;
    }
  }
  if (direction != 0) branches.push_back(branch);
  for (LoadingBranch& one : branches)
    one.slow =
        one.last - one.first >= min_part_samples && std::abs(one.to - one.from) >= slow_threshold * range;
  return branches;
}

std::vector<TorqueHold> holds_of(const TestRecord& record, double range) {
  std::vector<TorqueHold> holds;
  const std::size_t samples = record.torque.size();
  for (std::size_t first = 0; first < samples;) {
    const double torque = record.torque[first].now;
    std::size_t end = first + 1;
    while (end < samples && std::abs(record.torque[end].now - torque) <= hold_tolerance * range) ++end;
    if (end - first >= min_part_samples) {
      const auto before = static_cast<std::ptrdiff_t>(first) - static_cast<std::ptrdiff_t>(step_samples);
      const double from = torque_at(record, before);
      holds.push_back({first, end - 1, torque, from, std::abs(torque - from) >= step_threshold * range});
    }
    first = end;
  }
  return holds;
}

}  // namespace

void refuse(parameters::AxisKind axis, const std::string& place, const std::string& reason) {
  throw Failure(ExitCode::bad_data, place + ": " + parameters::text_on(axis, reason));
}

double torque_range(const TestRecord& record) {
  double low = 0.0;  // the torque before the first sample
  double high = 0.0;
  for (const motion::TorqueCourse& torque : record.torque) {
    low = std::min(low, torque.now);
    high = std::max(high, torque.now);
  }
  return high - low;
}

double largest_torque(const TestRecord& record) {
  double largest = 0.0;
  for (const motion::TorqueCourse& torque : record.torque) largest = std::max(largest, std::abs(torque.now));
  return largest;
}

bool is_gradual(const TestRecord& record, const LoadingBranch& branch) {
  if (!branch.slow) return false;
  const double step = step_threshold * torque_range(record);
  for (std::size_t k = branch.first + 1; k <= branch.last; ++k) {
    if (std::abs(record.torque[k].now - record.torque[k - 1].now) >= step) return false;
  }
  return true;
}

bool has_slow_branches(std::span<const TestRecord> records) {
  return std::any_of(records.begin(), records.end(), [](const TestRecord& record) {
    return std::any_of(record.parts.branches.begin(), record.parts.branches.end(),
                       [&](const LoadingBranch& branch) { return is_gradual(record, branch); });
  });
}

bool are_slow_alone(std::span<const TestRecord> records) {
  return has_slow_branches(records) &&
         std::none_of(records.begin(), records.end(),
                      [](const TestRecord& record) { return record.parts.ring_downs() > 0; });
}

RecordParts parts_of(const TestRecord& record) {
  const double range = torque_range(record);
  return {branches_of(record, range), holds_of(record, range)};
}

std::size_t RecordParts::ring_downs() const {
  return static_cast<std::size_t>(
      std::count_if(holds.begin(), holds.end(), std::mem_fn(&TorqueHold::rings_down)));
}

}  // namespace zerocount::fit
