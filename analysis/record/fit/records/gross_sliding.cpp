#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "analysis/record/fit/records/checked_record.hpp"

namespace zerocount::fit {
namespace {

constexpr std::size_t min_sliding_window = 8;  // samples
constexpr std::size_t min_windows_before = 4;
constexpr double gross = 5.0;              // of the travel before
constexpr double torque_exponent = 3.0;    // of the growth of the torque's range
constexpr double largest_step = 0.5;       // of the travel in the window
constexpr double min_counts_before = 5.0;  // below, quantisation and noise are all of the travel
constexpr double onset = 0.3;              // of the travel in the window, more than that before the slide
constexpr std::size_t slide_over_run = 3;  // duration of the slide over that from the onset

/// [sample] The angles of the series; a masked angle is replaced by the last one before that is not masked,
/// or by the first such one.
std::vector<double> used_angles(const records::RawSeries& series) {
  std::vector<double> angles = series.angle;
  if (series.excluded.empty()) return angles;
  const auto used = std::find(series.excluded.begin(), series.excluded.end(), false);
  if (used == series.excluded.end()) return angles;
  double last = series.angle[static_cast<std::size_t>(used - series.excluded.begin())];
  for (std::size_t k = 0; k < angles.size(); ++k) {
    if (series.excluded[k]) angles[k] = last;
    last = angles[k];
  }
  return angles;
}

/// [sample] Range (maximum − minimum) of `start` and all values up to this sample.
std::vector<double> growing_ranges(const std::vector<double>& values, double start) {
  std::vector<double> ranges;
  ranges.reserve(values.size());
  double low = start;
  double high = start;
  for (const double value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
    ranges.push_back(high - low);
  }
  return ranges;
}

/// Angle, travel and torque of a test as the criterion for gross sliding needs them.
struct Course {
  std::vector<double> angle;  ///< [sample] Angle, in which masked readings are replaced by neighbouring ones.
  std::vector<double> travel;  ///< [sample] Range (maximum − minimum) of the angle up to this sample.
  /// [sample] Range (maximum − minimum) of the torque up to this sample, N m.
  std::vector<double> torque_range;
  /// Smallest travel before a slide, with which sliding can be distinguished from pre-sliding; in the unit of
  /// the angle.
  double min_travel{0.0};
  std::size_t lag{0};  ///< Number of samples until a torque of the series has acted on the rotor.
};

/// Number of samples from a torque in the series until the amplifier has reached it, except for a fraction
/// exp(−3).
std::size_t lag_of(const records::RawSeries& series) {
  const double duration = series.time.back() - series.time.front();
  const double rate = duration > 0.0 ? static_cast<double>(series.time.size() - 1) / duration : 0.0;
  constexpr double three_time_constants = 0.5;  // 3/2π
  const double settling = series.bandwidth > 0.0 ? three_time_constants / series.bandwidth * rate : 0.0;
  return static_cast<std::size_t>(
      std::min(std::ceil(series.delay + settling), static_cast<double>(series.time.size())));
}

Course course_of(const records::RawSeries& series) {
  Course course;
  course.angle = used_angles(series);
  course.travel = growing_ranges(course.angle, course.angle.front());
  course.torque_range = growing_ranges(series.torque, series.torque.front());
  course.min_travel = series.count_size > 0.0 ? min_counts_before : 0.0;
  course.lag = lag_of(series);
  return course;
}

/// True if the travel from sample `from` to sample `to` is more than pre-sliding explains.
bool is_sliding(const Course& course, std::size_t from, std::size_t to) {
  const double travel = std::abs(course.angle[to] - course.angle[from]);
  const double before = std::max(course.travel[from], course.min_travel);
  if (!(before > 0.0) || travel < gross * before) return false;
  const std::size_t earlier = from - 2 * (to - from);
  if (earlier < course.lag) return false;
  const double range_before = course.torque_range[earlier - course.lag];
  if (!(range_before > 0.0)) return false;
  const double growth = course.torque_range[to] / range_before;
  if (travel < gross * before * std::pow(growth, torque_exponent)) return false;
  for (std::size_t k = from + 1; k <= to; ++k) {
    if (std::abs(course.angle[k] - course.angle[k - 1]) > largest_step * travel) return false;
  }
  return true;
}

/// Locates gross sliding that was found in the window from sample `from` to sample `to`. The window ends
/// inside the slide, but may begin long before it. From the onset on, the rotor certainly slides. A distance
/// that grows with the square of the time reaches the onset after 0.55 of the slide's duration, one that
/// grows with its cube, as under a rising torque, after 0.67.
GrossSliding located(const Course& course, std::size_t from, std::size_t to) {
  const double travel = std::abs(course.angle[to] - course.angle[from]);
  std::size_t run = to;
  while (run > from && std::abs(course.angle[run - 1] - course.angle[from]) > onset * travel) --run;
  return {to - std::min(to, slide_over_run * (to - run)), to, travel, course.travel[from]};
}

}  // namespace

std::optional<GrossSliding> find_gross_sliding(const records::RawSeries& series) {
  if (series.angle.empty()) return std::nullopt;
  const Course course = course_of(series);
  for (std::size_t to = 0; to < course.angle.size(); ++to) {
    for (std::size_t window = min_sliding_window; to >= (min_windows_before + 1) * window; window *= 2) {
      if (is_sliding(course, to - window, to)) return located(course, to - window, to);
    }
  }
  return std::nullopt;
}

}  // namespace zerocount::fit
