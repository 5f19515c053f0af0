// The statistics of a design point whose trials were collected in pieces.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/divergence.hpp"
#include "results/layout/fields.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::measures {
namespace {

struct JerkingTrial {
  trial::TrialOutcome outcome;
  std::vector<trial::Jerk> jerks;
};

trial::Outcome random_outcome(testing::Draws& draws) {
  constexpr std::array outcomes{trial::Outcome::zero_count,  trial::Outcome::zero_count,
                                trial::Outcome::one_count,   trial::Outcome::off_target,
                                trial::Outcome::oscillating, trial::Outcome::nonfinite};
  return outcomes.at(static_cast<std::size_t>(draws.uniform(0.0, 6.0)));
}

trial::MoveOutcome random_move(testing::Draws& draws, bool open_loop) {
  constexpr double sample_time = 0.001;
  trial::MoveOutcome move;
  move.outcome = open_loop ? trial::Outcome::open_loop : random_outcome(draws);
  if (draws.chance(0.1)) move.outcome = trial::Outcome::nonfinite;
  if (!open_loop && draws.chance(0.05)) return trial::move_not_run();
  move.arrived = !open_loop && draws.chance(0.8);
  move.stable = move.arrived && draws.chance(0.9);
  move.broke_away = draws.chance(0.3);
  if (move.arrived) move.arrival_time = sample_time * std::floor(draws.uniform(10.0, 60.0));
  if (move.arrived) move.zero_fraction = draws.uniform(0.0, 1.0);
  move.overshoot = static_cast<std::int64_t>(draws.uniform(0.0, 9.0));
  move.final_error = static_cast<std::int64_t>(draws.uniform(-3.0, 3.0));
  move.true_error = draws.uniform(-1.0, 1.0);
  move.final_position = draws.uniform(-1.0, 1.0) * 1e-4;
  move.holding_torque = draws.uniform(-0.02, 0.02);
  move.peak_torque = draws.log_uniform(1e-3, 1.0);
  move.creep = draws.log_uniform(1e-12, 1e-5);
  return move;
}

JerkingTrial random_trial(testing::Draws& draws, std::size_t moves, bool open_loop) {
  JerkingTrial trial;
  for (std::size_t i = 0; i < moves; ++i) {
    trial::MoveOutcome& move = trial.outcome.moves.emplace_back(random_move(draws, open_loop));
    double onset = 0.0;
    while (move.arrived && draws.chance(0.6)) {
      onset += 0.001 * std::floor(draws.uniform(1.0, 20.0));
      trial.jerks.push_back({static_cast<std::int64_t>(i), onset, 0.001,
                             draws.chance(0.7) ? std::int64_t{1} : std::int64_t{2},
                             draws.chance(0.5) ? 1 : -1});
      ++move.jerk_count;
    }
  }
  return trial;
}

/// The accumulated statistics of 50 random trials of a design point.
PointAccumulator random_point(testing::Draws& draws, const MoveKind& kind, std::size_t moves) {
  PointAccumulator point(kind);
  for (int i = 0; i < 50; ++i) {
    const JerkingTrial trial = random_trial(draws, moves, kind.open_loop);
    point.add(trial.outcome, trial.jerks);
  }
  return point;
}

/// The bits of all statistics of a design point: its row, the bounds of means, and its quantiles at all
/// levels.
std::vector<std::uint64_t> all_statistics(const PointAccumulator& point) {
  StatisticsOptions options;
  options.bootstrap = {7, 3};
  const PointSummary summary = point.statistics(options);
  std::vector<std::uint64_t> bits;
  for (const StatisticField& field : statistic_fields())
    bits.push_back(std::bit_cast<std::uint64_t>(field.value(summary)));
  for (const StatisticField& field : mean_bound_fields({}))
    bits.push_back(std::bit_cast<std::uint64_t>(field.value(summary)));
  for (const LevelStatistics& level : summary.levels)
    for (const LevelField& field : level_fields())
      bits.push_back(std::bit_cast<std::uint64_t>(field.value(level)));
  return bits;
}

/// The bits of the numbers, so that NaN can be compared too.
std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

/// The accumulated statistics after their state was saved and restored.
PointAccumulator restored(const PointAccumulator& sum, const MoveKind& kind, std::size_t moves_of_trial) {
  const auto moves = static_cast<std::int64_t>(moves_of_trial);
  const statistics::State state = sum.state();
  PointAccumulator point(kind);
  point.restore(state.whole, state.real, moves);
  return point;
}

TEST(DividedPoint, PartsMergeToTheStatisticsOfTheWholePoint) {
  testing::Draws draws(2304);
  for (int round = 0; round < 24; ++round) {
    const bool open_loop = round % 4 == 3;
    const MoveKind kind{.open_loop = open_loop, .shape = {.machines = round % 3 == 1 ? 7 : 0}};
    const auto moves = static_cast<std::size_t>(draws.uniform(1.0, 4.0));
    std::vector<JerkingTrial> trials;
    for (int i = 0; i < 210; ++i) trials.push_back(random_trial(draws, moves, open_loop));

    PointAccumulator whole(kind);
    for (const JerkingTrial& trial : trials) whole.add(trial.outcome, trial.jerks);

    PointAccumulator sum(kind);
    for (std::size_t first = 0; first < trials.size();) {
      const std::size_t end =
          std::min(trials.size(), first + static_cast<std::size_t>(draws.uniform(0.0, 90.0)));
      PointAccumulator piece(kind, layout::measure_table(), static_cast<std::int64_t>(first));
      for (; first < end; ++first) piece.add(trials[first].outcome, trials[first].jerks);
      sum += piece;
    }
    EXPECT_EQ(all_statistics(sum), all_statistics(whole)) << "round " << round;
    EXPECT_EQ(all_statistics(restored(sum, kind, moves)), all_statistics(whole)) << "round " << round;
    EXPECT_EQ(sum.state().whole, whole.state().whole);
    EXPECT_EQ(bits_of(sum.state().real), bits_of(whole.state().real));
  }
}

// Measures are added by columns of many trials.
TEST(DividedPoint, PartsMergeToTheStatisticsOfTrialsAddedOneByOne) {
  testing::Draws draws(2308);
  for (int round = 0; round < 24; ++round) {
    const bool open_loop = round % 4 == 3;
    const MoveKind kind{.open_loop = open_loop, .shape = {.machines = round % 3 == 1 ? 7 : 0}};
    const auto of_trial = static_cast<std::size_t>(round % 2 == 0 ? 1.0 : draws.uniform(1.0, 4.0));
    PointAccumulator one_by_one(kind), together(kind);
    std::vector<JerkingTrial> trials;
    for (int i = 0; i < 1500; ++i) {
      trials.push_back(random_trial(draws, of_trial, open_loop));
      one_by_one.add(trials.back().outcome, trials.back().jerks);
    }
    for (auto first = trials.cbegin(); first != trials.cend();) {
      const auto end = first + std::min(trials.cend() - first,
                                        static_cast<std::ptrdiff_t>(draws.log_uniform(1.0, 1400.0)));
      std::vector<const trial::MoveOutcome*> moves;
      for (; first != end; ++first) {
        together.add_counts(first->outcome.moves, first->jerks);
        for (const trial::MoveOutcome& move : first->outcome.moves) moves.push_back(&move);
      }
      together.add_measures(moves, of_trial);
    }
    EXPECT_EQ(together.state().whole, one_by_one.state().whole) << "round " << round;
    EXPECT_EQ(bits_of(together.state().real), bits_of(one_by_one.state().real)) << "round " << round;
  }
}

/// Statistics of a measure, computed directly from its definition. Moves are in the order of the trials.
struct PlainStatistics {
  /// Number of trials that have the quality which the measure counts, or a value above 0.
  std::int64_t trials{0};
  std::vector<std::int64_t> by_move;
  /// Values of the moves; for a measure that sums over a trial: values of the trials.
  std::vector<double> values;
};

PlainStatistics plain_statistics(const layout::Measure& measure, const std::vector<JerkingTrial>& trials) {
  PlainStatistics result;
  for (const JerkingTrial& trial : trials) {
    const std::vector<trial::MoveOutcome>& moves = trial.outcome.moves;
    result.by_move.resize(moves.size());
    bool some = false, every = true;
    double sum = 0.0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const double value = layout::value_of(measure.field, moves[i]);
      const bool has = measure.field.column.name == "outcome" ? moves[i].outcome == trial::Outcome::zero_count
                                                              : value != 0.0;
      result.by_move[i] += has ? 1 : 0;
      some = some || has;
      every = every && has;
      sum += value;
      const bool was_lost = measure.values.needs_motion && moves[i].outcome == trial::Outcome::nonfinite;
      const bool was_not_run = moves[i].stopped && std::isnan(moves[i].final_position);
      if (measure.reduction != layout::MoveReduction::sum && !was_lost && !was_not_run && !std::isnan(value))
        result.values.push_back(measure.values.magnitude ? std::abs(value) : value);
    }
    if (measure.reduction == layout::MoveReduction::all) result.trials += every ? 1 : 0;
    if (measure.reduction == layout::MoveReduction::any) result.trials += some ? 1 : 0;
    if (measure.reduction == layout::MoveReduction::sum && !std::isnan(sum)) {
      result.values.push_back(sum);
      result.trials += sum > 0.0 ? 1 : 0;
    }
  }
  return result;
}

