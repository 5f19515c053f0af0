// The sampling instants of the lanes.
#include <algorithm>
#include <cmath>

#include "core/batch/lane_work.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::batch {

/// Puts the lanes at a sampling instant into the list, and says how many.
int LaneWork::list_due_lanes() {
  int count = 0;
  for (int lane = 0; lane < lane_count_; ++lane) {
    list_[count] = lane;
    count += tile_.time.until[lane] == 0.0 && states_[lane] != LaneState::idle ? 1 : 0;
  }
  return count;
}

void LaneWork::take_samples() {
  const int due = list_due_lanes();
  int count = 0;
  for (int i = 0; i < due; ++i) {
    const int lane = list_[i];
    if (tile_.measures.taken[lane] == tile_.measures.limits.samples[lane]) {
      end_move(lane, trial_of(lane));
      if (state_of(lane) == LaneState::idle) continue;
    }
    list_[count++] = lane;
  }
  if (count == 0) return;
  kernels_.sample(tile_, {list_, count});
  for (int i = 0; i < tile_.noted_count; ++i) {
    const int lane = tile_.noted[i];
    if ((tile_.note[lane] & beyond_kernel) == 0) continue;
    tile_.note[lane] = no_note;
    tile_.measures.taken[lane] -= 1.0;  // no encoder could count that
    give_up(lane);
  }
  if (observers_->sample) {
    for (int i = 0; i < count; ++i) {
      const int lane = list_[i];
      const bool given_up = state_of(lane) == LaneState::idle || tile_.measures.taken[lane] == 0.0;
      if (!given_up) record_sample(lane, trial_of(lane));
    }
  }
  for (int i = 0; i < tile_.noted_count; ++i) {
    const int lane = tile_.noted[i];
    const int note = tile_.note[lane];
    LaneTrial& trial = trial_of(lane);
    if ((note & jerk_changes) != 0) track_jerk(lane, trial);
    if ((note & count_changes) != 0) follow_last_half(lane, trial);
    if ((note & delayed) != 0) delay_torque(lane, trial);
    if ((note & diverges) != 0) stop_diverged(lane, trial);
  }
}

void LaneWork::record_sample(int lane, const LaneTrial& trial) {
  const auto k = static_cast<std::int64_t>(tile_.measures.taken[lane]) - 1;
  observers_->sample({trial.number, trial.first_sample + k, static_cast<std::int64_t>(tile_.loop.count[lane]),
                      static_cast<std::int64_t>(tile_.loop.code[lane]), tile_.measures.theta[lane],
                      tile_.measures.extension[lane], tile_.motion.hardening[lane]});
}

/// The samples that steps have gone over, from their series.
void LaneWork::record_passed() {
  for (int i = 0; i < tile_.passed_count; ++i) {
    const PassedSamples& p = passed_[i];
    const LaneTrial& trial = trial_of(p.lane);
    const double sample_time = tile_.time.sample_time[p.lane];
    const double rate = tile_.time.sample_rate[p.lane];
    const auto taken = static_cast<std::int64_t>(tile_.measures.taken[p.lane] - p.samples);
    // The stop is `whole` samples after the first.
    const double whole = std::ceil(p.until * rate - 1e-9) - 1.0;
    for (int j = 0; j < static_cast<int>(p.samples); ++j) {
      const double x = (p.until - (whole - j) * sample_time) / p.step;
      const double extension =
          tile_.motion.extension[p.lane] + (value_at(p.growth, x) - value_at(p.growth, p.end));
      observers_->sample({trial.number, trial.first_sample + taken + j,
                          static_cast<std::int64_t>(tile_.loop.count[p.lane]),
                          static_cast<std::int64_t>(tile_.loop.code[p.lane]),
                          tile_.motion.hook[p.lane] + value_at(p.elongation, x) + extension, extension,
                          std::abs(value_at(p.growth, x))});
    }
  }
}

void LaneWork::follow_last_half(int lane, LaneTrial& trial) {
  const MeasureLanes& q = tile_.measures;
  const auto k = static_cast<std::int64_t>(q.taken[lane]) - 1;
  const auto count = static_cast<std::int64_t>(tile_.loop.count[lane]);
  const auto change = static_cast<std::int64_t>(q.change[lane]);
  const bool first = k == static_cast<std::int64_t>(q.last_half[lane]);
  trial.last_half.add(k, first ? count : count - change, count);
}

void LaneWork::track_jerk(int lane, LaneTrial& trial) {
  const auto k = static_cast<std::int64_t>(tile_.measures.taken[lane]) - 1;
  if (trial.jerks.add(k, static_cast<std::int64_t>(tile_.loop.error[lane]))) tell_jerk(trial);
  tile_.measures.in_jerk[lane] = trial.jerks.lasts() ? 1.0 : 0.0;
}

void LaneWork::tell_jerk(LaneTrial& trial) {
  ++trial.told_jerks;
  if (observers_->jerk) observers_->jerk(trial.number, trial.jerks.last());
}

/// The torque that comes through the delay now. It stays as long as the decided one only where all that wait
/// are alike.
void LaneWork::delay_torque(int lane, LaneTrial& trial) {
  const double decided = tile_.motion.torque[lane];
  const std::size_t size = trial.waiting.size();
  const double newest = trial.waiting[(trial.oldest_waiting + size - 1) % size];
  trial.waiting_alike = decided == newest ? trial.waiting_alike + 1 : 1;
  tile_.motion.torque[lane] = trial.waiting[trial.oldest_waiting];
  trial.waiting[trial.oldest_waiting] = decided;
  trial.oldest_waiting = (trial.oldest_waiting + 1) % size;
  if (trial.waiting_alike <= static_cast<std::int64_t>(size)) {
    tile_.time.samples_left[lane] = 1.0;
    tile_.time.until[lane] = tile_.time.sample_time[lane];
  }
}

}  // namespace zerocount::batch
