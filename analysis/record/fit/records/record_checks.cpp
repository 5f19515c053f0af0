#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/records/checked_record.hpp"

namespace zerocount::fit {

namespace {

constexpr std::size_t min_record_samples = 100;
constexpr double jitter_allowed = 0.25;  // of the sampling interval
constexpr double min_counts = 5.0;       // of travel
constexpr std::size_t clipped_samples = 3;

/// Plausible range of a quantity, and the question in the message for values outside.
struct Plausible {
  std::string_view quantity;
  std::string_view unit;
  double low;
  double high;
  std::string_view question;
};

void check_plausible(const RawSeries& series, const Plausible& plausible, double value) {
  if (value >= plausible.low && value <= plausible.high) return;
  refuse(axis_of(series), series.name,
         fmt::format("{} is {:.4g} {}, {} what is plausible for an axis on its friction ({:g} to {:g} "
                     "{}): {} If it is right, give --any-magnitude",
                     plausible.quantity, value, plausible.unit, value < plausible.low ? "below" : "above",
                     plausible.low, plausible.high, plausible.unit, plausible.question));
}

double travel(const TestRecord& record) {
  const auto [low, high] = std::minmax_element(record.reading.begin(), record.reading.end());
  return *high - *low;
}

/// Usual sampling interval, s: half the median time between every other sample, which is insensitive to
/// jitter.
double usual_interval(const std::vector<double>& time) {
  std::vector<double> over_two;
  for (std::size_t k = 2; k < time.size(); ++k) over_two.push_back(0.5 * (time[k] - time[k - 2]));
  return statistics::upper_median(std::move(over_two));
}

/// Throws a Failure if the series has gaps, in which the torque is unknown, or samples so close together that
/// their times cannot be right.
void check_gaps(const RawSeries& series) {
  constexpr double gap = 1.75;  // of the interval: more than the jitter of two samples
  constexpr double min_interval = 0.1;
  const double interval = usual_interval(series.time);
  for (std::size_t k = 1; k < series.time.size(); ++k) {
    const double waited = series.time[k] - series.time[k - 1];
    if (waited < min_interval * interval) {
      refuse(
          axis_of(series), place_of(series, k),
          fmt::format("{} s comes {:.2g} sampling intervals ({:.6g} s) after the sample before; expected {} "
                      "at least",
                      series.time[k], waited / interval, interval, min_interval));
    }
    if (waited <= gap * interval) continue;
    refuse(axis_of(series), place_of(series, k),
           fmt::format("the samples are not equally spaced: {} s come {:.3g} sampling "
                       "intervals ({:.6g} s) after the sample before. Are samples "
                       "missing?",
                       series.time[k], waited / interval, interval));
  }
}

struct RegularGrid {
  double start{0.0};
  double interval{0.0};
};

/// Least-squares fit of a regular time grid to the times of the samples.
RegularGrid nearest_grid(const std::vector<double>& time) {
  const auto samples = static_cast<double>(time.size());
  const double middle = 0.5 * (samples - 1.0);
  double mean = 0.0;
  for (const double t : time) mean += (t - time.front()) / samples;
  double product = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    product += (static_cast<double>(k) - middle) * (time[k] - time.front() - mean);
  }
  const double interval = product * 12.0 / (samples * (samples * samples - 1.0));
  return {time.front() + mean - middle * interval, interval};
}

/// The code at the end of the range of a converter with `bits` bits: the lowest one if `code` is negative,
/// otherwise the highest one.
double last_code(int bits, double code) {
  const double half = std::ldexp(1.0, bits - 1);
  return code < 0.0 ? -half : half - 1.0;
}

/// Word length in bits, at least 12, of the smallest converter whose range contains the codes `low` to
/// `high`. For an unknown converter, only with this word length can the codes be at the end of its range.
int shortest_word(double low, double high) {
  int bits = 12;
  while (low < last_code(bits, -1.0) || high > last_code(bits, 1.0)) ++bits;
  return bits;
}

void check_codes(const RawSeries& series) {
  if (series.code.empty()) return;
  const auto low = std::min_element(series.code.begin(), series.code.end());
  const auto high = std::max_element(series.code.begin(), series.code.end());
  const int bits = series.dac_bits > 0 ? series.dac_bits : shortest_word(*low, *high);
  for (const auto extreme : {low, high}) {
    if (*extreme >= last_code(bits, -1.0) && *extreme <= last_code(bits, 1.0)) continue;
    refuse(axis_of(series), place_of(series, static_cast<std::size_t>(extreme - series.code.begin())),
           fmt::format("the code {:.0f} is beyond the DAC's {} bits", *extreme, bits));
  }
  const std::string doubt =
      series.dac_bits > 0
          ? ""
          : fmt::format(" if it has {} bits. If it has others, give them with --dac-bits", bits);
  std::size_t repeated = 0;
  for (std::size_t k = 0; k < series.code.size(); ++k) {
    repeated = series.code[k] == last_code(bits, series.code[k]) ? repeated + 1 : 0;
    if (repeated < clipped_samples) continue;
    refuse(axis_of(series), place_of(series, k),
           fmt::format("the $torque is clipped: the DAC's code stays at {:.0f}, the end "
                       "of its range{}",
                       series.code[k], doubt));
  }
}

constexpr double large_jump = 0.25;        // of the travel
constexpr double times_the_motion = 50.0;  // about it
constexpr double small_torque = 0.1;       // of its range, changes that move no axis so far

bool is_masked(const RawSeries& series, std::size_t k) {
  return !series.excluded.empty() && (series.excluded[k] || series.excluded[k - 1]);
}

/// Steps of the angle and of the torque in the 10 samples on both sides of a step of the angle.
struct Surroundings {
  /// Longest step of the angle that is shorter than a limit, in the unit of the angle.
  double longest_step{0.0};
  double torque_range{0.0};
};

Surroundings surroundings_of(const RawSeries& series, std::size_t k, double limit) {
  constexpr std::size_t reach = 10;
  const std::size_t first = k > reach ? k - reach : 1;
  const std::size_t end = std::min(k + reach + 1, series.angle.size());
  Surroundings about;
  for (std::size_t i = first; i < end; ++i) {
    const double step = std::abs(series.angle[i] - series.angle[i - 1]);
    if (step < limit) about.longest_step = std::max(about.longest_step, step);
  }
  const auto [least, most] =
      std::minmax_element(series.torque.begin() + static_cast<std::ptrdiff_t>(first - 1),
                          series.torque.begin() + static_cast<std::ptrdiff_t>(end));
  about.torque_range = *most - *least;
  return about;
}

/// Throws a Failure if the angle continues and returns during a hold while the torque stays at its extreme:
/// the torque was clipped.
void check_flat_top(const RawSeries& series, const TestRecord& record, const TorqueHold& hold) {
  const double sign = hold.torque > 0.0 ? 1.0 : -1.0;
  const double noticeable = std::max(record.counted ? min_counts : 0.0, 0.01 * travel(record));
  std::size_t peak = hold.first;
  for (std::size_t k = hold.first; k <= hold.last; ++k) {
    if (sign * record.reading[k] > sign * record.reading[peak]) peak = k;
  }
  const double rise = sign * (record.reading[peak] - record.reading[hold.first]);
  const double fall = sign * (record.reading[peak] - record.reading[hold.last]);
  const bool swings = peak - hold.first < (hold.last - hold.first) / 20;
  if (rise < noticeable || fall < noticeable || swings) return;
  refuse(axis_of(series), place_of(series, hold.first),
         fmt::format(
             "the $torque is clipped: it stays at {:.4g} $Nm for {:.3g} s, and meanwhile the $angle goes on "
             "by {:.3g} $rad and comes back by {:.3g} $rad",
             hold.torque, static_cast<double>(hold.last - hold.first) * record.sample_time,
             rise * record.unit, fall * record.unit));
}

}  // namespace

