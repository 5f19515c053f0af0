// The values that trials of one machine have in common, and that differ between the machines of a study.
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/rotors.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

const std::vector<std::string> designs_with_machines{"monte_carlo", "latin_hypercube", "sobol"};

const std::string machines_and_moves =
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.1}}, cv: 0.1, correlation_length: 0.3}}\n"
    "  k2: {uniform: [600, 900]}\n"
    "  lambda: {uniform: [5, 20], per: trial}\n"
    "  alpha: {uniform: [0.1, 0.9], per: study}\n"
    "  beta: {uniform: [1.0e5, 2.0e5], per: contact}\n"
    "encoder: {fine: {integers: [1000000, 2000000]}}\n"
    "controller: {kp: {uniform: [0, 1.0e-4]}}\n"
    "initial: {position: {uniform: [0, 6]}, hardening: {uniform: [0, 1.0e-6], per: machine}}\n"
    "sweep: {grid: {controller.ki: [3.0e-5, 4.0e-5]}}\n";

const std::vector<std::string> of_a_machine{"friction.k1.profile.mean", "friction.k2", "encoder.fine",
                                            "controller.kp", "initial.hardening"};
const std::vector<std::string> of_a_trial{"friction.lambda", "initial.position", "friction.beta"};

Study machine_study(const std::string& design, int machines, int trials,
                    const std::string& more = "independent_points=false") {
  return study_of(
      minimal_manifest(machines_and_moves),
      {"design=" + design, fmt::format("machines={}", machines), fmt::format("trials={}", trials), more});
}

double input(const Study& study, const std::string& name, std::int64_t index, std::int64_t point = 0) {
  return study_trial(study, point, index).inputs[column_of(study, name)];
}

std::vector<double> rotor_of(const Study& study, std::int64_t index, std::int64_t point = 0) {
  return study_trial(study, point, index).parameters.friction.profiled.at(0).profile->cosine;
}

TEST(Machines, TrialsOfAMachineShareOnlyTheMachine) {
  for (const std::string& design : designs_with_machines) {
    const Study study = machine_study(design, 30, 150);
    for (const std::string& name : of_a_machine) {
      std::set<double> different;
      for (std::int64_t i = 0; i < 150; ++i) {
        EXPECT_EQ(input(study, name, i), input(study, name, i % 30)) << design << " " << name;
        different.insert(input(study, name, i));
      }
      EXPECT_EQ(different.size(), 30U) << design << " " << name;
    }
    for (const std::string& name : of_a_trial) {
      std::set<double> different;
      for (std::int64_t i = 0; i < 150; ++i) different.insert(input(study, name, i));
      EXPECT_EQ(different.size(), 150U) << design << " " << name;
    }
    for (std::int64_t i = 1; i < 150; ++i) {
      EXPECT_EQ(rotor_of(study, i) == rotor_of(study, 0), i % 30 == 0);
      EXPECT_EQ(input(study, "friction.alpha", i), input(study, "friction.alpha", 0));
    }
  }
}

TEST(Machines, ParametersOfAMachineAreListedOncePerMachine) {
  const Study study = machine_study("monte_carlo", 30, 150);
  std::vector<std::string> names;
  for (const InputColumn& column : study.columns.shared[Grouping::machine]) names.push_back(column.name);
  EXPECT_EQ(names, of_a_machine);
  for (std::int64_t i = 0; i < 150; ++i) {
    std::vector<double> inputs;
    for (const std::string& name : of_a_machine) inputs.push_back(input(study, name, i, 1));
    EXPECT_EQ(group_inputs(study, Grouping::machine, group_of(study, Grouping::machine, i)), inputs);
  }
  EXPECT_TRUE(study_of(full_manifest()).columns.shared[Grouping::machine].empty());
}

TEST(Machines, MoreTrialsKeepTheMachinesAndTheFirstTrials) {
  for (const std::string design : {"monte_carlo", "sobol"}) {
    const Study few = machine_study(design, 30, 60);
    const Study many = machine_study(design, 30, 6000);
    for (std::int64_t i = 0; i < 60; ++i) {
      EXPECT_EQ(study_trial(few, 0, i).inputs, study_trial(many, 0, i).inputs) << design;
      EXPECT_EQ(rotor_of(few, i), rotor_of(many, i));
    }
  }
  // The trials of a Latin hypercube change with their number, and its machines do not.
  const Study few = machine_study("latin_hypercube", 30, 60);
  const Study many = machine_study("latin_hypercube", 30, 6000);
  for (std::int64_t machine = 0; machine < 30; ++machine)
    EXPECT_EQ(group_inputs(few, Grouping::machine, machine), group_inputs(many, Grouping::machine, machine));
}

