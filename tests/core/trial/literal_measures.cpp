#include "tests/core/trial/literal_trial.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Errors = std::vector<std::int64_t>;
using Samples = std::vector<trial::SampleRecord>;

int sign(double value) {
  return (value > 0) - (value < 0);
}

std::int64_t largest(Errors::const_iterator from, Errors::const_iterator to) {
  std::int64_t size = 0;
  for (auto e = from; e != to; ++e) size = std::max(size, std::abs(*e));
  return size;
}

/// Whether some rotor angle is consistent with both encoder counts of the sample. In 1/(fine·coarse)
/// revolutions from the rotor's start, the counts are [(f − φ)·coarse, (f + 1 − φ)·coarse) and [(c − φ)·fine,
/// (c + 1 − φ)·fine).
bool have_a_common_angle(const trial::TrialParameters& p, const trial::SampleRecord& sample) {
  const auto fine = static_cast<std::int64_t>(p.encoder.fine);
  const auto coarse = static_cast<std::int64_t>(p.encoder.coarse);
  const std::int64_t apart = sample.count * coarse - sample.coarse_count * fine;
  const long double by_phase =
      static_cast<long double>(p.initial.encoder_phase) * static_cast<long double>(coarse - fine);
  return static_cast<long double>(apart - fine) < by_phase &&
         by_phase < static_cast<long double>(apart + coarse);
}

bool is_flawed(const loop::EncoderErrors& errors) {
  return errors.eccentricity != 0 || errors.interpolation != 0 || errors.noise != 0 || errors.missed != 0;
}

std::int64_t disagreements(const trial::TrialParameters& p, const Samples& samples, const MoveSpan& span) {
  if (!is_flawed(p.encoder.fine_errors) && !is_flawed(p.encoder.coarse_errors)) return 0;
  std::int64_t number = 0;
  for (std::size_t k = span.first; k < span.first + span.size; ++k)
    number += have_a_common_angle(p, samples[k]) ? 0 : 1;
  return number;
}

std::int64_t phase_changes(const Samples& samples, const MoveSpan& span) {
  std::int64_t number = 0;
  for (std::size_t k = std::max<std::size_t>(span.first, 1); k < span.first + span.size; ++k)
    number += samples[k].phase != samples[k - 1].phase ? 1 : 0;
  return number;
}

/// Index of the first of `dwell` successive errors of 0; the number of errors if there are none.
std::size_t first_of_dwell(const Errors& errors, std::size_t dwell) {
  const auto found = std::search_n(errors.begin(), errors.end(), dwell, 0);
  return static_cast<std::size_t>(found - errors.begin());
}

/// The jerks of a move: uninterrupted runs of errors other than 0 from sample `from` on.
std::vector<trial::Jerk> jerks_of(const Errors& errors, std::size_t from, double sample_time,
                                  std::size_t move) {
  std::vector<trial::Jerk> jerks;
  const auto zero = [](std::int64_t e) { return e == 0; };
  auto begin = std::find_if_not(errors.begin() + static_cast<std::ptrdiff_t>(from), errors.end(), zero);
  while (begin != errors.end()) {
    const auto end = std::find_if(begin, errors.end(), zero);
    jerks.push_back(
        {static_cast<std::int64_t>(move), static_cast<double>(begin - errors.begin()) * sample_time,
         static_cast<double>(end - begin) * sample_time, largest(begin, end), *begin < 0 ? 1 : -1});
    begin = std::find_if_not(end, errors.end(), zero);
  }
  return jerks;
}

bool only_approaches(const Errors& last_half) {
  return std::all_of(last_half.begin(), last_half.end(), [&](std::int64_t e) {
    return sign(static_cast<double>(e)) == sign(static_cast<double>(last_half.front())) &&
           std::abs(e) <= std::abs(last_half.front());
  });
}

/// The amplitude and the period of an oscillating move, from the counts of its last half.
void measure_oscillation(const Errors& last_half, double sample_time, trial::MoveOutcome& outcome) {
  std::vector<double> counts;  // from the target
  for (const std::int64_t e : last_half) counts.push_back(-static_cast<double>(e));
  const double highest = *std::max_element(counts.begin(), counts.end());
  const double lowest = *std::min_element(counts.begin(), counts.end());
  outcome.oscillation_amplitude = (highest - lowest) / 2;
  const double middle = (highest + lowest) / 2;
  std::vector<double> crossings;  // s
  for (std::size_t k = 1; k < counts.size(); ++k) {
    if (counts[k - 1] < middle && counts[k] >= middle)
      crossings.push_back(static_cast<double>(k) * sample_time);
  }
  if (crossings.size() < 2) return;
  double sum = 0.0;
  for (std::size_t i = 1; i < crossings.size(); ++i) sum += crossings[i] - crossings[i - 1];
  outcome.oscillation_period = sum / static_cast<double>(crossings.size() - 1);
}

