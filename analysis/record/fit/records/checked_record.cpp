#include "analysis/record/fit/records/checked_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace zerocount::fit {
namespace {

/// Unit of readings that are angles and not counts, as a proportion of the record's travel.
constexpr double travel_per_unit = 1e-3;

/// Smallest number of samples that must be left when a record is cut where it begins to slide. What is left
/// is then checked like any other record.
constexpr std::size_t min_samples_before_sliding = 100;

/// The step between the values of angles that are encoder counts converted to rad: all differences are
/// multiples of one step, and most are 0. Null for other angles.
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
  if (series.count_size > 0.0) {
    record.unit = series.count_size;
    record.counted = true;
    for (std::size_t k = 0; k < series.angle.size(); ++k) {
      if (series.angle[k] != std::round(series.angle[k]))
        refuse(record.axis, place_of(series, k),
               fmt::format("the count {} is not a whole number", series.angle[k]));
    }
    record.reading = series.angle;
    return;
  }
  const std::optional<double> step = step_of(series.angle);
  record.counted = step.has_value();
  const auto [low, high] = std::minmax_element(series.angle.begin(), series.angle.end());
  const double travel = *high > *low ? *high - *low : 1.0;
  record.unit = step.value_or(travel_per_unit * travel);
  for (const double angle : series.angle) {
    const double reading = (angle - series.angle.front()) / record.unit;
    record.reading.push_back(step ? std::round(reading) : reading);
  }
}

/// Replaces masked readings by straight lines between their neighbours, for the starting values; the fit does
/// not use them.
void bridge_masked(TestRecord& record) {
  if (used_samples(record) < sample_count(record)) record.recorded = record.reading;
  const std::size_t samples = record.reading.size();
  for (std::size_t first = 0; first < record.excluded.size();) {
    std::size_t end = first;
    while (end < samples && record.excluded[end]) ++end;
    if (end > first) {
      const double before =
          first > 0 ? record.reading[first - 1] : record.reading[std::min(end, samples - 1)];
      const double after = end < samples ? record.reading[end] : before;
      for (std::size_t k = first; k < end; ++k) {
        const double part = static_cast<double>(k - first + 1) / static_cast<double>(end - first + 1);
        const double between = before + part * (after - before);
        record.reading[k] = record.counted ? std::round(between) : between;
      }
    }
    first = end + 1;
  }
}

/// Sample at which a series begins to slide and the record is cut, and the note that says so.
struct SlidingCut {
  std::size_t sample{0};
  std::string note;
};

/// The cut of a series that slides, by its own flag or, without one, by torque and angle. Null if it does not
/// slide.
std::optional<SlidingCut> sliding_in(const RawSeries& series) {
  if (!series.sliding.empty()) {
    const auto slides = std::find(series.sliding.begin(), series.sliding.end(), true);
    if (slides == series.sliding.end()) return std::nullopt;
    const auto sample = static_cast<std::size_t>(slides - series.sliding.begin());
    return SlidingCut{
        sample, fmt::format("cut at {:.6g} s, where the axis breaks away and slides", series.time[sample])};
  }
  const std::optional<GrossSliding> found = find_gross_sliding(series);
  if (!found) return std::nullopt;
  const double unit = series.count_size > 0.0 ? series.count_size : 1.0;
  return SlidingCut{
      found->first,
      fmt::format("ends at sample {} ({:.6g} s), where the axis begins to slide: it travels {:.3g} {} until "
                  "{:.6g} s, after {:.3g} {} in all before. The rest is not used, because the contact that "
                  "forms after a slide is another one",
                  found->first, series.time[found->first], found->travel * unit,
                  parameters::unit_on(axis_of(series), "rad"), series.time[found->seen],
                  found->travel_before * unit, parameters::unit_on(axis_of(series), "rad"))};
}

/// The first `samples` samples of the series.
RawSeries first_samples(RawSeries part, std::size_t samples) {
  part.time.resize(samples);
  part.torque.resize(samples);
  part.angle.resize(samples);
  if (!part.lines.empty()) part.lines.resize(samples);
  if (!part.code.empty()) part.code.resize(samples);
  if (!part.excluded.empty()) part.excluded.resize(samples);
  part.sliding.clear();
  return part;
}

/// Requires that enough samples are left before the cut.
/// @throws Failure (bad_data) if too little is left
void check_cut(const RawSeries& series, const SlidingCut& cut) {
  if (cut.sample >= min_samples_before_sliding) return;
  refuse(
      axis_of(series), place_of(series, cut.sample),
      fmt::format("the axis breaks away and slides at {:.6g} s, after {} samples; expected {} before it at "
                  "least. Test with less $torque, or take --sliding for the slides",
                  series.time[cut.sample], cut.sample, min_samples_before_sliding));
}

}  // namespace

std::vector<motion::TorqueCourse> courses_of(const RawSeries& series, const TestRecord& record) {
  std::vector<motion::TorqueCourse> courses;
  const double rate = 2.0 * std::numbers::pi * series.bandwidth;
  const auto delay = static_cast<std::size_t>(series.delay);  // its fraction is the record's
  double lagging = 0.0;                                       // motor torque, lagging behind a commanded one
  for (std::size_t k = 0; k < series.torque.size(); ++k) {
    const double torque = k < delay ? 0.0 : series.torque[k - delay];
    const double decay = std::exp(-rate * interval_after(record, k));
    const double gone = -std::expm1(-rate * interval_after(record, k));
    if (rate == 0.0) {
      courses.push_back(motion::constant_torque(torque));
    } else if (series.torque_kind == TorqueKind::commanded) {
      courses.push_back({lagging, torque, rate});
      lagging = torque + (lagging - torque) * decay;
    } else {
      const double next = k + 1 < series.torque.size() ? series.torque[k + 1] : torque;
      courses.push_back({torque, (next - torque * decay) / gone, rate});
    }
  }
  return courses;
}

TestRecord checked_record(const RawSeries& whole, bool any_magnitude) {
  check_jumps(whole);
  const std::optional<SlidingCut> cut = sliding_in(whole);
  if (cut) check_cut(whole, *cut);
  const RawSeries series = cut ? first_samples(whole, cut->sample) : whole;
  TestRecord record;
  record.name = series.name;
  record.axis = axis_of(series);
  if (cut) record.note = cut->note;
  record.start = series.start;
  record.sample_time = checked_sample_time(series);
  record.first_time = series.time.front();
  record.intervals = uneven_intervals(series);
  record.torque = courses_of(series, record);
  record.delay_fraction = series.delay - std::floor(series.delay);
  set_readings(series, record);
  record.excluded = series.excluded;
  bridge_masked(record);
  check_change(series, record);
  if (!any_magnitude && !series.units_known) check_magnitudes(series, record);
  check_motion(series, record);
  check_glitches(series, record);
  check_clipping(series, record);
  return record;
}

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

}  // namespace zerocount::fit
