// Reports to the observers of a batch.
#include <cmath>

#include "core/batch/lanes/running_batch.hpp"
#include "core/loop/formulas.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::batch {
namespace {

/// Sets the rotor angle θ in the record of a sample that was passed over. In an open loop the count is
/// computed from it.
void set_passed_theta(RunningBatch& run, int lane, double theta, BatchSample& sample) {
  const LoopLanes& l = run.state.loop;
  sample.theta = theta;
  const LaneTrial& trial = run.trial_of(lane);
  if (trial.loop && trial.loop->is_open())
    sample.count = static_cast<std::int64_t>(loop::ideal_count(theta, l.resolution[lane], l.phase[lane]));
}

/// Record of sample `k` of the present move, with the count and the code of the last sample.
BatchSample present_sample(RunningBatch& run, int lane, std::int64_t k) {
  const LaneTrial& trial = run.trial_of(lane);
  BatchSample sample;
  sample.trial = trial.number;
  sample.k = trial.first_sample + k;
  sample.count = static_cast<std::int64_t>(run.state.loop.count[lane]);
  sample.code = static_cast<std::int64_t>(run.state.loop.code[lane]);
  return sample;
}

}  // namespace

void report_jerk(RunningBatch& run, LaneTrial& trial) {
  ++trial.reported_jerks;
  if (run.observers->jerk) run.observers->jerk(trial.number, trial.jerks.last());
}

void report_sample(RunningBatch& run, int lane) {
  const LaneTrial& trial = run.trial_of(lane);
  BatchSample sample = present_sample(run, lane, run.samples_of(lane) - 1);
  if (trial.loop) sample.count += trial.loop->reference_offset();
  sample.theta = run.state.measures.theta[lane];
  sample.xp = run.state.measures.extension[lane];
  sample.xh = run.state.motion.hardening[lane];
  run.observers->sample(sample);
}

void report_passed_samples(RunningBatch& run) {
  const TimeLanes& time = run.state.time;
  const MotionLanes& m = run.state.motion;
  for (int i = 0; i < run.state.passed_count; ++i) {
    const PassedSamples& p = run.passed_samples[i];
    const std::int64_t first = run.samples_of(p.lane) - static_cast<std::int64_t>(p.samples);
    // The stop is `whole` samples after the first.
    const double whole = std::ceil(p.time_to_stop * time.sample_rate[p.lane] - 1e-9) - 1.0;
    for (int j = 0; j < static_cast<int>(p.samples); ++j) {
      const double x = (p.time_to_stop - (whole - j) * time.sample_time[p.lane]) / p.step;
      BatchSample sample = present_sample(run, p.lane, first + j);
      sample.xp = m.extension[p.lane] + (numerics::value_at(p.creep, x) - numerics::value_at(p.creep, p.end));
      set_passed_theta(run, p.lane, m.hook[p.lane] + numerics::value_at(p.elongation, x) + sample.xp, sample);
      sample.xh = std::abs(numerics::value_at(p.creep, x));
      run.observers->sample(sample);
    }
  }
}

void report_passed_at_rest(RunningBatch& run, const LaneSet& lanes) {
  const MotionLanes& m = run.state.motion;
  for_each_lane(lanes, [&](int lane) {
    if (run.state.time.time_to_stop[lane] == 0.0) return;
    report_sample_at_rest(run, lane, 0.0, theta_of(run.state, lane), {m.extension[lane], m.hardening[lane]});
  });
}

void report_sample_at_rest(RunningBatch& run, int lane, double passed, double theta,
                           const friction::CreepState& creep) {
  BatchSample sample =
      present_sample(run, lane, run.samples_of(lane) - 1 + static_cast<std::int64_t>(passed));
  set_passed_theta(run, lane, theta, sample);
  sample.xp = creep.extension;
  sample.xh = creep.hardening;
  run.observers->sample(sample);
}

}  // namespace zerocount::batch