double checked_sample_time(const RawSeries& series) {
  const std::vector<double>& time = series.time;
  if (time.size() < min_record_samples) {
    refuse(axis_of(series), series.name,
           fmt::format("is too short: {} samples; expected {} at least", time.size(), min_record_samples));
  }
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (time[k] > time[k - 1]) continue;
    refuse(axis_of(series), place_of(series, k),
           fmt::format("the time {} s does not come after {} s", time[k], time[k - 1]));
  }
  check_gaps(series);
  return nearest_grid(time).interval;
}

std::vector<double> uneven_intervals(const RawSeries& series) {
  const std::vector<double>& time = series.time;
  const RegularGrid grid = nearest_grid(time);
  double farthest = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    farthest = std::max(farthest, std::abs(time[k] - grid.start - static_cast<double>(k) * grid.interval));
  }
  if (farthest <= jitter_allowed * grid.interval) return {};
  std::vector<double> intervals;
  for (std::size_t k = 0; k + 1 < time.size(); ++k) intervals.push_back(time[k + 1] - time[k]);
  intervals.push_back(grid.interval);
  return intervals;
}

void check_magnitudes(const RawSeries& series, const TestRecord& record) {
  check_plausible(series, {"the sampling interval", "s", 1e-6, 2e-2, "is the time in ms or us?"},
                  record.sample_time);
  check_plausible(series,
                  {"the largest $torque", "$Nm", 1e-3, series.linear ? 2e4 : 20.0, "is the $torque in m$Nm?"},
                  largest_torque(record));
  const double turned = travel(record) * record.unit;
  check_plausible(
      series,
      {"the travel", "$rad", series.linear ? 5e-9 : 4e-6, series.linear ? 0.01 : 0.05,
       series.linear
           ? "is the position in mm or um, is the size of a count right, did the axis slide (then --sliding)?"
           : "is the angle in mrad or degrees, are the counts per revolution right, did the axis slide (then "
             "--sliding)?"},
      turned);
  check_plausible(
      series,
      {"the $torque's range over the travel", "$Nm/$rad", series.linear ? 100.0 : 1.0,
       series.linear ? 1e10 : 2e4,
       series.linear ? "are force and position in N and m, is the resolution of the encoder right?"
                     : "are torque and angle in N m and rad, are the counts per revolution right, "
                       "is this a linear axis (then --axis linear)?"},
      torque_range(record) / turned);
}