TEST(Machines, AllPointsShareTheMachinesEvenIfIndependent) {
  for (const std::string& design : designs_with_machines) {
    for (const std::string independent : {"false", "true"}) {
      const Study study = machine_study(design, 30, 60, "independent_points=" + independent);
      for (std::int64_t i = 0; i < 60; ++i) {
        for (const std::string& name : of_a_machine)
          EXPECT_EQ(input(study, name, i, 0), input(study, name, i, 1));
        EXPECT_EQ(input(study, "friction.alpha", i, 0), input(study, "friction.alpha", i, 1));
        EXPECT_EQ(rotor_of(study, i, 0), rotor_of(study, i, 1));
        EXPECT_EQ(input(study, "initial.position", i, 0) == input(study, "initial.position", i, 1),
                  independent == "false");
      }
    }
  }
}

// What belongs to the machine and what a trial does with it, section by section.
TEST(Machines, SectionsDecideWhichParametersBelongToTheMachine) {
  const std::set<std::string> of_machine{"plant", "friction", "encoder", "dac", "amplifier", "controller"};
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    const std::string section(parameter.name.substr(0, parameter.name.find('.')));
    EXPECT_EQ(parameter.of_machine, of_machine.count(section) == 1) << parameter.name;
  }
}

double uniform_of(const Study& study, const std::string& name, std::int64_t index, double low, double high) {
  return (input(study, name, index) - low) / (high - low);
}

// Of the machines each has a stratum of its own in what is theirs, and of the trials each in what is theirs.
TEST(Machines, StratifiedDesignsSpreadMachinesAndTrialsEachAmongThemselves) {
  for (const std::string design : {"latin_hypercube", "sobol"}) {
    const Study study = machine_study(design, 64, 1024);
    std::set<int> machines;
    std::set<int> trials;
    for (std::int64_t i = 0; i < 1024; ++i) {
      machines.insert(static_cast<int>(64 * uniform_of(study, "friction.k2", i, 600, 900)));
      trials.insert(static_cast<int>(1024 * uniform_of(study, "initial.position", i, 0, 6)));
    }
    EXPECT_EQ(machines.size(), 64U) << design;
    EXPECT_EQ(trials.size(), 1024U) << design;
    std::set<int> means;
    for (std::int64_t machine = 0; machine < 64; ++machine) {
      const double z =
          std::log(input(study, "friction.k1.profile.mean", machine) / 110) / std::sqrt(std::log1p(0.01));
      means.insert(static_cast<int>(64 * 0.5 * std::erfc(-z / std::numbers::sqrt2)));
    }
    EXPECT_EQ(means.size(), 64U) << design;
  }
}

// In the order of a Sobol sequence, the trials of one of 64 machines would all be in one 64th of the range.
TEST(Machines, DrawsOfATrialDoNotDependOnItsMachine) {
  for (const std::string& design : designs_with_machines) {
    const Study study = machine_study(design, 64, 64 * 64);
    for (std::int64_t machine = 0; machine < 64; machine += 7) {
      std::set<int> parts;
      for (std::int64_t k = 0; k < 64; ++k)
        parts.insert(static_cast<int>(8 * uniform_of(study, "initial.position", 64 * k + machine, 0, 6)));
      EXPECT_EQ(parts.size(), 8U) << design << ", machine " << machine;  // all but once in 600
    }
  }
}

TEST(Machines, SobolPlacesAreAPermutationWithinEveryRoundOfTheMachines) {
  const random::RandomKey key = sobol_place_key(1, Grouping::machine);
  std::set<std::uint64_t> orders;
  for (std::uint64_t round = 0; round < 20; ++round) {
    std::set<std::uint64_t> places;
    for (std::uint64_t machine = 0; machine < 30; ++machine)
      places.insert(sobol_place(key, 30 * round + machine, 30));
    EXPECT_EQ(places.size(), 30U);
    EXPECT_EQ(*places.begin(), 30 * round);
    EXPECT_EQ(*places.rbegin(), 30 * round + 29);
    orders.insert(sobol_place(key, 30 * round, 30) - 30 * round);
  }
  EXPECT_GT(orders.size(), 10U);
}

TEST(Machines, ContactDrawsDependOnlyOnContactAndTrial) {
  const Study study = machine_study("monte_carlo", 30, 60);
  std::set<double> values;
  for (std::int64_t i = 0; i < 60; ++i) {
    const friction::FrictionAlongRotor friction = study_trial(study, 0, i).parameters.friction;
    const friction::FrictionAlongRotor again = study_trial(study, 1, i).parameters.friction;
    ASSERT_EQ(friction.per_contact.size(), 1U);
    EXPECT_EQ(friction::friction_at(friction, 0.3, 0).beta, input(study, "friction.beta", i));
    for (const std::int64_t contact : {0L, 1L, 2L, 1000L}) {
      const double beta = friction::friction_at(friction, 0.3, contact).beta;
      EXPECT_EQ(beta, friction::friction_at(again, 2.0, contact).beta);
      EXPECT_TRUE(beta >= 1.0e5 && beta < 2.0e5);
      values.insert(beta);
    }
  }
  EXPECT_EQ(values.size(), 240U);
}

