#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "analysis/identification/raw_series.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::identification {
namespace {

/// Unit (rad) of angles that are not counts.
constexpr double angle_unit = 1e-6;

/// The torque over each sample interval. If the motor torque was sampled behind an amplifier of known
/// bandwidth, its samples u and u′ at both ends of an interval are two points of one exponential, which gives
/// the commanded torque.
std::vector<motion::TorqueCourse> courses_of(const RawSeries& series, double sample_time) {
  std::vector<motion::TorqueCourse> courses;
  const double rate = 2.0 * std::numbers::pi * series.bandwidth;
  const double left = std::exp(-rate * sample_time);
  const double gone = -std::expm1(-rate * sample_time);
  const auto delay = static_cast<std::size_t>(series.delay);  // its fraction is the record's
  double lagging = 0.0;                                       // motor torque, lagging behind a commanded one
  for (std::size_t k = 0; k < series.torque.size(); ++k) {
    const double torque = k < delay ? 0.0 : series.torque[k - delay];
    if (rate == 0.0) {
      courses.push_back(motion::constant_torque(torque));
    } else if (series.torque_kind == TorqueKind::commanded) {
      courses.push_back({lagging, torque, rate});
      lagging = torque + (lagging - torque) * left;
    } else {
      const double next = k + 1 < series.torque.size() ? series.torque[k + 1] : torque;
      courses.push_back({torque, (next - torque * left) / gone, rate});
    }
  }
  return courses;
}

/// The resolution of angles that are encoder counts converted to rad: all differences are multiples of one
/// step, and most are 0. Nothing for other angles.
std::optional<double> step_of(const std::vector<double>& angles) {
  std::size_t changes = 0;
  double least = 0.0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double change = std::abs(angles[k] - angles[k - 1]);
    if (change == 0.0) continue;
    ++changes;
    if (least == 0.0 || change < least) least = change;
  }
  if (changes == 0 || 2 * changes > angles.size()) return std::nullopt;
  double steps = 0.0;
  double travel = 0.0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double change = std::abs(angles[k] - angles[k - 1]);
    const double whole = std::round(change / least);
    constexpr double tolerance = 0.1;  // rounding of the written numbers
    if (std::abs(change - whole * least) > tolerance * least * std::max(1.0, std::sqrt(whole))) {
      return std::nullopt;
    }
    steps += whole;
    travel += change;
  }
  return travel / steps;
}

void set_readings(const RawSeries& series, TestRecord& record) {
  if (series.counts_per_revolution > 0.0) {
    record.unit = 2.0 * std::numbers::pi / series.counts_per_revolution;
    record.counted = true;
    for (std::size_t k = 0; k < series.angle.size(); ++k) {
      if (series.angle[k] != std::round(series.angle[k])) {
        throw Failure(ExitCode::bad_data, fmt::format("{}: the count {} is no whole number",
                                                      place_of(series, k), series.angle[k]));
      }
    }
    record.reading = series.angle;
    return;
  }
  const std::optional<double> step = step_of(series.angle);
  record.counted = step.has_value();
  record.unit = step.value_or(angle_unit);
  for (const double angle : series.angle) {
    const double reading = (angle - series.angle.front()) / record.unit;
    record.reading.push_back(step ? std::round(reading) : reading);
  }
}

}  // namespace

TestRecord checked_record(const RawSeries& series, bool any_magnitude) {
  TestRecord record;
  record.name = series.name;
  record.start = series.start;
  record.sample_time = checked_sample_time(series);
  record.torque = courses_of(series, record.sample_time);
  record.delay_fraction = series.delay - std::floor(series.delay);
  set_readings(series, record);
  check_sticking(series);
  check_change(series, record);
  record.units_believed = any_magnitude || series.units_known;
  if (!record.units_believed) check_magnitudes(series, record);
  check_motion(series, record);
  check_glitches(series, record);
  check_clipping(series, record);
  return record;
}

}  // namespace zerocount::identification
