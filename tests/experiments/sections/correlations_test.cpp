// `correlation` in a manifest: what is read, and what is refused.
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

TEST(Correlations, AreThoseOfTheList) {
  const study::Study study =
      study_of(minimal_manifest("friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                                "correlation: [[friction.k2, friction.k1, 0.25]]\n"));
  ASSERT_EQ(study.correlations.size(), 1U);
  EXPECT_EQ(study::correlations_text(study.correlations), "friction.k2 and friction.k1 (0.25)");
}

TEST(Correlations, CanBeSwitchedOff) {
  const std::string drawn = "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n";
  const study::Study off = study_of(
      minimal_manifest(drawn + "correlation: [[friction.k2, friction.k1, 0.25]]\n"), {"correlation=[]"});
  const study::Study without = study_of(minimal_manifest(drawn));
  EXPECT_TRUE(off.correlations.empty());
  EXPECT_EQ(study::study_trial(off, 0, 3).inputs, study::study_trial(without, 0, 3).inputs);
}

struct CorrelationRefusal {
  const char* lines;
  const char* message;
};

class RefusedCorrelations : public testing::TestWithParam<CorrelationRefusal> {};

TEST_P(RefusedCorrelations, SayWhy) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().lines)), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedCorrelations,
    testing::Values(
        CorrelationRefusal{"correlation: 0.5", "6:14: correlation | '0.5'"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, 0.5]]",
                           "7:15: correlation.0 | 2 values"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, friction.k2, 0.5]]",
            "7:29: correlation.0.1 | nearest known"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, friction.k1, 0.5]]",
            "7:15: correlation.0 | itself"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                           "correlation: [[friction.k1, friction.k2, 1]]",
                           "7:42: correlation.0.2 | greater than -1 and less than 1"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                           "correlation: [[friction.k1, friction.k2, 0.5], [friction.k2, friction.k1, 0.1]]",
                           "7:48: correlation.1 | duplicate"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: study}}\n"
                           "correlation: [[friction.k1, friction.k2, 0.5]]",
                           "7:29: correlation.0.1 | cannot be correlated"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: contact}}\n"
                           "correlation: [[friction.k1, friction.k2, 0.5]]",
                           "7:29: correlation.0.1 | cannot be correlated"},
        CorrelationRefusal{
            "rigs: 2\nfriction: {k1: {uniform: [90, 130]}}\ninitial: {position: {uniform: [0, 6]}}\n"
            "correlation: [[friction.k1, initial.position, 0.5]]",
            "9:14: correlation | per"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}, beta: {uniform: [1.0e5, "
            "2.0e5]}}\n"
            "correlation: [[friction.k1, friction.k2, 0.9], [friction.k2, friction.beta, 0.9]]",
            "7:14: correlation | positive definite"}));

TEST(Correlations, AreRefusedWithTheDesignSaltelli) {
  EXPECT_TRUE(has_faults(
      refusal_of(minimal_manifest("friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                                  "correlation: [[friction.k1, friction.k2, 0.5]]\n"),
                 {"design=saltelli", "trials=40"}),
      "7:14: correlation | another design"));
}

TEST(Correlations, AreNotBlamedForAValueThatCannotBeRead) {
  EXPECT_FALSE(says(refusal_of(minimal_manifest("friction: {k1: {uniform: [130, 90]}, k2: {uniform: [600, "
                                                "900]}}\ncorrelation: [[friction.k1, friction.k2, 0.5]]\n")),
                    "correlation"));
}

}  // namespace
}  // namespace zerocount::sections