// Trials that do not slide are the same whether a parameter is drawn for the trial or for each contact.
TEST(Machines, TheFirstContactHasTheDrawsOfTheTrial) {
  for (const std::string design : {"monte_carlo", "latin_hypercube", "sobol", "saltelli"}) {
    const auto with_per = [&](const std::string& per) {
      return study_of(minimal_manifest("friction: {k1: {uniform: [100, 120], per: " + per +
                                       "}, k2: {uniform: [1, 2]}}\n"),
                      {"design=" + design, "trials=40"});
    };
    const Study of_trial = with_per("trial");
    const Study of_contact = with_per("contact");
    for (std::int64_t i = 0; i < 40; ++i)
      EXPECT_EQ(study_trial(of_trial, 0, i).inputs, study_trial(of_contact, 0, i).inputs) << design;
  }
}

TEST(Machines, AStudyWithoutMachinesCanDrawOnceForAllTrials) {
  const Study study = study_of(minimal_manifest(
      "friction: {k1: {profile: {mean: {uniform: [100, 120]}, cv: 0.1, correlation_length: 1}}, "
      "k2: {uniform: [600, 900], per: study}, beta: {uniform: [1.0e5, 2.0e5]}}\n"));
  EXPECT_NE(input(study, "friction.beta", 0), input(study, "friction.beta", 1));
  const double mean = input(study, "friction.k1.profile.mean", 0);
  EXPECT_TRUE(mean > 100 && mean < 120);
  for (std::int64_t i = 1; i < 10; ++i) {
    EXPECT_EQ(input(study, "friction.k2", i), input(study, "friction.k2", 0));
    EXPECT_EQ(input(study, "friction.k1.profile.mean", i), mean);
  }
  // Of a lognormal field, the mean M makes the location ln M − s²/2.
  EXPECT_NEAR(study.profiles.at(0).profile->location, std::log(mean) - 0.5 * std::log1p(0.01), 1e-14);
}

// Rotors for which there is no room are made again, and are the same.
TEST(Rotors, DependOnlyOnTheirNumber) {
  const distributions::ProfileDescription description{110, 0.1, distributions::min_correlation_length,
                                                      friction::Marginal::lognormal};
  const Rotors rotors(description, std::nullopt, 7, "friction.k1", 1'000'000);
  const Rotors others(description, std::nullopt, 7, "friction.k1", 10);
  for (const std::int64_t machine : {0L, 9L, 0L})
    EXPECT_EQ(rotors.rotor(machine)->cosine, others.rotor(machine)->cosine);
  EXPECT_EQ(rotors.rotor(3), rotors.rotor(3));
  EXPECT_NE(rotors.rotor(999'999), rotors.rotor(999'999));
  EXPECT_EQ(rotors.rotor(999'999)->sine, rotors.rotor(999'999)->sine);
}

TEST(Rotors, StayWithinTheBoundsKnownInAdvance) {
  for (const friction::Marginal marginal : {friction::Marginal::lognormal, friction::Marginal::normal}) {
    const Rotors rotors({1, 0.2, 0.5, marginal},
                        DrawnMean{distributions::Lognormal{100, 0.3}, Design::monte_carlo, {}}, 7,
                        "friction.k1", 200);
    EXPECT_TRUE(numerics::contains(rotors.bounds(), rotors.all_limits()));
    for (std::int64_t machine = 0; machine < 200; ++machine)
      EXPECT_TRUE(numerics::contains(rotors.all_limits(), friction::value_at(*rotors.rotor(machine), 0.1)));
  }
}

// The profiles of thousands of machines are made once for all variants of a study, and only where they are
// equal.
TEST(Machines, AVariantSharesEqualProfilesWithTheStudy) {
  const std::string text = minimal_manifest(machines_and_moves);
  const Study study = study_of(text, {"machines=4", "trials=8"});
  const auto shares = [&](const std::vector<std::string>& overrides) {
    std::vector<std::string> all{"machines=4", "trials=8"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    const Study variant = manifest::parse_study(text, "m.yaml", all, sections::external_inputs_of(study));
    return variant.plan->profiles.front() == study.plan->profiles.front();
  };
  EXPECT_TRUE(shares({"plant.inertia=1e-3"}));
  EXPECT_FALSE(shares({"seed=99"}));
  EXPECT_FALSE(shares({"machines=8"}));
  EXPECT_FALSE(shares({"friction.k1.profile.cv=0.2"}));
  EXPECT_FALSE(shares({"friction.k1.profile.mean.lognormal.cv=0.2"}));
  EXPECT_FALSE(shares({"design=latin_hypercube"}));
}

}  // namespace
}  // namespace zerocount::study
