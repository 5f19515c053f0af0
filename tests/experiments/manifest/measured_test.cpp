// Creep by what one measures of it: the extension at which it ends under a torque.
#include "core/friction/presliding/spring.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/branch_law.hpp"

namespace zerocount::manifest {
namespace {

std::string with_creep(const std::string& values, const std::string& more = "") {
  return minimal_manifest("friction: {measured: {creep: {" + values + "}}}\n" + more);
}

friction::FrictionParameters contact_of(const study::Study& study, std::int64_t point, std::int64_t index,
                                        std::int64_t number = 0) {
  return friction::friction_at(study::study_trial(study, point, index).parameters.friction, 0.0, number);
}

void expect_same_creep(const friction::FrictionParameters& a, const friction::FrictionParameters& b) {
  EXPECT_EQ(a.alpha, b.alpha);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.n, b.n);
}

double input(const study::Study& study, std::int64_t point, std::int64_t index, const std::string& name) {
  return study::study_trial(study, point, index).inputs[column_of(study, name)];
}

// A trial is a function of its parameters, so these equal bits are equal outcomes.
TEST(MeasuredCreep, EqualsTheDerivedConstantsOfTheLaw) {
  std::mt19937_64 random(7);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 50; ++i) {
    const double torque = std::pow(10.0, uniform(-3, 2));
    const double extension = std::pow(10.0, uniform(-8, -3));
    const double rate = uniform(0, 3);
    const double exponent = uniform(1, 4);
    const study::Study measured = study_of(with_creep(
        fmt::format("torque: {}, extension: {}, rate: {}, exponent: {}", torque, extension, rate, exponent)));
    const friction::FrictionParameters contact = contact_of(measured, 0, 0);
    EXPECT_EQ(contact.alpha, rate);
    EXPECT_EQ(contact.n, exponent);
    EXPECT_NEAR(contact.lambda * extension / std::pow(torque, exponent), 1.0, 1e-14);
    EXPECT_EQ(input(measured, 0, 0, "friction.lambda"), contact.lambda);
    const study::Study constants = study_of(minimal_manifest(fmt::format(
        "friction: {{alpha: {}, lambda: {}, n: {}}}\n", contact.alpha, contact.lambda, contact.n)));
    expect_same_creep(contact_of(constants, 0, 0), contact);
  }
}

TEST(MeasuredCreep, IsDrawnAtEveryLevelAndRecordedWithTheDerivedConstants) {
  for (const std::string level : {"study", "world", "machine", "trial"}) {
    const study::Study study =
        study_of(with_creep("torque: 0.015, extension: {lognormal: {median: 1.0e-5, cv: 0.5}, per: " + level +
                                "}, rate: {log_uniform: [0.1, 2], per: " + level +
                                "}, exponent: {interval: [1.5, 2.5]}",
                            "worlds: 2\nmachines: 4\n"),
                 {"trials=24"});
    std::set<double> lambdas;
    for (std::int64_t i = 0; i < study.trials; ++i) {
      const friction::FrictionParameters contact = contact_of(study, 0, i);
      EXPECT_EQ(input(study, 0, i, "friction.lambda"), contact.lambda);
      EXPECT_EQ(input(study, 0, i, "friction.n"), contact.n);
      EXPECT_EQ(input(study, 0, i, "friction.alpha"), input(study, 0, i, "friction.measured.creep.rate"));
      EXPECT_NEAR(contact.lambda * input(study, 0, i, "friction.measured.creep.extension"),
                  std::pow(0.015, contact.n), 1e-14 * std::pow(0.015, contact.n));
      lambdas.insert(contact.lambda);
    }
    EXPECT_EQ(lambdas.size(), level == "trial" ? 24u : level == "machine" ? 4u : 2u) << level;
    const auto machine_column = std::ranges::find(study.columns.shared[study::Grouping::machine],
                                                  "friction.lambda", &study::InputColumn::name);
    EXPECT_EQ(machine_column != study.columns.shared[study::Grouping::machine].end(), level == "machine");
    if (level == "machine") {
      const auto column =
          static_cast<std::size_t>(machine_column - study.columns.shared[study::Grouping::machine].begin());
      for (std::int64_t machine = 0; machine < 4; ++machine)
        EXPECT_EQ(study::group_inputs(study, study::Grouping::machine, machine)[column],
                  contact_of(study, 0, machine).lambda);
    }
  }
}

TEST(MeasuredCreep, DiffersFromContactToContact) {
  const study::Study study = study_of(with_creep(
      "torque: 0.5, extension: {choice: [1.0e-5, 2.0e-5], per: contact}, rate: {uniform: [1, 2], per: "
      "contact}, exponent: 2"));
  std::set<double> lambdas;
  std::set<double> rates;
  for (std::int64_t number = 0; number < 40; ++number) {
    const friction::FrictionParameters contact = contact_of(study, 0, 3, number);
    EXPECT_TRUE(contact.lambda == 0.25 / 1e-5 || contact.lambda == 0.25 / 2e-5) << contact.lambda;
    lambdas.insert(contact.lambda);
    rates.insert(contact.alpha);
  }
  EXPECT_EQ(lambdas.size(), 2u);
  EXPECT_EQ(rates.size(), 40u);
  EXPECT_EQ(contact_of(study, 0, 3, 0).lambda, input(study, 0, 3, "friction.lambda"));
}