TEST(DividedPoint, PartsMergeToTheSumsAndQualitiesOfEachTrial) {
  testing::Draws draws(2309);
  for (int round = 0; round < 16; ++round) {
    const MoveKind kind{.shape = {.machines = round % 3 == 1 ? 7 : 0}};
    const auto of_trial = static_cast<std::size_t>(draws.integer(1, 4));
    PointAccumulator point(kind);
    std::vector<JerkingTrial> trials;
    for (int i = 0; i < 700; ++i) {
      trials.push_back(random_trial(draws, of_trial, false));
      point.add(trials.back().outcome, trials.back().jerks);
    }
    const PointSummary summary = point.statistics();
    for (const layout::Measure& measure : *summary.table) {
      if (measure.point.texts.empty()) continue;
      SCOPED_TRACE(measure.field.column.name);
      const MeasureStatistics& found = summary.of(measure);
      const PlainStatistics plain = plain_statistics(measure, trials);
      if (layout::is_quality(measure)) {
        EXPECT_EQ(found.trials, plain.trials);
        EXPECT_EQ(found.by_move, plain.by_move);
        continue;
      }
      const auto n = std::ssize(plain.values);
      double sum = 0.0;
      for (const double value : plain.values) sum += value;
      EXPECT_EQ(found.n, n);
      if (measure.reduction == layout::MoveReduction::sum) {
        EXPECT_EQ(found.trials, plain.trials);
        EXPECT_EQ(found.total, std::llround(sum));
      }
      if (n == 0) continue;
      EXPECT_EQ(found.min, std::ranges::min(plain.values));
      EXPECT_EQ(found.max, std::ranges::max(plain.values));
      EXPECT_NEAR(found.mean, sum / static_cast<double>(n), 1e-12 * std::max(1.0, found.max - found.min));
    }
  }
}