/// Sets the measures that depend on the end of a move.
void judge_end(const Errors& errors, std::int64_t largest_in_window, double sample_time,
               trial::MoveOutcome& outcome) {
  const std::size_t half = (errors.size() + 1) / 2;
  const Errors last_half(errors.begin() + static_cast<std::ptrdiff_t>(half), errors.end());
  outcome.outcome = largest_in_window == 0       ? trial::Outcome::zero_count
                    : largest_in_window == 1     ? trial::Outcome::one_count
                    : only_approaches(last_half) ? trial::Outcome::off_target
                                                 : trial::Outcome::oscillating;
  outcome.midway_error = last_half.empty() ? errors.back() : last_half.front();
  std::size_t first_zero = errors.size();
  while (first_zero > 0 && errors[first_zero - 1] == 0) --first_zero;
  if (first_zero < errors.size()) outcome.final_settling_time = static_cast<double>(first_zero) * sample_time;
  if (outcome.outcome == trial::Outcome::oscillating) measure_oscillation(last_half, sample_time, outcome);
}

/// The measures of an error band |e| ≤ limit, by the definitions of the jerk measures applied to a signal
/// that is 1 outside the band and 0 inside.
trial::BandOutcome band_of(const Errors& errors, std::int64_t limit, std::size_t dwell, double rate) {
  Errors outside;
  for (const std::int64_t e : errors) outside.push_back(std::abs(e) > limit ? 1 : 0);
  trial::BandOutcome band{.exits = 0.0};
  const std::size_t entry = first_of_dwell(outside, dwell);
  if (entry < outside.size()) {
    band.entry_time = static_cast<double>(entry) / rate;
    band.exits = static_cast<double>(jerks_of(outside, entry + dwell, 1 / rate, 0).size());
  }
  std::size_t settled = outside.size();
  while (settled > 0 && outside[settled - 1] == 0) --settled;
  if (settled < outside.size()) band.settling_time = static_cast<double>(settled) / rate;
  return band;
}

void judge(const Errors& errors, const trial::TrialParameters& p, std::size_t move,
           LiteralMeasures& measures) {
  const double rate = p.controller.sample_rate;
  const auto dwell = static_cast<std::size_t>(std::llround(p.verdict.dwell * rate));
  const auto window = std::llround(p.verdict.window * rate);
  trial::MoveOutcome& outcome = measures.outcome;
  const std::int64_t in_window = largest(errors.end() - window, errors.end());
  judge_end(errors, in_window, 1 / rate, outcome);
  for (std::size_t b = 0; b < p.verdict.bands.count; ++b)
    outcome.bands[b] = band_of(errors, p.verdict.bands.limits[b], dwell, rate);
  for (const std::int64_t e : errors)
    outcome.overshoot = std::max(outcome.overshoot, -sign(static_cast<double>(errors.front())) * e);
  const std::size_t arrival = first_of_dwell(errors, dwell);
  if (arrival == errors.size()) return;
  outcome.arrived = true;
  outcome.arrival = static_cast<std::int64_t>(arrival);
  outcome.arrival_time = static_cast<double>(arrival) / rate;
  outcome.stable = largest(errors.begin() + outcome.arrival, errors.end()) <= 1;
  outcome.zero_fraction = static_cast<double>(std::count(errors.begin() + outcome.arrival, errors.end(), 0)) /
                          static_cast<double>(errors.end() - errors.begin() - outcome.arrival);
  measures.jerks = jerks_of(errors, arrival + dwell, 1 / rate, move);
  outcome.jerk_count = static_cast<std::int64_t>(measures.jerks.size());
  const auto along =
      std::count_if(measures.jerks.begin(), measures.jerks.end(),
                    [&](const trial::Jerk& jerk) { return jerk.direction == sign(outcome.holding_torque); });
  if (!measures.jerks.empty()) {
    outcome.jerk_agreement = static_cast<double>(along) / static_cast<double>(measures.jerks.size());
  }
}

}  // namespace