TEST(MeasuredCreep, CanBeSweptOverriddenAndCorrelated) {
  const std::string creep = "torque: 2, extension: 1.0e-5, rate: 0.5, exponent: 2";
  const study::Study swept = study_of(with_creep(
      creep, "sweep: {grid: {friction.measured.creep.exponent: [1, 2, 3], friction.k1: [100, 110]}}\n"));
  for (std::int64_t point = 0; point < 6; ++point) {
    const double n = 1.0 + static_cast<double>(point / 2);
    EXPECT_EQ(contact_of(swept, point, 0).n, n);
    EXPECT_NEAR(contact_of(swept, point, 0).lambda, std::pow(2.0, n) * 1e5, 1e-7);
    const auto slot = parameters::find_parameter("friction.lambda").value();
    EXPECT_EQ(study::range_of_slot(*swept.plan, slot, static_cast<std::size_t>(point)).low,
              contact_of(swept, point, 0).lambda);
  }
  EXPECT_NEAR(
      contact_of(study_of(with_creep(creep), {"friction.measured.creep.extension=1.0e-4"}), 0, 0).lambda, 4e4,
      1e-9);
  EXPECT_TRUE(
      refusal_of(with_creep("torque: {uniform: [1, 2]}, extension: {uniform: [1.0e-6, 1.0e-5]}, rate: 1, "
                            "exponent: 2",
                            "correlation: [[friction.measured.creep.torque, "
                            "friction.measured.creep.extension, 0.5]]\n"))
          .empty());
  const study::Study linear = study_of(
      "zerocount: 1\nname: t\naxis: linear\nseed: 1\ntrials: 2\ncommand: {targets: [5]}\nplant: {inertia: 1, "
      "presliding_damping: 1, sliding_damping: 1}\nencoder: {resolution: 1.0e-8}\nfriction: {k1: 1.0e+6, k2: "
      "1.0e+7, beta: 1.0e+6, breakaway: 5, stribeck_velocity: 1.0e-3, measured: {creep: {" +
      creep + "}}}\ncontroller: {ki: 1.0e-3}\ndac: {resolution: 1.0e-3}\n");
  EXPECT_NEAR(contact_of(linear, 0, 0).lambda, 4e5, 1e-7);
}

TEST(MeasuredCreep, ReplacesAllConstantsAtOnce) {
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: «1», rate: 0.5, exponent: 2")),
                         "«»: friction.measured.creep.extension | missing | rad"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {lambda: «5», measured: {creep: {torque: 1, "
                                                     "extension: 1, rate: 1, exponent: 1}}}\n")),
                         "«»: friction.lambda | friction.measured.creep | other"));
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: 1, extension: 1, rate: 1, exponent: 1",
                                               "sweep: {grid: {friction.n: [«1», 2]}}\n")),
                         "«»: friction.n | friction.measured.creep | other"));
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: «1.0e-200», extension: 1, rate: 1, exponent: 2")),
                         "«»: friction.lambda | it is 0 | greater than 0"));
  EXPECT_TRUE(says(refusal_of(with_creep("torque: 1, extension: 1, rate: 1, exponent: {profile: {mean: 2, "
                                         "cv: 0.1, correlation_length: 0.1}}")),
                   "cannot vary along the rotor"));
}

// The friction spring by what one measures of it: stiffnesses, and the torque and travel at which it slides.

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
  return 0.5 * testing::branch_law(contact, 2.0 * travel);
}

/// Expects that the friction contact of trial `index` has the measured values of the manifest, and that the
/// stored inputs equal those of the contact.
/// @param secant the manifest gives the stiffness of a secant instead of the initial stiffness
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

