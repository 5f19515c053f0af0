#include "core/hash/sha256.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::designs {
namespace {

constexpr std::uint64_t second_sample = std::uint64_t{1} << 55;

// Five factors: a real value, a whole one, a choice, a target, and noise.
const std::string five_factors =
    "friction: {k1: {uniform: [100, 120]}, k2: {lognormal: {median: 700, cv: 0.1}}}\n"
    "controller: {delay: {choice: [0, 1, 2]}}\n"
    "encoder: {fine_errors: {noise: 0.1}}\n";

study::Study five_factor_study(const std::string& design, const std::string& trials) {
  return study_of(manifest_commanding("{targets: [{integers: [1, 1000]}]}", five_factors),
                  {"design=" + design, "trials=" + trials});
}

TEST(Saltelli, ARowHoldsAThenBThenAWithEachFactorFromB) {
  const std::vector<std::vector<std::uint64_t>> row_seven{
      {7, 7, 7},
      {second_sample + 7, second_sample + 7, second_sample + 7},
      {second_sample + 7, 7, 7},
      {7, second_sample + 7, 7},
      {7, 7, second_sample + 7},
  };
  for (std::uint64_t place = 0; place < 5; ++place) {
    for (std::size_t factor = 0; factor < 3; ++factor)
      EXPECT_EQ(saltelli_source(7 * 5 + place, factor, 3), row_seven[place][factor]);
  }
}

TEST(Saltelli, AIsTheMonteCarloTrialOfTheSameNumber) {
  const study::Study saltelli = five_factor_study("saltelli", "700");
  const study::Study monte_carlo = five_factor_study("monte_carlo", "700");
  for (std::int64_t row = 0; row < 100; ++row) {
    const study::StudyTrial of_row = study::study_trial(saltelli, 0, 7 * row);
    const study::StudyTrial alone = study::study_trial(monte_carlo, 0, row);
    EXPECT_EQ(of_row.inputs, alone.inputs);
    EXPECT_EQ(of_row.parameters.randomness.trial, alone.parameters.randomness.trial);
  }
}

TEST(Saltelli, EachOtherTrialOfARowChangesOnlyItsFactor) {
  const study::Study study = five_factor_study("saltelli", "7000");
  ASSERT_EQ(study.factors, (std::vector<std::string>{"friction.k1", "friction.k2", "controller.delay",
                                                     "command.targets.0", "within_trial"}));
  // The factors' values in the trial, the noise's as the number that it is drawn from.
  const auto values = [&](std::int64_t index) {
    const study::StudyTrial trial = study::study_trial(study, 0, index);
    std::vector<double> all = trial.inputs;
    all.push_back(static_cast<double>(trial.parameters.randomness.trial));
    return all;
  };
  std::vector<int> differing(5, 0);
  for (std::int64_t row = 0; row < 1000; ++row) {
    const std::vector<double> a = values(7 * row);
    const std::vector<double> b = values(7 * row + 1);
    for (std::size_t factor = 0; factor < 5; ++factor) {
      std::vector<double> expected = a;
      expected[factor] = b[factor];
      EXPECT_EQ(values(7 * row + 2 + static_cast<std::int64_t>(factor)), expected);
      differing[factor] += a[factor] != b[factor];
    }
  }
  EXPECT_EQ(differing[0], 1000);
  EXPECT_EQ(differing[1], 1000);
  EXPECT_NEAR(differing[2], 667, 75);
  EXPECT_NEAR(differing[3], 999, 10);
  EXPECT_EQ(differing[4], 1000);
}

TEST(Saltelli, MoreTrialsKeepTheFirstOnes) {
  const study::Study few = five_factor_study("saltelli", "7");
  const study::Study many = five_factor_study("saltelli", "7000000");
  for (std::int64_t i = 0; i < 7; ++i)
    EXPECT_EQ(study::study_trial(few, 0, i).inputs, study::study_trial(many, 0, i).inputs);
}

TEST(Saltelli, AllPointsHaveTheSameRows) {
  const study::Study study =
      study_of(minimal_manifest(
                   "friction: {k1: {uniform: [100, 120]}}\n"
                   "sweep: {cases: {a: {}, b: {friction.k1: 110, friction.k2: {uniform: [600, 800]}}}}\n"),
               {"design=saltelli", "trials=40"});
  ASSERT_EQ(study.factors, (std::vector<std::string>{"friction.k1", "friction.k2"}));
  const std::size_t k2 = column_of(study, "friction.k2");
  for (std::int64_t row = 0; row < 10; ++row) {
    const double of_a = study::study_trial(study, 1, 4 * row).inputs[k2];
    EXPECT_EQ(study::study_trial(study, 1, 4 * row + 2).inputs[k2], of_a) << "k1 changes";
    EXPECT_NE(study::study_trial(study, 1, 4 * row + 3).inputs[k2], of_a) << "k2 changes";
    EXPECT_EQ(study::study_trial(study, 0, 4 * row + 3).inputs[k2],
              study::study_trial(study, 0, 0).inputs[k2]);
  }
}

TEST(Saltelli, APositionOnAProfileIsAFactorButTheProfileIsNot) {
  const study::Study study =
      study_of(minimal_manifest("friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2}}}\n"
                                "initial: {position: {uniform: [0, 6]}}\n"),
               {"design=saltelli", "trials=6"});
  EXPECT_EQ(study.factors, std::vector<std::string>{"initial.position"});
  EXPECT_NE(study::study_trial(study, 0, 0).inputs, study::study_trial(study, 0, 1).inputs);
}

TEST(Saltelli, RandomHistoriesAndMissedCountsAreDrawnWithinTrials) {
  const std::vector<std::string> noisy{
      "initial: {history: {reversals: 3, torque: 0.1}}\n", "encoder: {fine_errors: {missed: 0.01}}\n",
      "encoder: {coarse_errors: {noise: {uniform: [0, 1]}}}\n", "dac: {noise: 1.0e-5}\n"};
  for (const std::string& text : noisy) {
    const study::Study study = study_of(minimal_manifest(text), {"design=saltelli", "trials=12"});
    ASSERT_FALSE(study.factors.empty()) << text;
    EXPECT_EQ(study.factors.back(), study::within_trial_factor) << text;
  }
}

TEST(Saltelli, OtherDesignsListNoFactors) {
  EXPECT_TRUE(five_factor_study("monte_carlo", "7").factors.empty());
}

TEST(Saltelli, AnIncompleteRowIsRefusedWithTheNearestNumbersOfTrials) {
  const std::string text = minimal_manifest("friction: {k1: {uniform: [100, 120]}}\ndesign: saltelli\n");
  EXPECT_TRUE(has_faults(refusal_of(text, {}), "4:9: trials | 9 or 12"));
  EXPECT_TRUE(says(refusal_of(text, {"trials=2"}), "expected a multiple of 3, such as 3"));
  EXPECT_EQ(refusal_of(text, {"trials=12"}), "");
}

TEST(Saltelli, ADesignWithoutRandomParametersIsRefused) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("design: «saltelli»\n"), {}), "«»: design | nothing is drawn"));
}

