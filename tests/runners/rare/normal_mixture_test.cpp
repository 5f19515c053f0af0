#include "experiments/designs/random_key.hpp"
#include "runners/rare/proposal.hpp"
#include "tests/support/test.hpp"

namespace zerocount::rare {
namespace {

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

// The mean of a likelihood ratio is 1, and it is at most the inverse of the natural share.
TEST(NormalMixture, WeightsHaveTheMeanOne) {
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

}  // namespace
}  // namespace zerocount::rare
