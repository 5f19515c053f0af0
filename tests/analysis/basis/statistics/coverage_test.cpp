#include "tests/analysis/basis/statistics/coverage_simulation.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Smallest acceptable number of repetitions in which bounds cover: 94 % less three standard errors. Bounds
/// that cover 94 % fall below it once in 500 times, with 40 repetitions once in 100 times. The power is the
/// probability that bounds fall below it which cover less:
///
///   repetitions   power at 90 %   at 85 %
///       40             0.10        0.39
///      120             0.14        0.73
///      360             0.53        0.998
///      800             0.91        1
double lowest_count(std::int64_t repetitions) {
  const auto n = static_cast<double>(repetitions);
  return 0.94 * n - 3.0 * std::sqrt(n * 0.94 * 0.06);
}

/// Simulates the study for each population, and expects that every bound covers often enough.
/// @param repetitions number of simulated studies of each population
std::map<std::string, Coverage> expect_cover(const std::vector<Population>& populations, const Sample& sample,
                                             std::int64_t repetitions) {
  std::map<std::string, Coverage> all;
  for (const Population& population : populations) {
    for (const Coverage& one : coverage_of(population, sample, repetitions, 7)) {
      EXPECT_GE(static_cast<double>(one.covered), lowest_count(repetitions))
          << one.bound << ", standard deviation between machines " << population.success_sd;
      Coverage& sum = all[one.bound];
      sum.repetitions += one.repetitions;
      sum.covered += one.covered;
      sum.plainly = one.plainly < 0 ? -1 : std::max<std::int64_t>(sum.plainly, 0) + one.plainly;
    }
  }
  for (const auto& [bound, sum] : all)
    EXPECT_GE(static_cast<double>(sum.covered), lowest_count(sum.repetitions)) << bound;
  return all;
}

/// Number of studies of each population in the normal tests. They see gross errors only: see lowest_count().
constexpr std::int64_t few = 40;
/// Number of studies that show that plain bounds fail where machines differ.
constexpr std::int64_t more = 120;
/// Number of studies of each population in the long tests. They see bounds that cover 90 % instead of 95 %.
constexpr std::int64_t many = 800;

std::vector<Population> populations_of_machines() {
  std::vector<Population> populations;
  for (const double sd : {0.0, 0.1, 0.3}) {
    populations.push_back({.success_mean = sd < 0.2 ? 0.9 : 0.7,
                           .success_sd = sd,
                           .machine_effect = 2.0 * sd,
                           .trial_effect = 0.4,
                           .jerk_sd = 2.0 * sd});
  }
  return populations;
}

void expect_bounds_where_machines_differ(std::int64_t repetitions) {
  const auto found =
      expect_cover(populations_of_machines(), {.machines = 50, .trials = 500, .moves = 1}, repetitions);
  const auto plainly = [&](const char* bound) {
    return static_cast<double>(found.at(bound).plainly) / static_cast<double>(found.at(bound).repetitions);
  };
  EXPECT_LT(plainly("success"), 0.88);  // over sd 0, where they hold, 0.1 and 0.3
  EXPECT_LT(plainly("settling median"), 0.9);
  EXPECT_LT(plainly("settling mean"), 0.9);
}

void expect_bounds_where_machines_and_moves_differ(std::int64_t repetitions) {
  const auto found =
      expect_cover(populations_of_machines(), {.machines = 50, .trials = 250, .moves = 10}, repetitions);
  for (const char* bound : {"settling mean", "settling median", "settling p95"})
    EXPECT_LT(found.at(bound).plainly, 0.8 * static_cast<double>(found.at(bound).repetitions)) << bound;
}

void expect_bounds_where_moves_differ(std::int64_t repetitions) {
  const auto found =
      expect_cover({{.trial_effect = 0.8}, {.success_mean = 0.99, .trial_effect = 0.3, .jerks = 0.01}},
                   {.trials = 200, .moves = 10}, repetitions);
  for (const char* bound : {"settling mean", "settling median", "settling p95"})
    EXPECT_LT(found.at(bound).plainly, 0.9 * static_cast<double>(found.at(bound).repetitions)) << bound;
}

void expect_bounds_of_one_move(std::int64_t repetitions) {
  expect_cover({{.move_effect = 0.8}, {.success_mean = 0.99, .move_effect = 0.3, .jerks = 0.01}},
               {.trials = 200, .moves = 1}, repetitions);
}

TEST(Coverage, BoundsHoldIfMachinesDiffer) {
  expect_bounds_where_machines_differ(more);
}

TEST(Coverage, BoundsHoldIfMachinesAndTheirTrialsDiffer) {
  expect_bounds_where_machines_and_moves_differ(few);
}

TEST(Coverage, BoundsHoldIfTrialsOfSeveralMovesDiffer) {
  expect_bounds_where_moves_differ(few);
}

TEST(Coverage, BoundsHoldForTrialsOfOneMove) {
  expect_bounds_of_one_move(few);
}

TEST(Coverage, DISABLED_BoundsHoldInManyStudies) {
  expect_bounds_where_machines_differ(many);
  expect_bounds_where_machines_and_moves_differ(many);
  expect_bounds_where_moves_differ(many);
  expect_bounds_of_one_move(many);
}

}  // namespace
}  // namespace zerocount::testing
