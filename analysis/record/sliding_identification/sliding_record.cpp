#include "analysis/record/sliding_identification/sliding_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <ceres/autodiff_cost_function.h>
#include <fmt/format.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/records/checked_record.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr std::size_t smoothing_samples = 5;
constexpr double min_steps_per_span = 3.0;
constexpr double min_window_steps = 50.0;
constexpr std::size_t min_stroke_samples = 20;

/// Smallest difference of two readings that is not 0: the step of the encoder, rad or m.
/// @param position [sample] readings
double min_step(const std::vector<double>& position) {
  double least = 0.0;
  double largest = 0.0;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double step = std::abs(position[k] - position[k - 1]);
    largest = std::max(largest, step);
    if (step > 0.0 && (least == 0.0 || step < least)) least = step;
  }
  constexpr double rounding = 1e-6;  // of written numbers: differences that small are none of an encoder
  return least > rounding * largest ? least : 0.0;
}

/// Standard deviation of the errors of the readings, if these are independent, rad or m. It comes from third
/// differences, which smooth motion hardly contributes to (the sum of their squared weights is 20); by the
/// median, which single jerks do not move.
double noise_of(const std::vector<double>& position) {
  std::vector<double> differences;
  for (std::size_t k = 3; k < position.size(); ++k) {
    differences.push_back(
        std::abs(position[k] - 3.0 * position[k - 1] + 3.0 * position[k - 2] - position[k - 3]));
  }
  constexpr double median_of_normal = 0.6745;
  return statistics::upper_median(std::move(differences)) / (median_of_normal * std::sqrt(20.0));
}

/// True if the axis stops within the samples around `k`, in which it moves by `moved` (rad or m): between
/// neighbours it moves by less than half of the mean velocity.
bool stops_at(const SlidingRecord& record, std::size_t k, double moved) {
  constexpr double visible = 10.0;  // steps: where there are fewer, readings that stay are none of a stop
  constexpr double slow = 0.1;      // of what it moves over ten samples, in two
  const double here = std::abs(record.position[k + 1] - record.position[k - 1]);
  return moved >= visible * record.resolution && here < slow * moved;
}

double travel_of(const SlidingRecord& record, const Window& part) {
  return std::abs(record.position[part.last] - record.position[part.first]);
}

/// [sample] Direction of the motion: −1 or 1; 0 where the axis rests, is too slow to tell, sticks, or the
/// reading is masked.
std::vector<int> directions_of(const SlidingRecord& record, const records::RawSeries& series) {
  std::vector<int> direction(record.position.size(), 0);
  const std::size_t h = record.smoothing;
  for (std::size_t k = h; k + h < record.position.size(); ++k) {
    const double moved = record.position[k + h] - record.position[k - h];
    if (std::abs(moved) < min_steps_per_span * record.resolution) continue;
    if (stops_at(record, k, std::abs(moved))) continue;
    if (!series.excluded.empty() && series.excluded[k]) continue;
    if (!series.sliding.empty() && !series.sliding[k]) continue;
    direction[k] = moved > 0.0 ? 1 : -1;
  }
  return direction;
}

/// The motions in one direction (runs of samples), each from a standstill or a reversal to the next.
std::vector<Window> runs_of(const std::vector<int>& direction) {
  std::vector<Window> runs;
  for (std::size_t from = 0, end = 0; from < direction.size(); from = end) {
    while (end < direction.size() && direction[end] == direction[from]) ++end;
    if (direction[from] != 0) runs.push_back({from, end - 1, 0, static_cast<double>(direction[from])});
  }
  return runs;
}

void find_strokes(SlidingRecord& record, const std::vector<Window>& runs) {
  for (const Window& run : runs) {
    Window stroke = run;
    stroke.first += record.smoothing;
    stroke.last -= std::min(stroke.last, record.smoothing);
    const auto slides = [&](std::size_t k) {
      return std::abs(record.position[k] - record.position[run.first]) > record.presliding_travel;
    };
    while (stroke.first < stroke.last && !slides(stroke.first)) ++stroke.first;
    stroke.stroke = record.strokes.size();
    if (stroke.first + min_stroke_samples <= stroke.last + 1 &&
        travel_of(record, stroke) >= min_window_steps * record.resolution)
      record.strokes.push_back(stroke);
  }
}

