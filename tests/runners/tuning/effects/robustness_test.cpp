// Premises of an answer: the rates with others are those of the manifests that state them.
#include "experiments/manifest/load_study.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using tuning::EffectRuns;
using tuning::Limit;

constexpr const char* text = R"(zerocount: 1
name: premises
seed: 3
trials: 96
command: {targets: [29, 0], hold: 0.25}
controller: {ki: 3.0e-5, delay: 1}
friction: {k1: {lognormal: {median: 120, cv: 0.3}}, alpha: {uniform: [0.2, 0.6]}}
encoder: {fine_errors: {noise: 0.05}}
initial: {encoder_phase: {uniform: [0, 1]}}
conditions: {light: {}, heavy: {plant.inertia: 7.0e-4}}
goal: {band: 1, within: 0.1, moves: 0.6}
)";

study::Study stated(std::vector<std::string> overrides = {}) {
  return manifest::parse_study(text, "axis.yaml", overrides);
}

double rate_of(const study::Study& study) {
  const EffectRuns runs(study, trials::replicates_of(study, 0), {});
  return *limit_of(runs, runs.base()).rate;
}

std::vector<Limit> variations() {
  const study::Study study = stated();
  const trials::Replicates units = trials::replicates_of(study, 0);
  return variations_of(EffectRuns(study, units, {}), units,
                       [](std::uint64_t seed) { return stated({fmt::format("seed={}", seed)}); });
}

TEST(Robustness, RatesAreThoseOfManifestsWithOtherPremises) {
  const std::vector<Limit> found = variations();
  ASSERT_EQ(found.size(), 4U);
  double lowest = 1.0;
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t seed = trials::fresh_seed(3, fmt::format("other seed {}", i));
    lowest = std::min(lowest, rate_of(stated({fmt::format("seed={}", seed)})));
  }
  EXPECT_EQ(found[0].rate, lowest);
  const double cv =
      std::sqrt(std::pow(1.0 + 0.3 * 0.3, 4.0) - 1.0);  // twice the standard deviation of the logarithm
  EXPECT_NEAR(*found[1].rate,
              rate_of(stated(
                  {fmt::format("friction.k1.lognormal.cv={:.17g}", cv), "friction.alpha.uniform=[0,0.8]"})),
              0.011);
  EXPECT_EQ(found[2].rate, rate_of(stated({"controller.delay=0.5"})));
  EXPECT_EQ(found[3].rate, rate_of(stated({"controller.delay=2"})));
  for (const Limit& one : found) EXPECT_EQ(one.holds, *one.rate >= 0.6) << one.effect;
  EXPECT_NE(found[2].rate, found[3].rate) << "the delay must matter here";
}

// A value that would leave its range stays, and the row says so.
TEST(Robustness, NamesWhatStays) {
  const auto effects = tuning::other_premises(
      manifest::parse_study(std::string(text) + "plant: {presliding_damping: {uniform: [0.01, 0.3]}}\n",
                            "axis.yaml", {}),
      0);
  EXPECT_NE(effects.front().note.find("plant.presliding_damping"), std::string::npos) << effects.front().note;
}

}  // namespace
}  // namespace zerocount::testing
