// Lanes at rest: creep moves the rotor, and an oscillation has decayed or is known in closed form.
#include <algorithm>
#include <cmath>

#include "core/batch/lanes/running_batch.hpp"
#include "core/loop/formulas.hpp"

namespace zerocount::batch {
namespace {

/// The time (s) in which the rotor angle θ moves by `distance` (rad, positive) in the direction of creep;
/// infinite if it never does.
/// @param stiffness present stiffness of the spring, N m/rad; with it the result is accurate to a small
/// fraction of a sample.
double time_to_creep(const friction::CreepAtRest& creep, double distance, double stiffness) {
  // The spring stretches as the damper's torque falls, in proportion to the growth of creep.
  const double per_creep = creep.s1 * creep.g1 / stiffness;
  const double rate = friction::rate_after_creep(creep, distance / (1.0 + per_creep));
  if (!(rate > 0.0)) return HUGE_VAL;
  const double stretch =
      (friction::spring_torque_at_rate(creep, rate) - friction::spring_torque_at_rate(creep, creep.rate)) /
      stiffness;
  const double better = friction::rate_after_creep(creep, distance - stretch);
  return better > 0.0 ? friction::time_until_rate(creep, better) : HUGE_VAL;
}

double count_at(const BatchState& batch, int lane, double theta) {
  return loop::ideal_count(theta, batch.loop.resolution[lane], batch.loop.phase[lane]);
}

/// Quasi-static creep and residual oscillation of a lane at rest, from now on.
struct RestAhead {
  friction::CreepAtRest creep;
  friction::ResidualOscillation oscillation;
  double elapsed;  ///< Time since the rest began, s
};

RestAhead rest_ahead(const LanePlant::Rest& rest) {
  RestAhead ahead{rest.creep, rest.oscillation, rest.time};
  if (ahead.creep.rate > 0.0) ahead.creep.rate = friction::creep_rate_after(rest.creep, rest.time);
  return ahead;
}

/// Whether all samples may be passed over whatever the encoder reads, as in an open loop.
bool is_open(const BatchState& batch, int lane) {
  return batch.loop.quiet_to[lane] == HUGE_VAL;
}

/// Whether a sample at the rotor angle θ (rad) may be passed over, because the count is the last one and the
/// position lies within the quiet range (LoopLanes::quiet_from).
bool is_quiet(const BatchState& batch, int lane, double theta) {
  const LoopLanes& l = batch.loop;
  if (is_open(batch, lane)) return true;
  if (count_at(batch, lane, theta) != l.count[lane]) return false;
  const double within = theta / l.resolution[lane] + l.phase[lane] - l.count[lane];
  return !(within < l.quiet_from[lane]) && !(within > l.quiet_to[lane]);
}

/// A time (s) for which no sample of a lane at rest matters (LoopLanes::quiet_from): until creep plus the
/// bound of the residual oscillation reaches an edge of the count, or of the quiet positions in it. Zero if
/// the oscillation alone may reach one.
double quiet_time(const BatchState& batch, int lane, const RestAhead& rest, const LanePlant& plant) {
  const LoopLanes& l = batch.loop;
  if (is_open(batch, lane)) return HUGE_VAL;
  const double low = (l.count[lane] + l.quiet_from[lane] - l.phase[lane]) * l.resolution[lane];
  const double width = (l.quiet_to[lane] - l.quiet_from[lane]) * l.resolution[lane];
  const friction::ResidualOscillation::State& oscillation = plant.oscillation();
  const double slow_theta = plant.theta() - oscillation.elongation - oscillation.extension;
  const double above = low + width - slow_theta;
  const double below = slow_theta - low;
  double bound = friction::oscillation_bound(rest.oscillation, rest.elapsed);
  if (!(std::min(above, below) > bound)) return 0.0;
  if (rest.creep.rate <= 0.0) return HUGE_VAL;
  const double distance = rest.creep.sign > 0.0 ? above : below;
  const double stiffness = friction::stiffness_on(plant.spring().branch(), plant.spring().elongation());
  double time = time_to_creep(rest.creep, distance - bound, stiffness);
  if (bound > 0.0) {
    bound = friction::oscillation_bound(rest.oscillation, rest.elapsed + time);
    time = time_to_creep(rest.creep, distance - bound, stiffness);
  }
  return time;
}

/// The sampling instants ahead of a lane at rest; samples may be late.
struct InstantsAhead {
  double to_first;         ///< Time from now to the next sample, s
  double sample_time;      ///< Sample time T, s
  const LaneDrive* drive;  ///< Gives the lateness of each sample; null without late samples
  double max_lateness;     ///< Largest time by which a sample may be late, s
  std::int64_t first;      ///< Number of the next sample from the start of the trial