void set_velocities(SlidingRecord& record) {
  const std::size_t h = record.smoothing;
  record.velocity.assign(record.position.size(), 0.0);
  for (std::size_t k = h; k + h < record.position.size(); ++k) {
    record.velocity[k] =
        (record.position[k + h] - record.position[k - h]) / (record.time[k + h] - record.time[k - h]);
    record.max_velocity = std::max(record.max_velocity, std::abs(record.velocity[k]));
  }
}

}  // namespace

SlidingRecord sliding_record(const records::RawSeries& series, double pitch) {
  fit::TestRecord sampled;
  sampled.sample_time = fit::checked_sample_time(series);
  sampled.intervals = fit::uneven_intervals(series);
  fit::check_jumps(series);
  SlidingRecord record;
  record.name = series.name;
  record.axis = fit::axis_of(series);
  record.torque = fit::courses_of(series, sampled);
  record.smoothing = smoothing_samples;
  record.delay = series.delay;
  const double unit = series.count_size > 0.0 ? series.count_size : 1.0;
  record.origin = unit * series.angle.front();
  record.pitch = series.linear ? pitch : 2.0 * std::numbers::pi;
  double now = 0.0;
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    record.time.push_back(now);
    now += fit::interval_after(sampled, k);
    record.position.push_back(unit * (series.angle[k] - series.angle.front()));
  }
  if (std::ranges::count(series.torque, series.torque.front()) == std::ssize(series.torque))
    fit::refuse(record.axis, series.name, "the torque or force is constant");
  record.resolution = std::max(min_step(record.position), 3.0 * noise_of(record.position));
  if (!(record.resolution > 0.0)) record.resolution = std::numeric_limits<double>::min();
  const auto [lowest, highest] = std::ranges::minmax_element(record.position);
  constexpr double visible = 0.02;  // of the pitch: below, a wave looks like a spring
  record.turns = record.pitch > 0.0 && *highest - *lowest >= visible * record.pitch;
  set_velocities(record);
  const std::vector<Window> runs = runs_of(directions_of(record, series));
  if (series.sliding.empty()) record.presliding_travel = presliding_travel(record, runs);
  for (const Window& run : runs) record.moved += travel_of(record, run);
  find_strokes(record, runs);
  if (record.strokes.empty()) {
    fit::refuse(
        record.axis, series.name,
        fmt::format("shows no sliding: nowhere does it move on by {:g} steps of its readings ({:.3g} {}) "
                    "in one direction; material tests within the pre-sliding range are identified "
                    "without --sliding",
                    min_window_steps, record.resolution, parameters::unit_on(record.axis, "rad")));
  }
  record.min_velocity = record.max_velocity;
  for (const Window& stroke : record.strokes) {
    for (std::size_t k = stroke.first; k <= stroke.last; ++k)
      record.min_velocity = std::min(record.min_velocity, std::abs(record.velocity[k]));
  }
  cut_windows(record, max_window_samples);
  return record;
}

double used_proportion(std::span<const SlidingRecord> records) {
  double used = 0.0;
  double moved = 0.0;
  for (const SlidingRecord& record : records) {
    moved += record.moved;
    for (const Window& stroke : record.strokes) used += travel_of(record, stroke);
  }
  return moved > 0.0 ? used / moved : 0.0;
}

void cut_windows(SlidingRecord& record, std::size_t samples) {
  record.windows.clear();
  record.window_samples = samples;
  for (const Window& stroke : record.strokes) {
    const std::size_t length = samples_of(stroke);
    const auto by_travel =
        static_cast<std::size_t>(travel_of(record, stroke) / (min_window_steps * record.resolution));
    const std::size_t parts = std::max<std::size_t>(1, std::min(length / samples, by_travel));
    for (std::size_t i = 0; i < parts; ++i) {
      record.windows.push_back({stroke.first + i * length / parts,
                                stroke.first + (i + 1) * length / parts - 1, stroke.stroke,
                                stroke.direction});
    }
  }
}

}  // namespace zerocount::sliding_identification
