// `correlation` in a manifest: what is read, and what is refused.
#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
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
  EXPECT_EQ(refusal_of(minimal_manifest(GetParam().lines)), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedCorrelations,
    testing::Values(
        CorrelationRefusal{
            "correlation: 0.5",
            "m.yaml:6:14: correlation: the single value '0.5' stands here; expected a list of entries [first "
            "parameter, second parameter, coefficient]"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, 0.5]]",
            "m.yaml:7:15: correlation.0: the entry has 2 values; expected [first parameter, second "
            "parameter, "
            "coefficient]"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, friction.k2, 0.5]]",
            "m.yaml:7:29: correlation.0.1: no parameter of this name is drawn, nearest known: friction.k1; "
            "expected one of friction.k1"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, friction.k1, 0.5]]",
            "m.yaml:7:15: correlation.0: a parameter cannot be correlated with itself; expected two "
            "different "
            "parameters"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
            "correlation: [[friction.k1, friction.k2, 1]]",
            "m.yaml:7:42: correlation.0.2: '1' is out of range; expected a number greater than -1 and less "
            "than 1"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
            "correlation: [[friction.k1, friction.k2, 0.5], [friction.k2, friction.k1, 0.1]]",
            "m.yaml:7:48: correlation.1: this pair stands in the list twice; expected each pair once"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: study}}\n"
            "correlation: [[friction.k1, friction.k2, 0.5]]",
            "m.yaml:7:29: correlation.0.1: friction.k2 cannot be correlated: it is drawn once for the study; "
            "expected a distribution drawn for each rig or each trial"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: contact}}\n"
            "correlation: [[friction.k1, friction.k2, 0.5]]",
            "m.yaml:7:29: correlation.0.1: friction.k2 cannot be correlated: it is drawn anew at each "
            "contact; expected a distribution drawn for each rig or each trial"},
        CorrelationRefusal{
            "rigs: 2\nfriction: {k1: {uniform: [90, 130]}}\ninitial: {position: {uniform: [0, 6]}}\n"
            "correlation: [[friction.k1, initial.position, 0.5]]",
            "m.yaml:9:14: correlation: some of these parameters are drawn for each rig and others for each "
            "trial; expected the same `per` for all of them"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}, beta: {uniform: [1.0e5, "
            "2.0e5]}}\n"
            "correlation: [[friction.k1, friction.k2, 0.9], [friction.k2, friction.beta, 0.9]]",
            "m.yaml:7:14: correlation: no random numbers have these correlations: their matrix, with 0 for "
            "the "
            "pairs that are not given, is not positive definite; expected smaller coefficients, or those of "
            "the other pairs too"}));

TEST(Correlations, AreRefusedWithTheDesignSaltelli) {
  EXPECT_EQ(refusal_of(minimal_manifest("friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                                        "correlation: [[friction.k1, friction.k2, 0.5]]\n"),
                       {"design=saltelli", "trials=40"}),
            "m.yaml:7:14: correlation: Sobol' indices by the design saltelli are those of independent "
            "parameters; expected another design");
}

TEST(Correlations, AreNotBlamedForAValueThatCannotBeRead) {
  EXPECT_EQ(refusal_of(minimal_manifest("friction: {k1: {uniform: [130, 90]}, k2: {uniform: [600, 900]}}\n"
                                        "correlation: [[friction.k1, friction.k2, 0.5]]\n"))
                .find("correlation"),
            std::string::npos);
}

}  // namespace
}  // namespace zerocount::manifest
