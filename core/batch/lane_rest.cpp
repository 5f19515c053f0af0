#include "core/batch/lane_rest.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::batch {
namespace {

/// The time (s) at which θ has moved by `distance` (rad, positive) in the direction of creep; infinite where
/// it never does. By the stiffness (N m/rad) that the spring has now: good to a small part of a sample.
double time_to_creep(const CreepAtRest& creep, double distance, double stiffness) {
  // What the spring gives way as the damper's torque falls comes to what has crept.
  const double per_creep = creep.s1 * creep.g1 / stiffness;
  const double rate = rate_after_creep(creep, distance / (1.0 + per_creep));
  if (!(rate > 0.0)) return HUGE_VAL;
  const double stretch =
      (spring_torque_at_rate(creep, rate) - spring_torque_at_rate(creep, creep.rate)) / stiffness;
  const double better = rate_after_creep(creep, distance - stretch);
  return better > 0.0 ? time_until_rate(creep, better) : HUGE_VAL;
}

double count_at(const Tile& tile, int lane, double theta) {
  return std::floor(theta / tile.loop.resolution[lane] + tile.loop.phase[lane]);
}

/// The number of samples, from the last processed one, after which the count is likely to be another.
double samples_to_edge(const Tile& tile, int lane, const CreepAtRest& creep, const Plant& plant,
                       double to_first) {
  const LoopLanes& l = tile.loop;
  const double most = tile.time.samples_left[lane];
  if (creep.rate <= 0.0) return most;
  const double edge = (l.count[lane] + (creep.sign > 0.0 ? 1.0 : 0.0) - l.phase[lane]) * l.resolution[lane];
  const double distance = creep.sign * (edge - plant.theta());
  const double stiffness = stiffness_on(plant.spring().branch(), plant.spring().elongation());
  const double time = distance > 0.0 ? time_to_creep(creep, distance, stiffness) : 0.0;
  const double after_first = std::ceil((time - to_first) * tile.time.sample_rate[lane]);
  return std::clamp(1.0 + after_first, 1.0, most);
}

}  // namespace

void pass_samples(Tile& tile, int lane, double samples) {
  MeasureLanes& q = tile.measures;
  if (q.arrived[lane] == 0.0 && samples > 0.0 && q.zeros_in_a_row[lane] + samples >= q.dwell[lane]) {
    q.arrived[lane] = 1.0;
    q.arrival[lane] = q.taken[lane] - q.zeros_in_a_row[lane];
  }
  q.zeros_in_a_row[lane] += samples;
  q.taken[lane] += samples;
}

bool rest(Tile& tile, int lane, LaneTrial& trial, const PassedSample& passed) {
  TimeLanes& time = tile.time;
  load_motion(tile, lane, trial);
  Plant& plant = *trial.plant;
  const double torque = tile.motion.torque[lane];
  plant.forget_deepest();
  const std::optional<CreepAtRest> creep = plant.come_to_rest(torque);
  if (!creep) return false;
  trial.deepest = std::max(trial.deepest, plant.deepest());
  const PlantMotion start = plant.motion();
  Plant before = passed ? plant : Plant({}, {}, {}, {});

  const double most = time.samples_left[lane];
  const double sample_time = time.sample_time[lane];
  const double to_first = time.until[lane] - (most - 1.0) * sample_time;
  const double count = tile.loop.count[lane];
  // Sample i, counted from 1: most of the way at once, and the last steps one by one, as the encoder sees
  // them.
  double i = std::max(samples_to_edge(tile, lane, *creep, plant, to_first) - 1.0, 1.0);
  plant.advance(constant_torque(torque), to_first + (i - 1.0) * sample_time);
  if (i > 1.0 && count_at(tile, lane, plant.theta()) != count) {
    // Nearer than thought: once more, sample by sample.
    plant.set_motion(start);
    plant.come_to_rest(torque);
    i = 1.0;
    plant.advance(constant_torque(torque), to_first);
  }
  while (i < most && count_at(tile, lane, plant.theta()) == count) {
    i += 1.0;
    plant.advance(constant_torque(torque), sample_time);
  }
  if (passed) {
    for (double j = 1.0; j < i; j += 1.0) {
      before.advance(constant_torque(torque), j == 1.0 ? to_first : sample_time);
      passed(j, before.theta(), before.creep());
    }
  }
  pass_samples(tile, lane, i - 1.0);
  store_motion(tile, lane, trial);
  time.until[lane] = 0.0;
  time.samples_left[lane] = 1.0;
  return true;
}

}  // namespace zerocount::batch