random::RandomStream stream_of(std::uint64_t seed) {
  return {random_key(seed, "friction.k1"), 0};
}

TEST(LatinHypercube, StrataAreAPermutationForAnyNumberOfTrials) {
  for (std::uint64_t count = 1; count <= 300; ++count) {
    std::vector<bool> seen(count, false);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t stratum = latin_stratum(i, count, stream_of(count));
      ASSERT_LT(stratum, count);
      ASSERT_FALSE(seen[stratum]) << "stratum " << stratum << " twice of " << count;
      seen[stratum] = true;
    }
  }
}

TEST(LatinHypercube, StaysInRangeAndDistinctForHugeNumbersOfTrials) {
  for (const std::uint64_t count :
       {std::uint64_t{1'000'003}, std::uint64_t{1} << 40, (std::uint64_t{1} << 53) - 1}) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const std::uint64_t stratum = latin_stratum(count - 1 - i, count, stream_of(1));
      ASSERT_LT(stratum, count);
      ASSERT_TRUE(seen.insert(stratum).second);
    }
  }
}

TEST(LatinHypercube, EveryStratumHoldsOneTrial) {
  constexpr std::uint64_t count = 1000;
  std::set<int> strata;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = latin_uniform(i, count, stream_of(3));
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    strata.insert(static_cast<int>(u * count));
  }
  EXPECT_EQ(strata.size(), count);
}

