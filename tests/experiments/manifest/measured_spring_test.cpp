// The friction spring by what one measures of it: stiffnesses, and the torque and travel at which it slides.
#include "core/friction/presliding/spring.hpp"
#include "experiments/study/low_end.hpp"
#include "experiments/study/point_limits.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::manifest {
namespace {

constexpr const char* by_initial =
    "initial_stiffness: 860, final_stiffness: 110, breakaway: 0.3, breakaway_travel: 2.0e-3";
constexpr const char* by_secant =
    "secant_stiffness: 200, secant_travel: 1.0e-4, final_stiffness: 110, breakaway: 0.3, breakaway_travel: "
    "2.0e-3";

std::string with_spring(const std::string& values, const std::string& more = "") {
  return minimal_manifest("friction: {measured: {" + values + "}}\n" + more);
}

friction::FrictionParameters spring_of(const study::Study& study, std::int64_t point, std::int64_t index,
                                       std::int64_t contact = 0) {
  return friction::friction_at(study::study_trial(study, point, index).parameters.friction, 0.0, contact);
}

double drawn(const study::Study& study, std::int64_t index, const std::string& name) {
  return study::study_trial(study, 0, index).inputs[column_of(study, "friction." + name)];
}

double virgin_torque(const friction::FrictionParameters& contact, double travel) {
  return 0.5 * friction::branch_law(contact, 2.0 * travel);
}

/// The contact has what was measured of the trial, and the file has what the contact has.
void expect_as_measured(const study::Study& study, std::int64_t index, bool secant) {
  const friction::FrictionParameters contact = spring_of(study, 0, index);
  const auto measured = [&](const std::string& key) { return drawn(study, index, "measured." + key); };
  EXPECT_EQ(contact.k1, measured("final_stiffness"));
  EXPECT_EQ(contact.breakaway, measured("breakaway"));
  EXPECT_NEAR(virgin_torque(contact, measured("breakaway_travel")) / contact.breakaway, 1.0, 1e-12);
  EXPECT_NEAR(friction::presliding_range(contact) / measured("breakaway_travel"), 1.0, 1e-12);
  if (secant) {
    const double travel = measured("secant_travel");
    EXPECT_NEAR(virgin_torque(contact, travel) / (travel * measured("secant_stiffness")), 1.0, 1e-12);
  } else {
    EXPECT_NEAR((contact.k1 + contact.k2) / measured("initial_stiffness"), 1.0, 1e-15);
  }
  EXPECT_EQ(drawn(study, index, "k1"), contact.k1);
  EXPECT_EQ(drawn(study, index, "k2"), contact.k2);
  EXPECT_EQ(drawn(study, index, "beta"), contact.beta);
  EXPECT_EQ(drawn(study, index, "breakaway"), contact.breakaway);
}

TEST(MeasuredSpringOfStudy, IsDrawnAtEveryLevelByEitherGroup) {
  for (const std::string level : {"world", "rig", "trial"}) {
    const auto spread = [&](double low, double high) {
      return fmt::format("{{uniform: [{}, {}], per: {}}}", low, high, level);
    };
    const std::string common = "final_stiffness: " + spread(90, 120) + ", breakaway: " + spread(0.29, 0.31) +
                               ", breakaway_travel: " + spread(1.9e-3, 2.1e-3);
    const std::string worlds = "worlds: 2\nrigs: 4\n";
    const study::Study initial = study_of(
        with_spring("initial_stiffness: " + spread(600, 900) + ", " + common, worlds), {"trials=16"});
    const study::Study secant =
        study_of(with_spring("secant_stiffness: " + spread(250, 300) + ", secant_travel: 1.0e-4, " + common,
                             worlds + "sweep: {grid: {friction.measured.secant_travel: [1.0e-4]}}\n"),
                 {"trials=16"});
    std::set<double> betas;
    for (std::int64_t i = 0; i < 16; ++i) {
      expect_as_measured(initial, i, false);
      expect_as_measured(secant, i, true);
      betas.insert(spring_of(initial, 0, i).beta);
    }
    EXPECT_EQ(betas.size(), level == "trial" ? 16u : level == "rig" ? 4u : 2u) << level;
  }
}

// Each contact draws all of its values, by its number alone.
TEST(MeasuredSpringOfStudy, DiffersFromContactToContactInAllItsValues) {
  const study::Study study = study_of(with_spring(
      "initial_stiffness: {uniform: [600, 900], per: contact}, final_stiffness: {uniform: [90, 120], per: "
      "contact}, breakaway: {uniform: [0.29, 0.31], per: contact}, breakaway_travel: 2.0e-3"));
  std::set<double> initial;
  for (std::int64_t number = 0; number < 40; ++number) {
    const friction::FrictionParameters contact = spring_of(study, 0, 1, number);
    EXPECT_NEAR(virgin_torque(contact, 2e-3) / contact.breakaway, 1.0, 1e-12);
    EXPECT_TRUE(contact.k1 > 90 && contact.k1 < 120 && contact.breakaway > 0.29 && contact.breakaway < 0.31);
    EXPECT_TRUE(contact.k1 + contact.k2 > 600 && contact.k1 + contact.k2 < 900);
    initial.insert(contact.k1 + contact.k2);
  }
  EXPECT_EQ(initial.size(), 40u);
}

// Only their correlation makes these draws those of machines.
TEST(MeasuredSpringOfStudy, IsCheckedByTheDrawsOfItsMachines) {
  const std::string values =
      "initial_stiffness: {choice: [1500, 1600]}, final_stiffness: {log_uniform: [10, 1000]}, breakaway: "
      "{log_uniform: [0.03, 3]}, breakaway_travel: {choice: [1.99e-3, 2.0e-3]}";
  const study::Study study =
      study_of(with_spring(values,
                           "correlation: [[friction.measured.final_stiffness, friction.measured.breakaway, "
                           "0.9999]]\n"),
               {"trials=200"});
  for (std::int64_t i = 0; i < study.trials; ++i) expect_as_measured(study, i, false);
  const std::size_t beta = parameters::find_parameter("friction.beta").value();
  const study::ValueLimits limits = study::limits_of_slot(*study.plan, beta, 0);
  EXPECT_TRUE(limits.low > 0.0 && std::isfinite(limits.high) && limits.typical >= limits.low);
  EXPECT_TRUE(has_faults(refusal_of(with_spring(values), {"trials=200"}),
                         "6:83: friction.measured.final_stiffness | trial | of 200 trials"));
}

TEST(MeasuredSpringOfStudy, HasTheLowEndOfWhatItFollowsFrom) {
  const study::Study study = study_of(with_spring(
      "initial_stiffness: 860, final_stiffness: {lognormal: {median: 110, cv: 0.01}}, breakaway: 0.3, "
      "breakaway_travel: 2.0e-3"));
  const study::Study constant =
      study_of(minimal_manifest("friction: {k1: {lognormal: {median: 110, cv: 0.01}}}\n"));
  EXPECT_EQ(study::low_end(study, 0, "friction.k1").kind, study::LowEnd::Kind::tail);
  EXPECT_EQ(study::low_end(study, 0, "friction.k1").value, study::low_end(constant, 0, "friction.k1").value);
}

TEST(MeasuredSpringOfStudy, RefusesWhatNoMachineHasWithItsNumbers) {
  const auto refusal = [](const std::string& values, const std::string& more = "") {
    return refusal_of(with_spring(values, more));
  };
  const std::string rest = ", breakaway: 0.3, breakaway_travel: 2.0e-3";
  EXPECT_TRUE(
      has_faults(refusal("initial_stiffness: 860, final_stiffness: 160" + rest),
                 "6:64: friction.measured.final_stiffness | final_stiffness = 160 N m/rad is not below "
                 "breakaway/breakaway_travel = 150 N m/rad | expected"));
  EXPECT_TRUE(has_faults(refusal("initial_stiffness: 140, final_stiffness: 110" + rest),
                         "6:80: friction.measured.breakaway | = 150 | = 140"));
  EXPECT_TRUE(has_faults(refusal("secant_stiffness: 200, secant_travel: 3.0e-3, final_stiffness: 110" + rest),
                         "6:61: friction.measured.secant_travel | = 0.003 rad | = 0.002 rad"));
  EXPECT_TRUE(
      has_faults(refusal("secant_stiffness: 1000, secant_travel: 2.0e-4, final_stiffness: 110" + rest),
                 "6:41: friction.measured.secant_stiffness | = 0.398 N m | breakaway = 0.3 N m"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 860, final_stiffness: {uniform: [100, 200]}" + rest, "rigs: 2\n"),
      "6:64: friction.measured.final_stiffness | rig | is not below"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 860, final_stiffness: {lognormal: {median: 110, cv: 0.1}, per: contact}" +
              rest),
      "6:64: friction.measured.final_stiffness | is not below"));
  EXPECT_TRUE(
      has_faults(refusal(by_initial, "sweep: {grid: {friction.measured.breakaway: [0.3, 0.2]}}\n"),
                 "7:51: friction.measured.breakaway | final_stiffness = 110 | = 100 N m/rad at point 1"));
  EXPECT_TRUE(has_faults(
      refusal(
          by_initial,
          "goal: {band: 1, within: 0.05, moves: 0.9}\ntune: {free: {friction.measured.final_stiffness: [100, "
          "200]}}\n"),
      "6:64: friction.measured.final_stiffness | = 200 N m/rad"));
}

