// "Met" by intersection-union is wrong in at most 5 %, and takes fewer trials than Bonferroni's correction.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "analysis/trials/goal/goal_verdict.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::goal {
namespace {

/// A distribution of the proportion of moves in which a machine meets a goal, chosen so that the goal is just
/// missed. A goal on machines asks for 90 % of the moves of 80 % of the machines, a goal on moves for 90 % of
/// all moves.
struct Population {
  std::string name;
  /// Draws a machine's proportion of moves that meet the first goal.
  std::function<double(testing::Draws&, bool on_machines)> proportion;
};

std::vector<Population> populations() {
  const auto mixture = [](double part, double above, double below) {
    return [=](testing::Draws& draws, bool) { return draws.chance(part) ? above : below; };
  };
  return {{"all just below", [](testing::Draws&, bool) { return 0.8999; }},
          {"even",
           [](testing::Draws& draws, bool on_machines) {
             return on_machines ? draws.uniform(0.5001, 0.9999) : draws.uniform(0.7999, 0.9999);
           }},
          {"perfect or just below",
           [](testing::Draws& draws, bool on_machines) {
             return draws.chance(on_machines ? 0.7999 : 0.0) ? 1.0 : 0.8999;
           }},
          {"good or bad",
           [&](testing::Draws& draws, bool on_machines) {
             return draws.chance(on_machines ? 0.7999 : 0.7999) ? 0.9749 : 0.6;
           }},
          {"on the limit or useless", mixture(0.7999, 0.9, 0.2)}};
}

struct Case {
  std::size_t goals;
  std::int64_t machines;  ///< number of machines; 0: every trial is a machine of its own
  bool on_machines;       ///< the goals are claims about machines; false: about all moves
  bool correlated;  ///< each move meets or misses all goals together, as far as the goals' proportions allow
};

constexpr std::int64_t moves_of_machine = 20;
/// Number of trials that are machines of their own. With 379 trials the bounds of whole numbers of successes
/// are nearly exact: a claim of 90 % is wrong in 4.9 % of the studies at 95 % confidence, and in 9.9 % at 90
/// %.
constexpr std::int64_t trials_without_machines = 379;

/// Counts of a random study, one per goal: the first goal is met as the population says, the others are met
/// by all machines in 0.99 of their moves.
std::vector<measures::CellCounts> study_of(testing::Draws& draws, const Population& population,
                                           const Case& one) {
  std::vector<measures::CellCounts> counts(one.goals, measures::CellCounts({.machines = one.machines}));
  const std::int64_t machines = one.machines > 0 ? one.machines : trials_without_machines;
  for (std::int64_t machine = 0; machine < machines; ++machine) {
    const double first = population.proportion(draws, one.on_machines);
    for (std::int64_t move = 0; move < (one.machines > 0 ? moves_of_machine : 1); ++move) {
      const double common = draws.uniform(0.0, 1.0);
      for (std::size_t i = 0; i < one.goals; ++i) {
        const double own = one.correlated ? common : draws.uniform(0.0, 1.0);
        counts[i].add(machine + machines * move, 1, own < (i == 0 ? first : 0.99));
      }
    }
  }
  return counts;
}

/// Percentage of studies in which all goals are claimed to be met, although the first goal is not met.
/// @param confidence confidence of each goal's claim
double wrongly_met(const Population& population, const Case& one, int studies, double confidence = 0.95) {
  testing::Draws draws(23);
  std::vector<study::Goal> goals(one.goals,
                                 {.within = 0.05, .moves = 0.9, .machines = {}, .confidence = confidence});
  if (one.on_machines)
    for (study::Goal& goal : goals) goal.machines = 0.8;
  int met = 0;
  for (int study = 0; study < studies; ++study)
    met += judge_goals(goals, study_of(draws, population, one), 1).status == Status::met;
  return 100.0 * met / studies;
}

/// Largest acceptable percentage of wrong claims: 5 % and three standard errors. If 5 % are wrong, more than
/// that are found once in 400 times. A verdict on moves without machines that has 90 % confidence exceeds it
/// with a probability of 0.28 in 100 studies, 0.93 in 500 and 1 in 2000. Verdicts with machines are wrong in
/// at most 2 % of the studies, so that less confidence there is not seen.
double highest_percentage(int studies) {
  return 5.0 + 300.0 * std::sqrt(0.05 * 0.95 / studies);
}

void expect_rarely_wrong(int studies) {
  const double limit = highest_percentage(studies);
  for (const Case& one : {Case{2, 0, false, false}, Case{4, 0, false, true}, Case{2, 40, false, true},
                          Case{4, 40, false, false}, Case{2, 60, true, false}, Case{3, 60, true, true},
                          Case{4, 60, true, true}}) {
    std::string row =
        fmt::format("| {} goals on {}, {} machines{} |", one.goals, one.on_machines ? "machines" : "moves",
                    one.machines, one.correlated ? ", correlated" : "");
    for (const Population& population : populations()) {
      const double wrong = wrongly_met(population, one, studies);
      row += fmt::format(" {:.1f} |", wrong);
      EXPECT_LE(wrong, limit) << population.name << ": " << row;
    }
    fmt::print("{}\n", row);
  }
}

TEST(ClaimCoverage, AMetVerdictIsRarelyWrong) {
  expect_rarely_wrong(500);
}

TEST(ClaimCoverage, AVerdictWithLessConfidenceIsFoundWrong) {
  constexpr int studies = 500;
  EXPECT_GT(wrongly_met(populations()[0], {1, 0, false, false}, studies, 0.9), highest_percentage(studies));
}

TEST(ClaimCoverage, DISABLED_AMetVerdictIsRarelyWrongInManyStudies) {
  expect_rarely_wrong(2000);
}

// Independent trials meet each of the goals with 0.97, of which 0.95 is claimed.
TEST(ClaimCoverage, NeedsFewerTrialsThanBonferroni) {
  constexpr double asked = 0.95, truth = 0.97, power = 0.9;
  const auto trials_at = [&](std::size_t goals, std::size_t divided_by) {
    const study::Goal goal{.within = 0.05, .moves = asked, .machines = {}};
    const auto chance = [&](std::int64_t n) {  // of one goal
      const auto sd = std::sqrt(static_cast<double>(n) * truth * (1.0 - truth));
      std::int64_t least = n;
      for (std::int64_t met = n; met > static_cast<std::int64_t>(asked * static_cast<double>(n)); --met) {
        const auto k = static_cast<double>(met);
        const measures::MoveCounts counts{
            .moves = n, .met = met, .of_trials = {n, met, n, k, k, static_cast<double>(n)}, .machines = {}};
        if (judge_goal(goal, counts, divided_by).status != Status::met) break;
        least = met;
      }
      const double z = (static_cast<double>(least) - 0.5 - static_cast<double>(n) * truth) / sd;
      return 0.5 * std::erfc(z / std::sqrt(2.0));
    };
    std::int64_t n = 200;
    while (std::pow(chance(n), static_cast<double>(goals)) < power) n += 20;
    return n;
  };
  for (const std::size_t goals : {2U, 3U, 4U}) {
    const std::int64_t each = trials_at(goals, 1);
    const std::int64_t corrected = trials_at(goals, goals);
    fmt::print("| {} | {} | {} |\n", goals, each, corrected);
    EXPECT_LT(static_cast<double>(each), 0.92 * static_cast<double>(corrected)) << goals;
  }
}

}  // namespace
}  // namespace zerocount::goal