TEST(MeasuredSpringOfStudy, IsDrawnAtEveryLevelFromEitherSetOfValues) {
  for (const std::string level : {"world", "machine", "trial"}) {
    const auto spread = [&](double low, double high) {
      return fmt::format("{{uniform: [{}, {}], per: {}}}", low, high, level);
    };
    const std::string common = "final_stiffness: " + spread(90, 120) + ", breakaway: " + spread(0.29, 0.31) +
                               ", breakaway_travel: " + spread(1.9e-3, 2.1e-3);
    const std::string worlds = "worlds: 2\nmachines: 4\n";
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
    EXPECT_EQ(betas.size(), level == "trial" ? 16u : level == "machine" ? 4u : 2u) << level;
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
      "initial_stiffness: {choice: [1500, 1600]}, final_stiffness: «{log_uniform: [10, 1000]}», breakaway: "
      "{log_uniform: [0.03, 3]}, breakaway_travel: {choice: [1.99e-3, 2.0e-3]}";
  const study::Study study =
      study_of(with_spring(values,
                           "correlation: [[friction.measured.final_stiffness, friction.measured.breakaway, "
                           "0.9999]]\n"),
               {"trials=200"});
  for (std::int64_t i = 0; i < study.trials; ++i) expect_as_measured(study, i, false);
  const std::size_t beta = parameters::find_parameter("friction.beta").value();
  const study::ParameterRange range = study::range_of_slot(*study.plan, beta, 0);
  EXPECT_TRUE(range.low > 0.0 && std::isfinite(range.high) && range.typical >= range.low);
  EXPECT_TRUE(has_faults(refusal_of(with_spring(values), {"trials=200"}),
                         "«»: friction.measured.final_stiffness | trial | of 200 trials"));
}

TEST(MeasuredSpringOfStudy, HasTheLowEndOfTheMeasuredValue) {
  const study::Study study = study_of(with_spring(
      "initial_stiffness: 860, final_stiffness: {lognormal: {median: 110, cv: 0.01}}, breakaway: 0.3, "
      "breakaway_travel: 2.0e-3"));
  const study::Study constant =
      study_of(minimal_manifest("friction: {k1: {lognormal: {median: 110, cv: 0.01}}}\n"));
  EXPECT_EQ(study::low_end(study, 0, "friction.k1").kind, study::LowEnd::Kind::tail);
  EXPECT_EQ(study::low_end(study, 0, "friction.k1").value, study::low_end(constant, 0, "friction.k1").value);
}

TEST(MeasuredSpringOfStudy, RefusesImpossibleValuesWithTheirNumbers) {
  const auto refusal = [](const std::string& values, const std::string& more = "") {
    return refusal_of(with_spring(values, more));
  };
  const std::string rest = ", breakaway: 0.3, breakaway_travel: 2.0e-3";
  EXPECT_TRUE(has_faults(refusal("initial_stiffness: 860, final_stiffness: «160»" + rest),
                         "«»: friction.measured.final_stiffness | final_stiffness = 160 N m/rad is not below "
                         "breakaway/breakaway_travel = 150 N m/rad | expected"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 140, final_stiffness: 110, breakaway: «0.3», breakaway_travel: 2.0e-3"),
      "«»: friction.measured.breakaway | = 150 | = 140"));
  EXPECT_TRUE(
      has_faults(refusal("secant_stiffness: 200, secant_travel: «3.0e-3», final_stiffness: 110" + rest),
                 "«»: friction.measured.secant_travel | = 0.003 rad | = 0.002 rad"));
  EXPECT_TRUE(
      has_faults(refusal("secant_stiffness: «1000», secant_travel: 2.0e-4, final_stiffness: 110" + rest),
                 "«»: friction.measured.secant_stiffness | = 0.398 N m | breakaway = 0.3 N m"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 860, final_stiffness: «{uniform: [100, 200]}»" + rest, "machines: 2\n"),
      "«»: friction.measured.final_stiffness | machine | is not below"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 860, final_stiffness: «{lognormal: {median: 110, cv: 0.1}, per: contact}»" +
              rest),
      "«»: friction.measured.final_stiffness | is not below"));
  EXPECT_TRUE(
      has_faults(refusal(by_initial, "sweep: {grid: {friction.measured.breakaway: [0.3, «0.2»]}}\n"),
                 "«»: friction.measured.breakaway | final_stiffness = 110 | = 100 N m/rad at point 1"));
  EXPECT_TRUE(has_faults(
      refusal(
          "initial_stiffness: 860, final_stiffness: «110»" + rest,
          "goal: {band: 1, within: 0.05, moves: 0.9}\ntune: {free: {friction.measured.final_stiffness: [100, "
          "200]}}\n"),
      "«»: friction.measured.final_stiffness | = 200 N m/rad"));
}

TEST(MeasuredSpringOfStudy, ReplacesAllConstantsAtOnce) {
  const auto refusal = [](const std::string& values, const std::string& more = "") {
    return refusal_of(with_spring(values, more));
  };
  EXPECT_TRUE(has_faults(refusal("final_stiffness: «110», breakaway: 0.3, breakaway_travel: 2.0e-3"),
                         "«»: friction.measured.initial_stiffness | missing | secant_stiffness"));
  EXPECT_TRUE(has_faults(refusal("secant_stiffness: «200», final_stiffness: 110, breakaway: 0.3"),
                         "«»: friction.measured.secant_travel | missing\n"
                         "«»: friction.measured.breakaway_travel | missing"));
  EXPECT_TRUE(has_faults(
      refusal("initial_stiffness: 860, secant_stiffness: «200», secant_travel: 1.0e-4, final_stiffness: 110, "
              "breakaway: 0.3, breakaway_travel: 2.0e-3"),
      "«»: friction.measured.secant_stiffness | friction.measured.initial_stiffness"));
  EXPECT_TRUE(has_faults(refusal_of(with_spring(by_initial), {"friction.beta=1.0e+5"}),
                         "--set friction.beta=1.0e+5: friction.beta | friction.measured | other"));
  EXPECT_TRUE(
      has_faults(refusal(by_secant, "sweep: {cases: {a: {friction.k1: «100»}, b: {friction.k1: 110}}}\n"),
                 "«»: friction.k1 | friction.measured | other"));
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