LiteralMeasures literal_measures(const trial::TrialParameters& p, const Samples& samples,
                                 const std::vector<long double>& wanted, std::size_t move) {
  const MoveSpan span = literal_spans(p)[move];
  const trial::SampleRecord& last = samples[span.first + span.size - 1];
  const bool open = !p.command.torque.levels.empty();
  const std::int64_t target = open ? 0 : p.command.targets[move];
  const long double most = std::ldexp(1.0L, p.dac.bits - 1);
  LiteralMeasures measures;
  trial::MoveOutcome& outcome = measures.outcome;
  Errors errors;
  for (std::size_t k = span.first; k < span.first + span.size; ++k) {
    errors.push_back(target - samples[k].count);
    outcome.peak_torque = std::max(outcome.peak_torque, std::abs(samples[k].torque));
    if (open && p.command.torque.through == trial::TorquePath::exact) continue;
    const long double code = wanted[k] / p.dac.resolution;
    outcome.saturated = outcome.saturated || code < -most - 0.5L || code > most - 0.5L;
  }
  outcome.final_error = errors.back();
  outcome.holding_torque = last.torque;
  outcome.final_position = last.theta;
  outcome.creep = last.xp;
  outcome.encoder_disagreement = disagreements(p, samples, span);
  outcome.phase_changes = phase_changes(samples, span);
  if (open) {
    outcome.outcome = trial::Outcome::open_loop;
    outcome.travel_time = static_cast<double>(literal_samples_on_the_way(p, move)) / p.controller.sample_rate;
    return measures;
  }
  outcome.travel_time = static_cast<double>(literal_motion(p, move).duration());
  const long double resolution = 2 * std::numbers::pi_v<long double> / p.encoder.fine;
  const long double middle = (static_cast<long double>(target) + 0.5L - p.initial.encoder_phase) * resolution;
  outcome.true_error = static_cast<double>((middle - last.theta) / resolution);
  judge(errors, p, move, measures);
  return measures;
}

void expect_same_measures(const trial::MoveOutcome& measured, const trial::MoveOutcome& expected) {
  EXPECT_EQ(measured.outcome, expected.outcome);
  EXPECT_EQ(measured.arrived, expected.arrived);
  EXPECT_EQ(measured.stable, expected.stable);
  EXPECT_EQ(measured.saturated, expected.saturated);
  EXPECT_EQ(measured.arrival, expected.arrival);
  EXPECT_EQ(measured.overshoot, expected.overshoot);
  EXPECT_EQ(measured.midway_error, expected.midway_error);
  EXPECT_EQ(measured.final_error, expected.final_error);
  EXPECT_EQ(measured.final_position, expected.final_position);
  EXPECT_EQ(measured.holding_torque, expected.holding_torque);
  EXPECT_EQ(measured.peak_torque, expected.peak_torque);
  EXPECT_EQ(measured.creep, expected.creep);
  EXPECT_EQ(measured.phase_changes, expected.phase_changes);
  EXPECT_EQ(measured.encoder_disagreement, expected.encoder_disagreement);
  EXPECT_EQ(measured.jerk_count, expected.jerk_count);
  const auto expect_same = [](double value, double other, double tolerance, const char* name) {
    EXPECT_EQ(std::isnan(value), std::isnan(other)) << name;
    if (!std::isnan(other)) {
      EXPECT_NEAR(value, other, tolerance) << name;
    }
  };
  expect_same(measured.travel_time, expected.travel_time, 1e-12, "travel_time");
  expect_same(measured.arrival_time, expected.arrival_time, 1e-12, "arrival_time");
  expect_same(measured.final_settling_time, expected.final_settling_time, 1e-12, "final_settling_time");
  expect_same(measured.zero_fraction, expected.zero_fraction, 1e-12, "zero_fraction");
  expect_same(measured.oscillation_amplitude, expected.oscillation_amplitude, 0.0, "amplitude");
  expect_same(measured.oscillation_period, expected.oscillation_period, 1e-12, "period");
  expect_same(measured.true_error, expected.true_error, 1e-8, "true_error");
  expect_same(measured.jerk_agreement, expected.jerk_agreement, 1e-15, "jerk_agreement");
  for (std::size_t b = 0; b < expected.bands.size(); ++b) {
    const trial::BandOutcome &band = measured.bands[b], &literal = expected.bands[b];
    expect_same(band.entry_time, literal.entry_time, 1e-12, "band_entry_time");
    expect_same(band.settling_time, literal.settling_time, 1e-12, "band_settling_time");
    expect_same(band.exits, literal.exits, 0.0, "band_exits");
  }
}

void expect_same_jerks(const std::vector<trial::Jerk>& measured, const std::vector<trial::Jerk>& expected) {
  ASSERT_EQ(measured.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(measured[i].move, expected[i].move);
    EXPECT_EQ(measured[i].magnitude, expected[i].magnitude);
    EXPECT_EQ(measured[i].direction, expected[i].direction);
    EXPECT_NEAR(measured[i].onset, expected[i].onset, 1e-12);
    EXPECT_NEAR(measured[i].duration, expected[i].duration, 1e-12);
  }
}

}  // namespace zerocount::testing
