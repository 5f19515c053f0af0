#include "runners/rare/estimator.hpp"

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/designs/designs.hpp"
#include "runners/rare/proposal.hpp"
#include "runners/rare/rare_run.hpp"
#include "tests/support/test.hpp"

namespace zerocount::rare {
namespace {

using Score = std::function<double(const std::vector<double>&)>;

/// A made-up failure with a known probability: a trial fails if `score` of its coordinates exceeds 0.
struct ClosedForm {
  std::string name;
  std::size_t coordinates;
  double probability;
  Score score;
};

Simulation simulation_of(const Score& score) {
  return [score](std::span<Trial> trials) {
    for (Trial& trial : trials) {
      const double value = score(trial.z);
      trial.failed = value > 0.0 ? 1.0 : 0.0;
      trial.scores = {value};
    }
  };
}

/// A failure if the sum of all coordinates exceeds a limit, which it does with probability p.
ClosedForm plane(double p) {
  const double limit = -numerics::normal_quantile(p);
  return {fmt::format("plane {}", p), 6, p, [limit](const std::vector<double>& z) {
            double sum = 0.0;
            for (const double x : z) sum += x;
            return sum / std::sqrt(static_cast<double>(z.size())) - limit;
          }};
}

ClosedForm two_planes(double p) {
  const double limit = -numerics::normal_quantile(0.5 * p);
  return {fmt::format("two planes {}", p), 4, p,
          [limit](const std::vector<double>& z) { return std::abs(z[1]) - limit; }};
}

/// A failure if the point lies outside a circle, with P(χ² with 2 degrees of freedom > x) = exp(−x/2).
ClosedForm circle(double p) {
  const double limit = -2.0 * numerics::log(p);
  return {fmt::format("circle {}", p), 5, p,
          [limit](const std::vector<double>& z) { return z[0] * z[0] + z[3] * z[3] - limit; }};
}

ClosedForm corner(double p) {
  const double limit = -numerics::normal_quantile(std::sqrt(p));
  return {fmt::format("corner {}", p), 8, p,
          [limit](const std::vector<double>& z) { return std::min(z[2], z[5]) - limit; }};
}

bool goes_on(const EstimatorState& state) {
  return state.trials < 300'000;
}

EstimatorSettings settings_of(const ClosedForm& one, std::uint64_t seed) {
  return {.space = trial_space(one.coordinates, {}), .seed = seed};
}

/// Summary of repeated estimates with the seeds 1, 2, …, all of which end with bounds as narrow as asked.
struct Repetitions {
  int held{0};       ///< number of estimates whose bounds contain the true probability
  double mean{0.0};  ///< mean of the estimates
  std::int64_t most_trials{0};
};

Repetitions repeated(std::uint64_t seeds, const TrialSpace& space, const Score& score, double probability,
                     std::int64_t budget) {
  Repetitions all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    EstimatorState state;
    const ProbabilityEstimate answer =
        estimate(state, {.space = space, .seed = seed}, simulation_of(score),
                 [budget](const EstimatorState& now) { return now.trials < budget; });
    EXPECT_EQ(answer.status, EstimateStatus::estimated) << seed;
    EXPECT_LE(answer.bounds.high, 2.0 * answer.bounds.low) << seed;
    all.held += answer.bounds.low <= probability && probability <= answer.bounds.high;
    all.mean += answer.probability / static_cast<double>(seeds);
    all.most_trials = std::max(all.most_trials, state.trials);
  }
  return all;
}

class RareEstimatorByProblem : public testing::TestWithParam<ClosedForm> {};

// Bounds of 95 % fail in at most 2 of 6 repetitions, but for one time in 450.
TEST_P(RareEstimatorByProblem, BoundsContainTheClosedForm) {
  const ClosedForm& one = GetParam();
  const Repetitions all = repeated(6, trial_space(one.coordinates, {}), one.score, one.probability, 300'000);
  EXPECT_GE(all.held, 4);
  EXPECT_LT(all.most_trials, 150'000);
  EXPECT_NEAR(all.mean / one.probability, 1.0, 0.17);
}

INSTANTIATE_TEST_SUITE_P(ClosedForms, RareEstimatorByProblem,
                         testing::Values(plane(1e-4), plane(1e-8), two_planes(1e-5), two_planes(1e-8),
                                         circle(1e-4), circle(1e-6), corner(1e-5), corner(1e-8)),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

// The first score says nothing, the second leads to the failure.
TEST(RareEstimator, ChoosesTheScoreThatLeadsToFailures) {
  const ClosedForm one = plane(1e-6);
  const Simulation simulate = [&](std::span<Trial> trials) {
    simulation_of(one.score)(trials);
    for (Trial& trial : trials) trial.scores = {trial.z[0] > 0.0 ? 1.0 : 0.0, trial.scores[0]};
  };
  EstimatorState state;
  const ProbabilityEstimate answer =
      estimate(state, {.space = trial_space(one.coordinates, {}), .scores = 2, .seed = 3}, simulate, goes_on);
  EXPECT_EQ(answer.status, EstimateStatus::estimated);
  EXPECT_TRUE(answer.bounds.low <= 1e-6 && 1e-6 <= answer.bounds.high);
  EXPECT_FALSE(state.searches.front().reached);
  EXPECT_TRUE(state.searches.back().reached);
}

/// A discrete draw of a row of a table: coordinate `coordinate` chooses one of `count` rows.
randomness::DiscreteDraw rows(std::size_t coordinate, std::int64_t count) {
  return {.name = "rows", .direction = {{coordinate, 1.0}}, .rows = count};
}

/// A discrete draw from a choice of `count` different values that are not sorted.
randomness::DiscreteDraw scattered(std::size_t coordinate, std::int64_t count) {
  randomness::DiscreteDraw draw = rows(coordinate, count);
  for (std::int64_t row = 0; row < count; ++row) {
    draw.values_of_rows.push_back(static_cast<std::uint32_t>(row * 7919 % count));
    draw.numbers.push_back(static_cast<double>(row));
  }
  return draw;
}

/// A discrete draw from a choice of `count` entries, one of which is 1 and the others are 0.
randomness::DiscreteDraw one_of(std::size_t coordinate, std::int64_t count) {
  randomness::DiscreteDraw draw = rows(coordinate, count);
  draw.values_of_rows.assign(static_cast<std::size_t>(count), 0);
  draw.values_of_rows[static_cast<std::size_t>(count / 3)] = 1;
  draw.numbers = {0.0, 1.0};
  return draw;
}

randomness::DiscreteDraw integers(std::size_t coordinate, std::int64_t count) {
  randomness::DiscreteDraw draw = rows(coordinate, count);
  draw.ordered = true;
  return draw;
}

/// A discrete draw from a choice of `count` values whose random number is correlated with another coordinate.
randomness::DiscreteDraw correlated(std::size_t coordinate, std::int64_t count) {
  randomness::DiscreteDraw draw = scattered(coordinate, count);
  draw.direction = {{0, 0.6}, {coordinate, 0.8}};
  return draw;
}

struct FailingValue {
  std::string name;
  randomness::DiscreteDraw draw;
  std::int64_t value;
  double given_value;  ///< probability of a failure if the draw gives this value
};

void PrintTo(const FailingValue& one, std::ostream* out) {
  *out << one.name;
}

// One value of 20 000 brings a trial nearer to the failure, which then happens in one of 30 trials: that is
// more than all other values together.
TEST(RareEstimator, FindsAValueThatOnlyLeadsToFailures) {
  const randomness::DiscreteDraw draw = scattered(2, 20'000);
  const ClosedForm other = plane(1e-6);
  const double limit = -numerics::normal_quantile(1e-6);
  const double shift = limit + numerics::normal_quantile(1.0 / 30.0);
  const Score score = [&](const std::vector<double>& z) {
    return other.score(z) + (randomness::value_at(draw, z) == 4321 ? shift : 0.0);
  };
  const double probability = 1.0 / 30.0 / 20'000.0 + other.probability;
  EXPECT_GE(repeated(6, trial_space(other.coordinates, {draw}), score, probability, 1'000'000).held, 5);
}

class RareEstimatorAtValue : public testing::TestWithParam<FailingValue> {};

// One value of 10 000 or 20 000 fails, far from all others. Beside it there is a failure, forty times rarer,
// to which the score leads, so that an estimate of that one alone would look fine.
TEST_P(RareEstimatorAtValue, BoundsContainTheProbability) {
  const FailingValue& one = GetParam();
  const ClosedForm other = plane(1.25e-6);
  const double limit = one.given_value < 1.0 ? -numerics::normal_quantile(one.given_value) : -100.0;
  const Score score = [&](const std::vector<double>& z) {
    if (randomness::value_at(one.draw, z) == one.value && z[4] > limit) return 1.0;
    return other.score(z);
  };
  const double probability = one.given_value / static_cast<double>(one.draw.rows) + other.probability;
  const Repetitions all =
      repeated(6, trial_space(other.coordinates, {one.draw}), score, probability, 1'000'000);
  EXPECT_EQ(all.held, 6);
  EXPECT_LT(all.most_trials, 250'000);
}

INSTANTIATE_TEST_SUITE_P(Draws, RareEstimatorAtValue,
                         testing::Values(FailingValue{"rows", rows(2, 20'000), 7341, 1.0},
                                         FailingValue{"scattered_choice", scattered(2, 20'000), 11, 1.0},
                                         FailingValue{"one_of_two_values", one_of(3, 10'000), 1, 0.5},
                                         FailingValue{"integers", integers(1, 20'000), 20, 1.0},
                                         FailingValue{"correlated_choice", correlated(2, 10'000), 5, 1.0}),
                         [](const auto& info) { return info.param.name; });

// Three of 200 rows fail, wherever they stand in the table: neighbours of a row say nothing about it.
TEST(RareEstimator, RowsOfATableKeepTheirProbability) {
  const double limit = -numerics::normal_quantile(1e-4);
  const Score score = [limit](const std::vector<double>& z) {
    const auto row = static_cast<int>(200.0 * numerics::normal_probability(z[1]));
    return z[0] - limit - (row == 17 || row == 93 || row == 185 ? 0.0 : 4.0);
  };
  const double probability = 3.0 / 200.0 * 1e-4 + 197.0 / 200.0 * numerics::normal_probability(-limit - 4.0);
  EXPECT_GE(repeated(8, trial_space(3, {rows(1, 200)}), score, probability, 300'000).held, 7);
}

TEST(RareEstimator, AFailureThatAlwaysHappensHasProbabilityOne) {
  EstimatorState state;
  const ProbabilityEstimate answer = estimate(state, {.space = trial_space(2, {}), .seed = 1},
                                              simulation_of([](const auto&) { return 1.0; }), goes_on);
  EXPECT_EQ(answer.status, EstimateStatus::estimated);
  EXPECT_GT(answer.bounds.low, 0.5);
  EXPECT_EQ(answer.bounds.high, 1.0);
}

// A failure by chance alone, whatever the coordinates: plain trials are as good as any, and are what is run.
TEST(RareEstimator, ACommonFailureIsEstimatedByPlainTrials) {
  const Simulation simulate = [](std::span<Trial> trials) {
    for (Trial& trial : trials) {
      const double u = NumberSource({static_cast<std::uint32_t>(trial.number), 5}).uniform();
      trial.failed = u < 0.002 ? 1.0 : 0.0;
      trial.scores = {-u};
    }
  };
  EstimatorState state;
  const ProbabilityEstimate answer =
      estimate(state, {.space = trial_space(4, {}), .seed = 1}, simulate, goes_on);
  EXPECT_EQ(answer.status, EstimateStatus::estimated);
  EXPECT_TRUE(answer.bounds.low <= 0.002 && 0.002 <= answer.bounds.high);
  EXPECT_TRUE(state.proposal.components.empty());
}

// Failures that the learned distribution does not foresee make it learn again: here it was learned from one
// of two planes.
TEST(RareEstimator, LearnsAgainAfterUnexpectedFailures) {
  const double probability = 0.1;
  const ClosedForm one = two_planes(probability);
  int learned_again = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    EstimatorState state;
    state.learned = true;
    state.learnings = 1;
    std::vector<double> factor(16, 0.0);
    for (std::size_t i = 0; i < 4; ++i) factor[5 * i] = i == 1 ? 0.6 : 1.0;
    state.proposal = {.natural = 0.1, .components = {normal_component(1.0, {0.0, 2.0, 0.0, 0.0}, factor)}};
    state.cap = 1.0;
    const ProbabilityEstimate answer =
        estimate(state, settings_of(one, seed), simulation_of(one.score), goes_on);
    EXPECT_LE(answer.bounds.low, probability) << seed;
    if (state.learnings == 1) continue;
    ++learned_again;
    EXPECT_EQ(answer.status, EstimateStatus::estimated) << seed;
    EXPECT_GE(answer.bounds.high, probability) << seed;
    EXPECT_GT(state.proposal.components.size(), 1U) << seed;
  }
  EXPECT_GE(learned_again, 6);
}

// A search that the budget ended has found nothing out.
TEST(RareEstimator, ABudgetThatEndsTheSearchLeavesItUndecided) {
  const ClosedForm one = plane(1e-6);
  EstimatorState state;
  const ProbabilityEstimate answer = estimate(state, settings_of(one, 1), simulation_of(one.score),
                                              [](const EstimatorState& now) { return now.trials < 4000; });
  EXPECT_EQ(answer.status, EstimateStatus::budget);
  const ProbabilityEstimate whole = estimate(state, settings_of(one, 1), simulation_of(one.score), goes_on);
  EXPECT_EQ(whole.status, EstimateStatus::estimated);
  EXPECT_TRUE(whole.bounds.low <= 1e-6 && 1e-6 <= whole.bounds.high);
}

// A failure that jumps out of nowhere is not found: the answer is the bound of the plain trials, to which the
// whole budget goes.
TEST(RareEstimator, IsUndecidedIfNoScoreLeadsToAFailure) {
  const Simulation simulate = [](std::span<Trial> trials) {
    for (Trial& trial : trials) trial.scores = {0.0};
  };
  EstimatorState state;
  const ProbabilityEstimate answer =
      estimate(state, {.space = trial_space(3, {}), .seed = 1}, simulate, goes_on);
  EXPECT_EQ(answer.status, EstimateStatus::no_failure);
  EXPECT_EQ(answer.bounds.low, 0.0);
  EXPECT_GE(state.plain_trials, 290'000);
  EXPECT_LT(answer.bounds.high, 9.0 / static_cast<double>(state.plain_trials));  // at all times; 3.7 at one
}

TEST(RareEstimator, AnInterruptedEstimateEndsWithTheSameResult) {
  const ClosedForm one = circle(1e-5);
  const EstimatorSettings settings{.space = trial_space(one.coordinates, {}), .ratio = 1.3, .seed = 5};
  EstimatorState whole;
  const ProbabilityEstimate expected = estimate(whole, settings, simulation_of(one.score), goes_on);
  EstimatorState state;
  int asked_learned = 0;
  const ProbabilityEstimate part =
      estimate(state, settings, simulation_of(one.score),
               [&](const EstimatorState& now) { return !now.learned || ++asked_learned < 3; });
  EXPECT_EQ(part.status, EstimateStatus::budget);
  const ProbabilityEstimate answer = estimate(state, settings, simulation_of(one.score), goes_on);
  EXPECT_EQ(answer.bounds.low, expected.bounds.low);
  EXPECT_EQ(answer.probability, expected.probability);
  EXPECT_EQ(state.trials, whole.trials);
}

NumberSource numbers_of(std::uint64_t seed) {
  return NumberSource(designs::random_key(seed, "test"));
}

/// Points around two centres, 3 to the left and 4 to the right in the first coordinate.
WeightedPoints two_clusters(NumberSource& numbers) {
  WeightedPoints points;
  for (int i = 0; i < 600; ++i) {
    std::vector<double> z = numbers.normals(4);
    z[0] = 0.3 * z[0] + (i % 3 == 0 ? -3.0 : 4.0);
    points.add(z, 1.0);
  }
  return points;
}

// The mean of a likelihood ratio is 1, and it is at most the inverse of the natural proportion.
TEST(NormalMixture, ImportanceWeightsHaveTheMeanOne) {
  NumberSource numbers = numbers_of(1);
  const TrialSpace space = trial_space(4, {});
  const Proposal proposal{.natural = 0.1, .components = fitted_mixture(two_clusters(numbers), numbers)};
  double sum = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const double weight = likelihood_ratio(space, proposal, draw(space, proposal, numbers).z);
    sum += weight;
    largest = std::max(largest, weight);
  }
  EXPECT_NEAR(sum / 200'000.0, 1.0, 0.03);
  EXPECT_LE(largest, 10.0);
}

TEST(NormalMixture, FindsTwoClusters) {
  NumberSource numbers = numbers_of(2);
  const std::vector<NormalComponent> found = fitted_mixture(two_clusters(numbers), numbers);
  ASSERT_EQ(found.size(), 2U);
  const bool first_is_left = found[0].mean[0] < 0.0;
  const NormalComponent& left = found[first_is_left ? 0 : 1];
  const NormalComponent& right = found[first_is_left ? 1 : 0];
  EXPECT_NEAR(left.weight, 1.0 / 3.0, 0.01);
  EXPECT_NEAR(left.mean[0], -3.0, 0.1);
  EXPECT_NEAR(right.mean[0], 4.0, 0.1);
  // Twice the variance 0.09 in the narrow direction, nearly the variance 1 in the others.
  EXPECT_NEAR(left.factor[0], std::sqrt(0.19), 0.06);
  EXPECT_NEAR(left.factor[5], std::sqrt(1.16), 0.15);
}

TEST(NormalMixture, AHeavyPointCountsAsManyLightOnes) {
  NumberSource numbers = numbers_of(3);
  WeightedPoints points;
  for (int i = 0; i < 300; ++i) points.add({2.0}, 3.0);
  for (int i = 0; i < 300; ++i) points.add({6.0}, 1.0);
  EXPECT_NEAR(fitted_normal(points, numbers).mean[0], 3.0, 0.05);
  EXPECT_NEAR(effective_size(points.weights), 480.0, 1e-9);
  for (int i = 0; i < 3000; ++i) points.add({6.0}, 0.1);  // more than a fit takes
  EXPECT_NEAR(fitted_normal(points, numbers).mean[0], 3.6, 0.15);
}

// The figure of `rare`: where failures lie in the range of all trials.

TEST(RareFigure, PlacesFailuresInTheRangeOfAllTrials) {
  const FailureInput stiffness{"friction.k1", "N m/rad", 2.0, {100.0, 110.0, 120.0}, {115.0, 120.0, 130.0}};
  const FailureInput constant{"dac.bits", "1", 0.4, {12.0, 12.0, 12.0}, {12.0, 12.0, 12.0}};
  const std::vector<document::Figure> figures = rare_figures({stiffness, constant});
  ASSERT_EQ(figures.size(), 1U);
  const auto& rows = figures[0].data[0].rows;
  ASSERT_EQ(rows.size(), 2U) << "of the input that varies";
  EXPECT_EQ(rows[0].dump(), R"(["friction.k1","all trials",100,110,120,"N m/rad",0,0.5,1])");
  EXPECT_EQ(rows[1].dump(), R"(["friction.k1","failures",115,120,130,"N m/rad",0.75,1,1.5])");
  EXPECT_TRUE(rare_figures({constant}).empty());
}

}  // namespace
}  // namespace zerocount::rare