// All 24 permutations of four strata over 24 000 seeds: χ² with 23 degrees of freedom stays below 62.7 with
// probability 1 − 1.6e-5.
TEST(LatinHypercube, AllPermutationsAreEquallyLikely) {
  constexpr int seeds = 24000;
  std::map<std::vector<std::uint64_t>, int> counts;
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<std::uint64_t> permutation;
    for (std::uint64_t i = 0; i < 4; ++i)
      permutation.push_back(latin_stratum(i, 4, stream_of(static_cast<std::uint64_t>(seed))));
    ++counts[permutation];
  }
  ASSERT_EQ(counts.size(), 24u);
  double chi_squared = 0.0;
  for (const auto& [permutation, n] : counts) chi_squared += std::pow(n - seeds / 24.0, 2) / (seeds / 24.0);
  EXPECT_LT(chi_squared, 62.7);
}

// For independent permutations r·√(N − 1) is about standard normal: |r| < 4.4/√N but once in 90 000.
TEST(LatinHypercube, ParametersAreUncorrelatedWithEachOtherAndWithTheTrialIndex) {
  constexpr std::uint64_t count = 4000;
  const random::RandomStream first{random_key(5, "friction.k1"), 0};
  const random::RandomStream second{random_key(5, "friction.k2"), 0};
  const random::RandomStream other_point{first.key, 2};
  double with_second = 0.0;
  double with_point = 0.0;
  double with_index = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = latin_uniform(i, count, first) - 0.5;
    with_second += 12.0 / count * u * (latin_uniform(i, count, second) - 0.5);
    with_point += 12.0 / count * u * (latin_uniform(i, count, other_point) - 0.5);
    with_index += 12.0 / count * u * (static_cast<double>(i) / count - 0.5);
  }
  const double limit = 4.4 / std::sqrt(static_cast<double>(count));
  EXPECT_LT(std::abs(with_second), limit);
  EXPECT_LT(std::abs(with_point), limit);
  EXPECT_LT(std::abs(with_index), limit);
}

// The answers published with Random123 (its file kat_vectors, philox4x32 with 10 rounds): the first two
// output words.
TEST(Random, IsPhilox4x32WithTenRounds) {
  EXPECT_EQ(random::random_bits({{0, 0}, 0}, 0, 0u), 0xe169c58d6627e8d5u);
  EXPECT_EQ(random::random_bits({{0xffffffff, 0xffffffff}, 0xffffffff}, 0xffffffffffffffff, 0xffffffffu),
            0x41c83b0e408f276du);
  EXPECT_EQ(random::random_bits({{0xa4093822, 0x299f31d0}, 0x03707344}, 0x85a308d3243f6a88, 0x13198a2eu),
            0x94fdccebd16cfe09u);
}

// FIPS 180-4's own examples.
TEST(Random, KeysComeFromSha256) {
  EXPECT_EQ(hash::sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash::sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Random, KeyDependsOnSeedAndName) {
  EXPECT_NE(random_key(1, "friction.k1"), random_key(2, "friction.k1"));
  EXPECT_NE(random_key(1, "friction.k1"), random_key(1, "friction.k2"));
  EXPECT_EQ(random_key(1, "friction.k1"), random_key(1, "friction.k1"));
}

TEST(Random, UniformsAreStrictlyInsideTheUnitIntervalAndSymmetric) {
  EXPECT_EQ(random::open_uniform(0), 0x1p-53);
  EXPECT_EQ(random::open_uniform(~std::uint64_t{0}), 1.0 - 0x1p-53);
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const std::uint64_t bits = random::random_bits({{7, 8}, 0}, i, random::Draw::trial);
    ASSERT_EQ(random::open_uniform(bits), 1.0 - random::open_uniform(~bits));
  }
}

}  // namespace
}  // namespace zerocount::designs
