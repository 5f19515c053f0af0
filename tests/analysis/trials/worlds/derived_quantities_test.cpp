// What follows from several unknowns is tested as the unknowns are: where it decides, the rule and the
// measurement name it, and not one of the coefficients that it consists of.
#include "analysis/trials/worlds/derived_quantities.hpp"

#include "analysis/trials/worlds/learning.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/group_inputs.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::worlds {
namespace {

using friction::FrictionParameters;

/// Torque of the friction spring on its virgin curve at the travel x, N m: σ(x) = ½·f(2x), f(u) = k1·u +
/// k2/β·(1 − exp(−βu)).
double virgin_torque(const FrictionParameters& contact, double x) {
  return contact.k1 * x + 0.5 * contact.k2 / contact.beta * (1.0 - std::exp(-2.0 * contact.beta * x));
}

/// The travel x (rad) at which the virgin curve reaches `torque`, by bisection.
double virgin_travel(const FrictionParameters& contact, double torque) {
  double low = 0.0;
  double high = torque / contact.k1;
  for (int i = 0; i < 200; ++i)
    (virgin_torque(contact, 0.5 * (low + high)) < torque ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

using Formula = std::function<double(const FrictionParameters&, double)>;

/// Function that computes the derived quantity with this name from its definition.
Formula formula_of(std::string_view name) {
  if (name == "creep_extension")
    return [](const auto& c, double torque) { return std::pow(torque, c.n) / c.lambda; };
  if (name == "creep_rate")
    return [](const auto& c, double torque) { return c.alpha * std::pow(torque, c.n) / c.lambda; };
  if (name == "initial_stiffness") return [](const auto& c, double) { return c.k1 + c.k2; };
  if (name == "presliding_range") return [](const auto& c, double) { return virgin_travel(c, c.breakaway); };
  return [](const auto& c, double torque) {  // stiffness_at_rest: a difference quotient
    const double x = virgin_travel(c, torque);
    const double step = 1e-5 / c.beta;
    return (virgin_torque(c, x + step) - virgin_torque(c, x - step)) / (2.0 * step);
  };
}

FrictionParameters random_contact(testing::Draws& draws) {
  FrictionParameters contact;
  contact.k1 = draws.uniform(50.0, 200.0);
  contact.k2 = draws.uniform(100.0, 1000.0);
  contact.beta = draws.log_uniform(3e4, 3e5);
  contact.alpha = draws.log_uniform(0.1, 2.0);
  contact.n = draws.uniform(1.5, 2.5);
  contact.lambda = draws.log_uniform(1.0, 100.0);
  contact.breakaway = draws.uniform(0.1, 0.5);
  return contact;
}

TEST(DerivedQuantities, HaveTheValuesOfTheirDefinitions) {
  testing::Draws draws(3);
  for (int i = 0; i < 200; ++i) {
    const FrictionParameters contact = random_contact(draws);
    const double torque = draws.log_uniform(1e-3, 5e-2);
    for (const DerivedQuantity& quantity : derived_quantities()) {
      const double expected = formula_of(quantity.name)(contact, torque);
      EXPECT_NEAR(quantity.value(contact, torque), expected, 1e-6 * expected) << quantity.name;
    }
  }
}

/// The unknown parameters of `count` random worlds (possible sets of the values that all machines share), and
/// the quantities derived from them at this torque (N m).
std::vector<WorldInput> random_worlds(testing::Draws& draws, int count, double torque) {
  std::vector<WorldInput> inputs{{"friction.k1", "N m/rad", {}},   {"friction.k2", "N m/rad", {}},
                                 {"friction.beta", "1/rad", {}},   {"friction.alpha", "1/s", {}},
                                 {"friction.n", "1", {}},          {"friction.lambda", "(N m)^n/rad", {}},
                                 {"friction.breakaway", "N m", {}}};
  const std::size_t unknowns = inputs.size();
  for (const DerivedQuantity& quantity : derived_quantities())
    inputs.push_back({std::string(quantity.name), std::string(quantity.unit), {}, "derived"});
  for (int world = 0; world < count; ++world) {
    const FrictionParameters c = random_contact(draws);
    const std::array<double, 7> values{c.k1, c.k2, c.beta, c.alpha, c.n, c.lambda, c.breakaway};
    for (std::size_t i = 0; i < unknowns; ++i) inputs[i].values.push_back(values.at(i));
    for (std::size_t i = 0; i < derived_quantities().size(); ++i)
      inputs[unknowns + i].values.push_back(derived_quantities()[i].value(c, torque));
  }
  return inputs;
}

// In made-up worlds of which the quarter with the largest value of one quantity is bad.
TEST(DerivedQuantities, AreNamedIfTheyDecide) {
  constexpr int count = 30;  // with a threshold between any two
  constexpr double torque = 0.012;
  for (const DerivedQuantity& quantity : derived_quantities()) {
    int measured = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      testing::Draws draws(seed);
      const std::vector<WorldInput> inputs = random_worlds(draws, count, torque);
      const auto decisive = std::ranges::find(inputs, quantity.name, &WorldInput::name);
      std::vector<double> sorted = decisive->values;
      std::ranges::sort(sorted);
      std::vector<bool> bad;
      std::vector<double> rates;
      for (const double value : decisive->values) {
        bad.push_back(value > sorted[3 * count / 4]);
        rates.push_back((bad.back() ? 0.6 : 0.99) + draws.uniform(-0.005, 0.005));
      }
      const std::optional<WorldRule> rule = find_rule(inputs, rates, bad, seed);
      ASSERT_TRUE(rule) << quantity.name;
      EXPECT_EQ(rule->error_rate(), 0.0);
      const auto is_decisive = [&](const Condition& one) { return inputs[one.input].name == quantity.name; };
      EXPECT_TRUE(std::ranges::any_of(rule->conditions, is_decisive) ||
                  std::ranges::any_of(rule->same, is_decisive))
          << quantity.name << ": " << text_of(*rule, inputs);
      const Learned best = what_to_learn(inputs, bad, 0.1, seed).front();
      measured += inputs[best.input].name == quantity.name ? 1 : 0;
      EXPECT_LE(best.p_value, 0.05) << quantity.name;
    }
    EXPECT_GE(measured, 1) << quantity.name;
  }
}

// A quantity of one unknown separates the same worlds as the unknown: both are named, since a rule does not
// know which is the cause.
TEST(WorldRule, NamesAllInputsThatSeparateTheSameWorlds) {
  testing::Draws draws(5);
  std::vector<WorldInput> inputs{{"friction.alpha", "1/s", {}}, {"friction.n", "1", {}}};
  WorldInput creep{"creep_extension", "rad", {}, "derived"};
  std::vector<bool> bad;
  std::vector<double> rates;
  for (int world = 0; world < 30; ++world) {
    inputs[0].values.push_back(draws.uniform(0.1, 2.0));
    inputs[1].values.push_back(draws.uniform(1.5, 2.5));
    creep.values.push_back(std::pow(0.015, inputs[1].values.back()) / 10.0);
    bad.push_back(inputs[1].values.back() < 1.75);
    rates.push_back(bad.back() ? 0.6 : 0.95);
  }
  inputs.push_back(creep);
  const std::optional<WorldRule> rule = find_rule(inputs, rates, bad, 1);
  ASSERT_TRUE(rule);
  ASSERT_EQ(rule->conditions.size(), 1U);
  EXPECT_EQ(rule->conditions[0].input, 1U);
  ASSERT_EQ(rule->same.size(), 1U);
  EXPECT_EQ(rule->same[0].input, 2U);
  EXPECT_TRUE(rule->same[0].above);
}

/// Statistics of the holding torque with mean 0 and this standard deviation (N m), so that the derived
/// quantities depend on the standard deviation.
measures::MeasureStatistics holding_torque(double sd) {
  measures::MeasureStatistics torque;
  torque.n = 100;
  torque.mean = 0.0;
  torque.sd = sd;
  return torque;
}

study::Study study_with(const std::string& more) {
  return manifest::new_study(
      "zerocount: 1\nname: test\nseed: 1\nworlds: 10\ntrials: 100\ncommand: {targets: [5]}\n" + more,
      "test.yaml", {});
}

// What differs between machines has its median: λ 8 here. What no unknown changes is not listed.
TEST(DerivedQuantities, UseTheMedianMachineOfEachWorld) {
  const study::Study study =
      study_with("friction: {lambda: {lognormal: {median: 8, cv: 0.5}}, n: {interval: [1.5, 2.5]}}\n");
  const std::vector<WorldInput> derived = derived_of_worlds(study, 0, holding_torque(0.02));
  const std::vector<double> n = study::world_values(study, 0).front().values;
  ASSERT_EQ(derived.size(), 2U);
  EXPECT_EQ(derived[0].name, "creep_extension");
  EXPECT_EQ(derived[1].name, "creep_rate");
  for (std::size_t world = 0; world < 10; ++world) {
    const double expected = std::pow(0.02, n[world]) / 8.0;
    EXPECT_NEAR(derived[0].values[world], expected, 1e-12 * expected);
    EXPECT_NEAR(derived[1].values[world], 0.5 * expected, 1e-12 * expected);
  }
  EXPECT_TRUE(says(derived[0].meaning, "a torque of 0.02 N m"));
}

// The constant disturbance is carried too: here it takes the whole holding torque.
TEST(DerivedQuantities, UseTheTorqueThatTheContactCarries) {
  measures::MeasureStatistics torque = holding_torque(0.004);
  torque.mean = -0.1;
  const study::Study study =
      study_with("friction: {n: {interval: [1.5, 2.5]}}\ndisturbance: {torque: 0.103}\n");
  EXPECT_TRUE(says(derived_of_worlds(study, 0, torque).front().meaning, "a torque of 0.005 N m"));
}

TEST(DerivedQuantities, AreEmptyForLawsWithoutThem) {
  for (const char* model : {"dahl", "coulomb"}) {
    const study::Study study =
        study_with(std::string("friction: {model: ") + model + ", breakaway: {interval: [0.2, 0.4]}}\n");
    EXPECT_TRUE(derived_of_worlds(study, 0, holding_torque(0.02)).empty()) << model;
  }
}

TEST(DerivedQuantities, HaveAMeasurementThatDeterminesThem) {
  for (const DerivedQuantity& quantity : derived_quantities()) EXPECT_FALSE(record_of(quantity.name).empty());
}

}  // namespace
}  // namespace zerocount::worlds