TEST(DividedPoint, RefusesTheStateOfAnotherKindOfPoint) {
  testing::Draws draws(2305);
  const PointAccumulator point = random_point(draws, {}, 2);
  const statistics::State state = point.state();
  PointAccumulator other(MoveKind{.shape = {.machines = 5}});
  EXPECT_THROW(other.restore(state.whole, state.real, 2), Failure);
  EXPECT_THROW(PointAccumulator().restore(state.whole, state.real, 3), Failure) << "another number of moves";
  statistics::State shorter = state;
  shorter.real.pop_back();
  EXPECT_THROW(other.restore(shorter.whole, shorter.real, 2), Failure);
}

TEST(DividedPoint, RefusesCountsThatCancel) {
  testing::Draws draws(2306);
  const PointAccumulator point = random_point(draws, {}, 1);
  statistics::State state = point.state();
  constexpr std::size_t zero_count = 2, one_count = 3;  // after trials and moves
  state.whole[zero_count] += state.whole[one_count] + 8;
  state.whole[one_count] = -8;
  EXPECT_THROW(PointAccumulator().restore(state.whole, state.real, 1), Failure);
}

// A number that is changed is refused, or gives other statistics.
TEST(DividedPoint, AChangedStateIsRefusedOrHasStatistics) {
  testing::Draws draws(2307);
  int refused = 0;
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    const MoveKind kind{.open_loop = round % 5 == 4, .shape = {.machines = round % 2 == 1 ? 7 : 0}};
    statistics::State changed = random_point(draws, kind, 2).state();
    const auto place =
        static_cast<std::size_t>(draws.uniform(0.0, static_cast<double>(changed.whole.size())));
    const std::int64_t before = changed.whole[place];
    const std::array<std::int64_t, 6> others{
        before + 1, before - 1, -before, 0, -1, static_cast<std::int64_t>(draws.uniform(-9e18, 9e18))};
    changed.whole[place] = others.at(static_cast<std::size_t>(draws.uniform(0.0, 6.0)));
    PointAccumulator read(kind);
    try {
      read.restore(changed.whole, changed.real, 2);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_data);
      ++refused;
      continue;
    }
    EXPECT_NO_THROW(all_statistics(read)) << "number " << place << " of " << changed.whole.size() << ": "
                                          << before << " became " << changed.whole[place];
  }
  EXPECT_GT(refused, rounds / 4);
}

}  // namespace
}  // namespace zerocount::measures
