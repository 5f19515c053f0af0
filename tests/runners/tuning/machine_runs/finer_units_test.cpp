// A move that is judged by an encoder with finer counts, and told in counts of the study.
#include "runners/tuning/machine_runs/finer_units.hpp"

#include "experiments/study/features.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t counts = 4;

trial::MoveTiming timing_of(const trial::ErrorBands& bands) {
  return {.sample_time = 1e-3, .samples = 400, .dwell = 20, .window = 50, .bands = bands, .number = 0};
}

/// The outcome of a move with these errors (counts) at its samples, measured with these error bands.
trial::MoveOutcome measured(const std::vector<std::int64_t>& errors, const trial::ErrorBands& bands) {
  trial::MoveMeasures measures(timing_of(bands), 0);
  for (const std::int64_t error : errors) measures.add({.target = 0, .count = -error});
  measures.finish(false, 0, true);
  return measures.outcome();
}

/// Random errors, in units finer than a count, of a move that decays and jitters, and may come to rest.
std::vector<std::int64_t> drawn_errors(testing::Draws& draws) {
  std::vector<std::int64_t> errors;
  double error = draws.sign() * draws.uniform(10.0, 200.0);
  const double decay = draws.uniform(0.8, 0.99);
  const double jitter = draws.log_uniform(0.1, 8.0);
  for (int k = 0; k < 400; ++k) {
    error *= decay;
    errors.push_back(std::llround(error + (k == 0 ? 0.0 : jitter * draws.normal())));
  }
  return errors;
}

// |e| ≤ b in counts of the study is |e'| ≤ 4b + 2 in finer ones.
TEST(FinerEncoder, KeepsTheLengthOfEveryBand) {
  for (std::int64_t finer = -50; finer <= 50; ++finer) {
    const std::int64_t error = error_in_study_counts(finer, counts);
    for (std::int64_t band = 0; band < 10; ++band)
      EXPECT_EQ(std::abs(error) <= band, std::abs(finer) <= counts * band + counts / 2) << finer;
    EXPECT_GE(error * finer, 0);
  }
}

// Measured by the finer encoder and told in counts of the study, a move has the measures of the same errors
// in counts of the study.
TEST(FinerEncoder, MeasuresErrorsInCountsOfTheStudy) {
  testing::Draws draws(7);
  const trial::ErrorBands of_study{.limits = {0, 2, 5}, .count = 3};
  int arrived = 0;
  int jerks = 0;
  for (int move = 0; move < 500; ++move) {
    const std::vector<std::int64_t> errors = drawn_errors(draws);
    std::vector<std::int64_t> in_counts;
    for (const std::int64_t error : errors) in_counts.push_back(error_in_study_counts(error, counts));
    const trial::ErrorBands bands = finer_bands(of_study, counts).value();
    const trial::MoveOutcome told =
        in_study_units(measured(errors, bands), {.counts = counts}, of_study, timing_of(bands));
    const trial::MoveOutcome wanted = measured(in_counts, of_study);
    EXPECT_EQ(told.arrived, wanted.arrived);
    EXPECT_EQ(told.stable, wanted.stable);
    EXPECT_EQ(told.arrival, wanted.arrival);
    EXPECT_EQ(told.jerk_count, wanted.jerk_count);
    EXPECT_EQ(told.overshoot, wanted.overshoot);
    EXPECT_EQ(told.midway_error, wanted.midway_error);
    EXPECT_EQ(told.final_error, wanted.final_error);
    EXPECT_EQ(trial::is_success(told.outcome), trial::is_success(wanted.outcome));
    EXPECT_EQ(told.outcome == trial::Outcome::one_count, wanted.outcome == trial::Outcome::one_count);
    EXPECT_THAT(told.arrival_time, ::testing::NanSensitiveDoubleEq(wanted.arrival_time));
    EXPECT_THAT(told.final_settling_time, ::testing::NanSensitiveDoubleEq(wanted.final_settling_time));
    for (std::size_t band = 0; band < of_study.count; ++band) {
      EXPECT_THAT(told.bands[band].entry_time,
                  ::testing::NanSensitiveDoubleEq(wanted.bands[band].entry_time));
      EXPECT_THAT(told.bands[band].settling_time,
                  ::testing::NanSensitiveDoubleEq(wanted.bands[band].settling_time));
      EXPECT_EQ(told.bands[band].exits, wanted.bands[band].exits);
    }
    arrived += wanted.arrived ? 1 : 0;
    jerks += wanted.jerk_count > 0 ? 1 : 0;
  }
  EXPECT_GT(arrived, 100);
  EXPECT_LT(arrived, 450);
  EXPECT_GT(jerks, 50);
}

// A length that a study measures in counts is told in its counts, whatever the measure; each once.
TEST(FinerEncoder, ScalesEveryLengthInCountsOnce) {
  trial::MoveOutcome finer;
  for (const layout::Measure& measure : layout::move_measures()) {
    if (measure.field.column.unit != std::string("count")) continue;
    if (const auto* whole = std::get_if<std::int64_t trial::MoveOutcome::*>(&measure.field.member))
      finer.*(*whole) = -41;
    if (const auto* real = std::get_if<double trial::MoveOutcome::*>(&measure.field.member))
      finer.*(*real) = -41.0;
  }
  finer.outcome = trial::Outcome::oscillating;
  const trial::ErrorBands bands = finer_bands({}, counts).value();
  const trial::MoveOutcome told = in_study_units(finer, {.counts = counts}, {}, timing_of(bands));
  int lengths = 0;
  for (const layout::Measure& measure : layout::move_measures()) {
    if (measure.field.column.unit != std::string("count")) continue;
    ++lengths;
    const bool whole = std::holds_alternative<std::int64_t trial::MoveOutcome::*>(measure.field.member);
    EXPECT_EQ(layout::value_of(measure.field, told), whole ? -10.0 : -10.25) << measure.field.column.name;
  }
  EXPECT_GE(lengths, 12);
}

// Lengths of time in samples are told in samples of the study.
TEST(FinerEncoder, CountsTheArrivalInSamplesOfTheStudy) {
  trial::MoveOutcome finer;
  finer.arrival = 41;
  EXPECT_EQ(in_study_units(finer, {.samples = 2}, {}, timing_of({})).arrival, 21);
  finer.arrival = -1;
  EXPECT_EQ(in_study_units(finer, {.samples = 2}, {}, timing_of({})).arrival, -1);
}

}  // namespace
}  // namespace zerocount::tuning