void check_change(const RawSeries& series, const TestRecord& record) {
  if (!(torque_range(record) > 0.0)) refuse(axis_of(series), series.name, "the $torque is 0 throughout");
  if (!(travel(record) > 0.0)) {
    refuse(axis_of(series), series.name, "the $angle is constant: the encoder does not see the axis move");
  }
}

void check_motion(const RawSeries& series, const TestRecord& record) {
  const double counts = travel(record);
  if (record.counted && counts < min_counts) {
    refuse(axis_of(series), series.name,
           fmt::format("the axis moves by {:.0f} counts only; expected {:.0f} at least", counts, min_counts));
  }
  if (!series.sliding.empty())
    return;  // the record itself tells that it does not slide, and its signs are right
  constexpr std::size_t lag = 10;
  double agreement = 0.0;
  for (std::size_t k = lag; k < sample_count(record); ++k) {
    agreement += (record.torque[k - 1].now - record.torque[k - lag].now) *
                 (record.reading[k] - record.reading[k - lag]);
  }
  if (agreement >= 0.0) return;
  double energy = 0.0;
  for (std::size_t k = 1; k < sample_count(record); ++k) {
    energy += record.torque[k - 1].now * (record.reading[k] - record.reading[k - 1]);
  }
  if (energy < 0.0) {
    refuse(axis_of(series), series.name,
           "the $angle falls where the $torque rises: one of them has the wrong sign");
  }
  refuse(
      axis_of(series), series.name,
      "the $angle does not follow the $torque as it does on a spring, although the $torque drives the "
      "motion: the "
      "axis slides. Material tests stay within the pre-sliding range; --sliding identifies a sliding axis");
}

void check_jumps(const RawSeries& series) {
  const std::vector<double>& angle = series.angle;
  const auto [low, high] = std::ranges::minmax(angle);
  const auto [least, most] = std::ranges::minmax(series.torque);
  double min_step = high - low;
  for (std::size_t k = 1; k < angle.size(); ++k) {
    if (angle[k] != angle[k - 1]) min_step = std::min(min_step, std::abs(angle[k] - angle[k - 1]));
  }
  for (std::size_t k = 2; k + 1 < angle.size(); ++k) {
    const double jump = angle[k] - angle[k - 1];
    if (std::abs(jump) < large_jump * (high - low) || jump == 0.0 || is_masked(series, k)) continue;
    const bool stays = std::abs(angle[k + 1] - angle[k - 1]) > 0.5 * std::abs(jump) &&
                       std::abs(angle[k] - angle[k - 2]) > 0.5 * std::abs(jump);
    const Surroundings about = surroundings_of(series, k, large_jump * (high - low));
    const double moving = std::max(about.longest_step, min_step);
    if (!stays || std::abs(jump) < times_the_motion * moving ||
        about.torque_range > small_torque * (most - least))
      continue;
    refuse(axis_of(series), place_of(series, k),
           fmt::format(
               "the $angle jumps by {:.6g} {}, and moves by at most {:.6g} a sample before and after: was "
               "the counter set, or does it wrap? Continue it, or cut the record there",
               jump, series.count_size > 0.0 ? "counts" : "$rad", about.longest_step));
  }
}

void check_glitches(const RawSeries& series, const TestRecord& record) {
  constexpr double beyond_all = 10.0;
  const std::vector<double>& reading = record.reading;
  // Height of each reading above or below both its neighbours.
  std::vector<double> height(reading.size(), 0.0);
  for (std::size_t k = 1; k + 1 < reading.size(); ++k) {
    const double there = reading[k] - reading[k - 1];
    const double back = reading[k] - reading[k + 1];
    if (there * back > 0.0) height[k] = std::min(std::abs(there), std::abs(back));
  }
  const auto highest = std::max_element(height.begin(), height.end());
  double next = record.counted ? 1.0 : 0.0;
  for (auto at = height.begin(); at != height.end(); ++at) {
    if (at != highest) next = std::max(next, *at);
  }
  if (!(*highest > beyond_all * next)) return;
  refuse(axis_of(series), place_of(series, static_cast<std::size_t>(highest - height.begin())),
         fmt::format("this one $angle is {:.3g} $rad off those before and after it, probably a read error. "
                     "Replace it by a neighbouring value, or shorten the record",
                     *highest * record.unit));
}

void check_clipping(const RawSeries& series, const TestRecord& record) {
  check_codes(series);
  const double range = torque_range(record);
  double high = 0.0;
  double low = 0.0;
  for (const motion::TorqueCourse& torque : record.torque) {
    high = std::max(high, torque.now);
    low = std::min(low, torque.now);
  }
  constexpr double tolerance = 2e-3;  // of the range
  for (const TorqueHold& hold : parts_of(record).holds) {
    const bool at_extreme = hold.torque >= high - tolerance * range || hold.torque <= low + tolerance * range;
    if (at_extreme && !hold.rings_down) check_flat_top(series, record, hold);
  }
}

}  // namespace zerocount::fit