TEST(MeasuredSpringOfStudy, StandsInPlaceOfTheConstantsAsAWhole) {
  const auto refusal = [](const std::string& values, const std::string& more = "") {
    return refusal_of(with_spring(values, more));
  };
  EXPECT_TRUE(has_faults(refusal("final_stiffness: 110, breakaway: 0.3, breakaway_travel: 2.0e-3"),
                         "6:40: friction.measured.initial_stiffness | missing | secant_stiffness"));
  EXPECT_TRUE(has_faults(refusal("secant_stiffness: 200, final_stiffness: 110, breakaway: 0.3"),
                         "6:41: friction.measured.secant_travel | missing\n"
                         "6:41: friction.measured.breakaway_travel | missing"));
  EXPECT_TRUE(has_faults(refusal(std::string("initial_stiffness: 860, ") + by_secant),
                         "6:65: friction.measured.secant_stiffness | friction.measured.initial_stiffness"));
  EXPECT_TRUE(has_faults(refusal_of(with_spring(by_initial), {"friction.beta=1.0e+5"}),
                         "--set friction.beta=1.0e+5: friction.beta | friction.measured | other"));
  EXPECT_TRUE(
      has_faults(refusal(by_secant, "sweep: {cases: {a: {friction.k1: 100}, b: {friction.k1: 110}}}\n"),
                 "7:34: friction.k1 | friction.measured | other"));
  for (const std::string model : {"coulomb", "dahl", "lugre", "gms", "none"}) {
    EXPECT_TRUE(says(
        refusal_of(minimal_manifest("friction: {model: " + model + ", measured: {" + by_initial + "}}\n")),
        "friction.measured.initial_stiffness: it has no effect"))
        << model;
  }
  EXPECT_EQ(
      refusal_of(minimal_manifest(std::string("friction: {model: spring, measured: {") + by_secant + "}}\n")),
      "");
}

}  // namespace
}  // namespace zerocount::manifest