  /// Lateness δ (s) of the i-th sample from now, i ≥ 1.
  double lateness(double i) const {
    return drive ? drive->lateness(first + static_cast<std::int64_t>(i) - 1) : 0.0;
  }
  /// Time (s) to sample i + 1 from now: from sample i, or from the present instant if i = 0.
  double to_next(double i) const {
    return i == 0.0 ? to_first : sample_time + (lateness(i + 1.0) - lateness(i));
  }
  /// Time (s) from sample i, or from the present instant if i = 0, to sample i + samples.
  double to(double i, double samples) const {
    return to_next(i) + (samples - 1.0) * sample_time + (lateness(i + samples) - lateness(i + 1.0));
  }
};

/// Number of samples after the i-th sample from now (i = 0: the present instant) that can probably be passed
/// over because the count stays.
double quiet_samples(const BatchState& batch, int lane, const LanePlant& plant, const InstantsAhead& instants,
                     double i) {
  const double time = quiet_time(batch, lane, rest_ahead(*plant.rest()), plant);
  if (time == HUGE_VAL) return HUGE_VAL;
  // As if all were as late as they may be.
  const double to_first = instants.to_next(i) + (instants.max_lateness - instants.lateness(i + 1.0));
  return std::max(std::ceil((time - to_first) * batch.time.sample_rate[lane]), 0.0);
}

/// Whether the lane has not moved since its plant was last at rest.
bool is_unmoved(const BatchState& batch, int lane, const LanePlant& plant) {
  if (!plant.rest()) return false;
  const friction::PlantMotion motion = plant.motion();
  return motion.elongation == batch.motion.elongation[lane] &&
         motion.creep.extension == batch.motion.extension[lane] && !motion.sliding;
}

/// Number of samples at rest that are evaluated one by one before the slow motion is described ahead by
/// polynomials.
constexpr int samples_one_by_one = 4;
constexpr double max_span = 256.0;  // samples
constexpr double min_span = 8.0;    // fewer are not worth the description

/// Stores the cubic polynomial through the values a, b, c, d at 0, 1/3, 2/3 and 1 in the lane.
/// @returns its value at ½.
double store_cubic(Lanes (&to)[4], int lane, double a, double b, double c, double d) {
  const double first = b - a;
  const double second = (c - b) - first;
  const double third = ((d - c) - (c - b)) - second;
  // Newton's form in 3x, expanded.
  const double cubic[] = {a, 3.0 * (first - 0.5 * second + third / 3.0), 4.5 * (second - third), 4.5 * third};
  for (std::size_t i = 0; i < 4; ++i) to[i][lane] = cubic[i];
  return cubic[0] + 0.5 * (cubic[1] + 0.5 * (cubic[2] + 0.5 * cubic[3]));
}

/// The slow motion at rest by creep, without its residual oscillation.
struct SlowMotion {
  double elongation;  ///< Elongation xs of the spring, rad
  double extension;   ///< Plastic extension xp by creep, rad
  double hardening;   ///< Hardening xh by creep, rad
};

SlowMotion slow_motion(const LanePlant& plant) {
  const friction::PlantMotion motion = plant.motion();
  const LanePlant::Rest& rest = *plant.rest();
  const friction::ResidualOscillation::State& oscillation = plant.oscillation();
  return {motion.elongation - oscillation.elongation, motion.creep.extension - oscillation.extension,
          motion.creep.hardening - rest.creep.sign * oscillation.extension};
}

/// Describes the slow motion at rest over the next samples by cubic polynomials (CreepAheadLanes).
/// @returns whether they are accurate to 1e-9 count.
bool describe_ahead(BatchState& batch, int lane, LaneTrial& trial, double torque) {
  CreepAhead& ahead = trial.ahead;
  if (ahead.span < min_span) return false;
  const double duration = ahead.span * batch.time.sample_time[lane];
  LanePlant probe = *trial.plant;
  SlowMotion at[5];  // at 0, 1/3, 1/2, 2/3, 1
  at[0] = slow_motion(probe);
  constexpr double parts[] = {1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 3.0};
  for (std::size_t i = 0; i < 4; ++i) {
    probe.advance(motion::constant_torque(torque), parts[i] * duration);
    at[i + 1] = slow_motion(probe);
  }
  CreepAheadLanes& to = batch.ahead;
  const auto store = [&](Lanes(&cubic)[4], double SlowMotion::*of) {
    return store_cubic(cubic, lane, at[0].*of, at[1].*of, at[3].*of, at[4].*of);
  };
  const double missed = std::abs(store(to.elongation, &SlowMotion::elongation) - at[2].elongation) +
                        std::abs(store(to.extension, &SlowMotion::extension) - at[2].extension);
  store(to.hardening, &SlowMotion::hardening);
  // The error of a cubic grows with the fourth power of its span.
  const double allowed = 1e-9 * batch.loop.resolution[lane];
  const double factor = std::min(2.0, 0.9 * std::sqrt(std::sqrt(allowed / missed)));
  ahead.span = std::min(max_span, std::floor(ahead.span * factor));
  if (!(missed < allowed)) return false;
  const LanePlant::Rest& rest = *trial.plant->rest();
  store_constants(to.oscillation, lane,
                  static_cast<const friction::OscillationConstants<double>&>(rest.oscillation));
  to.oscillation_end[lane] = rest.oscillation.end;
  to.start[lane] = rest.time;
  to.creep_sign[lane] = rest.creep.sign;
  to.duration[lane] = duration;
  return true;
}

/// Describes the slow motion of the lane at rest from now on by polynomials, and follows it to the next stop,
/// one sample ahead.
/// @returns whether there is a description.
bool follow_ahead(RunningBatch& run, int lane, double torque) {
  BatchState& batch = run.state;
  LaneTrial& trial = run.trial_of(lane);
  bring_up_to_date(batch, lane, trial);
  if (trial.ahead.samples++ < samples_one_by_one || !describe_ahead(batch, lane, trial, torque)) return false;
  batch.motion.rest_torque[lane] = torque;
  LaneSet alone;
  alone.insert(lane);
  run.kernels.creep_ahead(batch, alone);
  return true;
}

/// Updates the measures of the lane's move by `samples` further samples with zero error and an unchanged
/// torque.
void pass_samples(BatchState& batch, int lane, double samples) {
  MeasureLanes& q = batch.measures;
  trial::ArrivalMeasures<double> arrival;
  trial::for_each_of_arrival([lane](double& to, const Lanes& from) { to = from[lane]; }, arrival, q);
  trial::measure_zeros(arrival, q.limits.dwell[lane], samples);
  trial::for_each_of_arrival([lane](Lanes& to, double from) { to[lane] = from; }, q, arrival);
}

/// Whether the lane has late samples and a torque that stays as long as its count does. The next stop of such
/// a lane is still the next sample, because the kernels know only the lateness of that sample.
bool is_late_and_steady(const RunningBatch& run, int lane) {
  return run.lanes.amplified.contains(lane) && run.state.drive.jitter[lane] > 0.0 &&
         run.state.loop.steady[lane] != 0.0 && !run.lanes.noisy.contains(lane);
}

/// The next `max_samples` sampling instants of the lane.
/// @param late drive of a lane with late samples; otherwise null.
InstantsAhead instants_ahead(const BatchState& batch, int lane, const LaneDrive* late, double max_samples) {
  const double to_last = batch.time.time_to_stop[lane];
  const double sample_time = batch.time.sample_time[lane];
  if (!late) return {to_last - (max_samples - 1.0) * sample_time, sample_time, nullptr, 0.0, 0};
  const DriveLanes& d = batch.drive;
  return {to_last, sample_time, late, d.jitter[lane], static_cast<std::int64_t>(d.sample[lane])};
}

/// Implements come_to_rest(), except that it does not update the set LaneStates::ahead.
bool rest(RunningBatch& run, int lane) {
  BatchState& batch = run.state;
  LaneTrial& trial = run.trial_of(lane);
  TimeLanes& time = batch.time;
  LanePlant& plant = *trial.plant;
  const double torque = batch.motion.torque[lane];
  if (batch.motion.rest_torque[lane] != torque) {
    if (!is_unmoved(batch, lane, plant)) load_motion(batch, lane, trial);
    plant.forget_deepest();
    motion::Load* const load = plant.load() ? &*plant.load() : nullptr;
    if (!plant.come_to_rest(torque, batch.motion.at_reversal[lane] != 0.0, load)) return false;
    trial.deepest = std::max(trial.deepest, plant.deepest());
    forget_ahead(batch, lane, trial);
  }
  const LaneDrive* const late = is_late_and_steady(run, lane) ? &*trial.drive : nullptr;
  double max_samples = time.samples_to_stop[lane];
  if (late) max_samples = std::max(batch.measures.limits.samples[lane] - batch.measures.samples[lane], 1.0);
  if (max_samples > 1.0) {
    bring_up_to_date(batch, lane, trial);
  } else if (follow_ahead(run, lane, torque)) {
    return true;
  }
  std::optional<LanePlant> before;
  if (run.observers->sample) before = plant;

  const InstantsAhead instants = instants_ahead(batch, lane, late, max_samples);
  // Advances sample by sample (i, from 1), many at once where the count surely stays the same.
  double i = 0.0;
  bool edge_is_next = false;
  const auto stays_within = [&](const LanePlant::RestPoint& point) {
    return is_quiet(batch, lane, plant.theta_at(point));
  };
  bool same = true;
  while (same && i < max_samples) {
    double ahead = 1.0;
    if (!edge_is_next && max_samples - i > 1.0)
      ahead = std::clamp(quiet_samples(batch, lane, plant, instants, i), 1.0, max_samples - i);
    LanePlant::RestPoint point = plant.point_at_rest(instants.to(i, ahead));
    // The edge may be nearer than estimated.
    for (double back = 1.0; ahead > 1.0 && !stays_within(point); back *= 2.0) {
      ahead = std::max(1.0, ahead - back);
      point = plant.point_at_rest(instants.to(i, ahead));
    }
    plant.go_to(point);
    same = is_quiet(batch, lane, plant.theta());
    edge_is_next = ahead > 1.0;
    i += ahead;
  }
  for (double j = 1.0; before && j < i; j += 1.0) {
    before->advance(motion::constant_torque(torque), instants.to_next(j - 1.0));
    report_sample_at_rest(run, lane, j, before->theta(), before->creep());
  }
  if (late) {
    batch.drive.sample[lane] += i - 1.0;
    batch.drive.late[lane] = instants.lateness(i);
  }
  if (plant.load()) motion::follow_rotor(*plant.load(), plant.omega());
  pass_samples(batch, lane, i - 1.0);
  store_motion(batch, lane, trial);
  batch.motion.rest_torque[lane] = torque;
  time.time_to_stop[lane] = 0.0;
  time.samples_to_stop[lane] = 1.0;
  return true;
}

}  // namespace

bool come_to_rest(RunningBatch& run, int lane) {
  const bool rests = rest(run, lane);
  run.lanes.ahead.erase(lane);
  if (rests && run.state.ahead.elapsed[lane] > 0.0) run.lanes.ahead.insert(lane);
  return rests;
}

void forget_ahead(BatchState& batch, int lane, LaneTrial& trial) {
  trial.ahead = {};
  batch.ahead.elapsed[lane] = batch.ahead.duration[lane] = 0.0;
}

void bring_up_to_date(BatchState& batch, int lane, LaneTrial& trial) {
  CreepAheadLanes& ahead = batch.ahead;
  if (ahead.elapsed[lane] > 0.0) {
    const double torque = trial.plant->rest()->torque;
    trial.plant->advance(motion::constant_torque(torque), ahead.elapsed[lane]);
    store_motion(batch, lane, trial);
    batch.motion.rest_torque[lane] = torque;
  }
  ahead.elapsed[lane] = ahead.duration[lane] = 0.0;
}

}  // namespace zerocount::batch
