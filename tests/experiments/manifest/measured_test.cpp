// Creep by what one measures of it: the extension at which it ends under a torque.
#include "experiments/study/low_end.hpp"
#include "experiments/study/point_limits.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

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
TEST(MeasuredCreep, ActsAsTheConstantsOfTheLawThatFollow) {
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

TEST(MeasuredCreep, IsDrawnAtEveryLevelAndRecordedWithWhatFollows) {
  for (const std::string level : {"study", "world", "rig", "trial"}) {
    const study::Study study =
        study_of(with_creep("torque: 0.015, extension: {lognormal: {median: 1.0e-5, cv: 0.5}, per: " + level +
                                "}, rate: {log_uniform: [0.1, 2], per: " + level +
                                "}, exponent: {interval: [1.5, 2.5]}",
                            "worlds: 2\nrigs: 4\n"),
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
    EXPECT_EQ(lambdas.size(), level == "trial" ? 24u : level == "rig" ? 4u : 2u) << level;
    const auto rig_column =
        std::ranges::find(study.columns.rigs, "friction.lambda", &study::InputColumn::name);
    EXPECT_EQ(rig_column != study.columns.rigs.end(), level == "rig");
    if (level == "rig") {
      const auto column = static_cast<std::size_t>(rig_column - study.columns.rigs.begin());
      for (std::int64_t rig = 0; rig < 4; ++rig)
        EXPECT_EQ(study::rig_inputs(study, rig)[column], contact_of(study, 0, rig).lambda);
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

TEST(MeasuredCreep, IsSweptOverriddenCorrelatedAndOnALinearAxisToo) {
  const std::string creep = "torque: 2, extension: 1.0e-5, rate: 0.5, exponent: 2";
  const study::Study swept = study_of(with_creep(
      creep, "sweep: {grid: {friction.measured.creep.exponent: [1, 2, 3], friction.k1: [100, 110]}}\n"));
  for (std::int64_t point = 0; point < 6; ++point) {
    const double n = 1.0 + static_cast<double>(point / 2);
    EXPECT_EQ(contact_of(swept, point, 0).n, n);
    EXPECT_NEAR(contact_of(swept, point, 0).lambda, std::pow(2.0, n) * 1e5, 1e-7);
    const auto slot = parameters::find_parameter("friction.lambda").value();
    EXPECT_EQ(study::limits_of_slot(*swept.plan, slot, static_cast<std::size_t>(point)).low,
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

TEST(MeasuredCreep, StandsInPlaceOfTheConstantsAsAWhole) {
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: 1, rate: 0.5, exponent: 2")),
                         "6:39: friction.measured.creep.extension | missing | rad"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {lambda: 5, measured: {creep: {torque: 1, "
                                                     "extension: 1, rate: 1, exponent: 1}}}\n")),
                         "6:20: friction.lambda | friction.measured.creep | other"));
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: 1, extension: 1, rate: 1, exponent: 1",
                                               "sweep: {grid: {friction.n: [1, 2]}}\n")),
                         "7:29: friction.n | friction.measured.creep | other"));
  EXPECT_TRUE(has_faults(refusal_of(with_creep("torque: 1.0e-200, extension: 1, rate: 1, exponent: 2")),
                         "6:39: friction.lambda | it is 0 | greater than 0"));
  EXPECT_TRUE(says(refusal_of(with_creep("torque: 1, extension: 1, rate: 1, exponent: {profile: {mean: 2, "
                                         "cv: 0.1, correlation_length: 0.1}}")),
                   "cannot vary along the rotor"));
}

}  // namespace
}  // namespace zerocount::manifest
